#include "clog/core/polygon/forces/stability.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "clog/core/polygon/contact/wall_friction.hpp"
#include "clog/core/polygon/wetting/contact_line.hpp"
#include "clog/core/tools/units.hpp"

namespace clog {
namespace {

/// @param longest  longest possible step
int num_steps(double longest, int steps, double time_step) {
  // Without this tolerance, round-off could split a step that was chosen as the largest stable step.
  constexpr double tolerance = 1e-9;
  constexpr double most_by_part = 2;
  const double for_one = time_step / longest - tolerance;
  if (!(for_one < most_substeps)) return most_substeps * steps;
  const double needed = for_one > most_by_part ? steps * std::ceil(for_one) : std::ceil(steps * for_one);
  return std::max(steps, static_cast<int>(needed));
}

}  // namespace

StiffModes stiff_modes(const DpParameters& dp, double wall_stiffness, double perimeter,
                       double shortest_edge) {
  const double num_vertices = *dp.vertices;
  const double mass = dp.inertia * units::droplet_mass;
  const double vertex_mass = mass / num_vertices;
  const double vertex_diameter = units::regular_edge_length(*dp.vertices);
  const int edges_per_vertex = dp.wall_contact == WallContact::edge ? 2 : 1;
  const double mean_edge = perimeter / num_vertices;
  const double edge = std::max(shortest_edge, 0.01 * mean_edge);
  const bool has_friction = dp.friction > 0 || dp.yield_traction > 0;
  return {
      .contact = edges_per_vertex * contact_stiffness(wall_stiffness, vertex_diameter) / vertex_mass,
      .self_contact = dp.self_contact == SelfContact::on
                          ? 8 * contact_stiffness(wall_stiffness, vertex_diameter) / vertex_mass
                          : 0,
      .area = dp.area_stiffness.value() * perimeter * perimeter / mass,
      .tension = 4 * dp.line_tension / (edge * vertex_mass),
      .spring = 4 * dp.perimeter_stiffness.value() * num_vertices / vertex_mass,
      .wetting = 6 * dp.line_tension * std::abs(wall_tension(dp) - 1) * mean_edge /
                 (wetting_width * wetting_width * vertex_diameter * vertex_diameter * vertex_mass),
      .pinning = has_hysteresis(dp) ? pinning_gradient2 * pinning_stiffness * dp.line_tension /
                                          (vertex_diameter * vertex_mass)
                                    : 0,
      .friction = has_friction ? friction_stiffness_ratio *
                                     contact_stiffness(wall_stiffness, vertex_diameter) / vertex_mass
                               : 0,
  };
}

double largest_stable_step(const StiffModes& modes) {
  return std::sqrt(std::min({max_contact_omega_dt2 / modes.contact, max_area_omega_dt2 / modes.area,
                             max_total_omega_dt2 / modes.sum(),
                             max_total_with_self_omega_dt2 / (modes.sum() + modes.self_contact)}));
}

double largest_step_with_implicit_pressure(const StiffModes& modes) {
  constexpr double area_omega_dt2 = 1;
  const double others = modes.sum() - modes.area;
  return std::sqrt(
      std::min({max_contact_omega_dt2 / modes.contact, (max_total_omega_dt2 - area_omega_dt2) / others,
                (max_total_with_self_omega_dt2 - area_omega_dt2) / (others + modes.self_contact)}));
}

Steps stable_steps(const StiffModes& modes, int steps, double time_step, Pressure most) {
  assert(steps > 0 && time_step > 0);
  Steps stable{num_steps(largest_stable_step(modes), steps, time_step), time_step};
  if (most == Pressure::implicit) {
    const int num = num_steps(largest_step_with_implicit_pressure(modes), steps, time_step);
    if (num < stable.num) stable = {num, time_step, Pressure::implicit};
  }
  assert(stable.num >= steps && stable.num <= most_substeps * steps);
  if (stable.num != steps) stable.length = steps * time_step / stable.num;
  return stable;
}

}  // namespace clog
