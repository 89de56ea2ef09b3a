#include "clog/core/polygon/forces/automatic_values.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include "clog/core/droplet/time_step.hpp"
#include "clog/core/parameters/contact_angle.hpp"
#include "clog/core/polygon/forces/stability.hpp"
#include "clog/core/polygon/wetting/contact_line.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"
#include "core/parameters/refusal.hpp"

namespace clog {
namespace {

StiffModes stiff_modes_of_circle(const DpParameters& dp, double wall_stiffness) {
  const double circumference = std::numbers::pi * units::droplet_diameter;
  return stiff_modes(dp, wall_stiffness, circumference, circumference / *dp.vertices);
}

/// The automatic stiffness of contact follows from the step, and the stiffness of friction follows from that
/// of contact. So only the other modes limit the step.
double largest_step_with_automatic_contact(const DpParameters& dp) {
  const StiffModes modes = stiff_modes_of_circle(dp, 1);
  const double others = modes.sum() - modes.contact - modes.friction;
  const double contact_part = auto_contact_omega_dt2 * (1 + modes.friction / modes.contact);
  const double self_part = auto_contact_omega_dt2 * modes.self_contact / modes.contact;
  return std::sqrt(std::min({max_area_omega_dt2 / modes.area, (max_total_omega_dt2 - contact_part) / others,
                             (max_total_with_self_omega_dt2 - contact_part - self_part) / others}));
}

std::vector<Rate> polygon_rates(const RunParameters& run) {
  const DpParameters& dp = run.dp;
  const StiffModes modes = stiff_modes_of_circle(dp, run.wall_stiffness.value_or(0));
  return {{"line-tension", dp.line_tension, modes.tension},
          {"area-stiffness", *dp.area_stiffness, modes.area},
          {"perimeter-stiffness", *dp.perimeter_stiffness, modes.spring},
          {"wall-stiffness", run.wall_stiffness.value_or(0), modes.contact}};
}

/// The automatic time step [t0]. K_a and K_l must be set.
double automatic_time_step(const RunParameters& run, double sharpest_bend) {
  assert(run.dp.area_stiffness && run.dp.perimeter_stiffness);
  const double drag = drag_time_step(run);
  constexpr double depth = 0.02;  // overlap of obstacle and contact range, divided by the vertex diameter
  const double vertex_mass = run.dp.inertia * units::droplet_mass / *run.dp.vertices;
  if (run.wall_stiffness)
    return rounded_down(
        std::min(drag, std::sqrt(auto_step_margin) *
                           largest_stable_step(stiff_modes_of_circle(run.dp, *run.wall_stiffness))));
  const double stable = std::sqrt(auto_step_margin) * largest_step_with_automatic_contact(run.dp);
  const double stiff_contact =
      std::sqrt(depth * auto_contact_omega_dt2 * vertex_mass / expected_pressure(run, sharpest_bend));
  return rounded_down(std::min({drag, stable, stiff_contact}));
}

/// Checks that the line tension does not compress the droplet too much.
void validate_compression(const DpParameters& dp, bool automatic_area) {
  constexpr double largest = 0.05;
  const double softest_per_tension = 1 / (units::droplet_diameter / 2) / (largest * units::rest_area);
  const double softest = dp.line_tension * softest_per_tension;
  if (automatic_area)
    require(*dp.area_stiffness >= softest, "line-tension", dp.line_tension,
            [&] {
              return fmt::format(
                  "would compress the droplet by more than 5 %, with the stiffest automatic area-stiffness) "
                  "use at most {:.3g} (from {} on droplets are nearly rigid), or the soft disk, model=sp",
                  rounded_down(*dp.area_stiffness / softest_per_tension), nearly_rigid_tension);
            },
            {"model"});
  require(*dp.area_stiffness >= softest, "area-stiffness", *dp.area_stiffness, [&] {
    return fmt::format("the line tension would compress the droplet by more than 5 %) use at least {:.3g}",
                       softest);
  });
}

/// Length l of the longest edges on an obstacle, times N_v [sigma]; measured (docs/explanation/wrapped.md).
double length_over_obstacles(const RunParameters& run) {
  // Length of the whole interface, for an even mesh.
  const double even = std::numbers::pi * units::droplet_diameter + 0.33 / run.dp.line_tension;
  if (run.dp.perimeter_spring != PerimeterSpring::rest) return even;
  const double stiffness = run.dp.perimeter_stiffness.value_or(automatic_perimeter_stiffness(run));
  // Softer springs let the vertices slip along the interface.
  if (stiffness < 0.02 * run.dp.line_tension) return even;
  return std::max(even, 0.2 * units::droplet_mass * units::gravity / stiffness);
}

void resolve_contact_angles(DpParameters& dp) {
  if (!dp.wall_tension && !dp.receding_angle && dp.advancing_angle)
    refuse("advancing-angle", *dp.advancing_angle,
           "Young's angle does not follow from it alone) give receding-angle, too, or wall-tension");
  if (dp.receding_angle && dp.advancing_angle && *dp.receding_angle > *dp.advancing_angle)
    refuse("receding-angle", *dp.receding_angle,
           fmt::format("larger than advancing-angle={:.6g}) exchange them", *dp.advancing_angle),
           {"advancing-angle"});
  constexpr double smallest = 0.1;
  const double tension = wall_tension(dp), young = young_angle(dp);
  require(tension >= smallest, "receding-angle", dp.receding_angle.value_or(young), [&] {
    return fmt::format(
        "with this advancing-angle wall-tension, minus the mean of their cosines, is {:.3g}, "
        "and the interface on a wall would buckle) use angles for at least {}",
        tension, smallest);
  });
  const bool is_young =
      !dp.wall_tension &&
      dp.receding_angle == dp.advancing_angle;  // the given angles may differ from Young's angle by round-off
  if (is_young || !dp.receding_angle) dp.receding_angle = young;
  if (is_young || !dp.advancing_angle) dp.advancing_angle = young;
  dp.wall_tension = tension;
  require(*dp.receding_angle <= young, "receding-angle", *dp.receding_angle, [&] {
    return fmt::format("above Young's angle, which wall-tension sets) use at most {:.6g}, or young", young);
  });
  require(*dp.advancing_angle >= young, "advancing-angle", *dp.advancing_angle, [&] {
    return fmt::format("below Young's angle, which wall-tension sets) use at least {:.6g}, or young", young);
  });
  if (has_hysteresis(dp) && dp.perimeter_spring != PerimeterSpring::along)
    throw Error(fmt::format(
        "{} contradicts perimeter-spring={} (on such an interface walls act by friction, not by hysteresis) "
        "use friction, or preset=robust",
        *dp.receding_angle < young ? "receding-angle" : "advancing-angle", name(dp.perimeter_spring)));
}

void resolve_film_friction(DpParameters& dp) {
  const bool repels = dp.self_contact == SelfContact::on;
  if (!dp.film_friction) dp.film_friction = dp.friction > 0 && repels ? FilmFriction::on : FilmFriction::off;
  if (*dp.film_friction == FilmFriction::off) return;
  if (!repels)
    throw Error(
        "film-friction=on contradicts self-contact=off (no interface lies on another) use self-contact=on, "
        "or "
        "film-friction=auto");
  if (!(dp.friction > 0))
    throw Error(
        "film-friction=on contradicts friction=0 (walls hold no interface by its push) use friction above 0, "
        "or "
        "film-friction=auto");
}

}  // namespace

int automatic_vertices(const RunParameters& run, double obstacle_diameter) {
  constexpr int fewest = 128, most = 1024, group = 8;
  constexpr double longest_edge = 0.28;  // in units of the obstacle's radius
  const double needed = length_over_obstacles(run) / (longest_edge * obstacle_diameter / 2);
  if (!(needed < most)) return most;
  return std::max(fewest, group * static_cast<int>(std::ceil(needed / group)));
}

double half_vertex_diameter(const DpParameters& dp) { return units::regular_edge_length(*dp.vertices) / 2; }

double automatic_perimeter_stiffness(const RunParameters& run) {
  switch (run.dp.perimeter_spring) {
    case PerimeterSpring::rest:
      return run.dp.perimeter_stiffness_ratio * run.dp.line_tension;
    case PerimeterSpring::mean:
      return 1;
    case PerimeterSpring::along:
      return 0.003 / run.drag.terminal_speed;
  }
  return 0;
}

double expected_pressure(const RunParameters& run, double sharpest_bend) {
  const double bend = sharpest_bend / 2 + run.dp.contact_range.value();
  return run.dp.line_tension * (2 / units::droplet_diameter + 1 / bend) +
         units::gravity * units::droplet_diameter;
}

double automatic_area_stiffness(const RunParameters& run, double sharpest_bend) {
  constexpr double published = 1e4;
  constexpr double compression = 2e-3;
  return std::min(published,
                  rounded_down(expected_pressure(run, sharpest_bend) / (compression * units::rest_area)));
}

void resolve_polygon(RunParameters& run, double sharpest_bend) {
  DpParameters& dp = run.dp;
  if (!dp.contact_range) dp.contact_range = half_vertex_diameter(dp);
  if (!dp.perimeter_stiffness) dp.perimeter_stiffness = automatic_perimeter_stiffness(run);
  const bool automatic_area = !dp.area_stiffness;
  if (automatic_area) dp.area_stiffness = automatic_area_stiffness(run, sharpest_bend);
  validate_compression(dp, automatic_area);

  if (dp.perimeter_spring == PerimeterSpring::along && dp.gravity == Gravity::vertex)
    throw Error(
        "perimeter-spring=along contradicts gravity=vertex (springs without tension cannot carry the weight "
        "of vertices) use gravity=area, or perimeter-spring=mean");

  resolve_contact_angles(dp);
  if (dp.perimeter_spring == PerimeterSpring::along && (dp.friction > 0 || dp.yield_traction > 0))
    throw Error(fmt::format(
        "{} contradicts perimeter-spring=along (an interface of constant tension cannot balance a "
        "tangential force) use preset=elastic",
        dp.friction > 0 ? "friction" : "yield-traction"));
  resolve_film_friction(dp);

  const double vertex_mass = dp.inertia * units::droplet_mass / *dp.vertices;
  const double vertex_diameter = units::regular_edge_length(*dp.vertices);
  const bool automatic = !run.wall_stiffness;
  if (!run.time_step) choose_time_step(run, automatic_time_step(run, sharpest_bend), polygon_rates(run));
  check_time_step(run);
  const double time_step = *run.time_step;
  if (automatic) {
    const double stiffest = auto_contact_omega_dt2 / 2 * vertex_mass / (time_step * time_step);
    run.wall_stiffness = wall_stiffness(stiffest, vertex_diameter);
  }
  const StiffModes modes = stiff_modes_of_circle(dp, *run.wall_stiffness);
  const double largest = automatic ? largest_step_with_automatic_contact(dp) : largest_stable_step(modes);
  const double stiffest_omega_dt = std::sqrt(modes.sum()) * time_step;
  require(stable_steps(modes, 1, time_step, Pressure::present).num == 1, "time-step", time_step,
          [&] {
            return fmt::format(
                "contact, area, tension and spring modes together have omega*dt = {:.3g}, "
                "wall-stiffness={:.3g}) try {:.3g}",
                stiffest_omega_dt, *run.wall_stiffness, 0.99 * largest);
          },
          {"wall-stiffness"});
  // If the contact is too soft, obstacles sink too far into the droplet. So an eighth of the vertices must be
  // able to carry the weight M g with an overlap of less than half the contact range.
  const double softest = units::droplet_mass / (*dp.vertices / 8.0) / (vertex_diameter / 4);
  require(contact_stiffness(*run.wall_stiffness, vertex_diameter) >= softest, "wall-stiffness",
          *run.wall_stiffness, [&] {
            return fmt::format(
                "too soft to hold the droplet's weight off an obstacle) use at least {:.3g} or a "
                "smaller time-step",
                wall_stiffness(softest, vertex_diameter));
          });
}

}  // namespace clog
