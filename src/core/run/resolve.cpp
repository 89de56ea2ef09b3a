#include "clog/core/run/resolve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "clog/core/parameters/schema.hpp"
#include "clog/core/polygon/stability.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"
#include "core/scene/refusal.hpp"

namespace clog {
namespace {

StiffModes stiff_modes_of_circle(const DpParameters& dp, double wall_stiffness) {
  const double circumference = std::numbers::pi * units::droplet_diameter;
  return stiff_modes(dp, wall_stiffness, circumference, circumference / dp.vertices);
}

/// An automatic contact follows the step; only the other modes limit it then.
double largest_step_with_automatic_contact(const DpParameters& dp) {
  const StiffModes modes = stiff_modes_of_circle(dp, 1);
  const double others = modes.sum() - modes.contact;
  const double self_part = auto_contact_omega_dt2 * modes.self_contact / modes.contact;
  return std::sqrt(
      std::min({max_area_omega_dt2 / modes.area, (max_total_omega_dt2 - auto_contact_omega_dt2) / others,
                (max_total_with_self_omega_dt2 - auto_contact_omega_dt2 - self_part) / others}));
}

/// Of a soft disk on one obstacle [1/t0].
double soft_disk_frequency(const RunParameters& run) {
  return std::sqrt(contact_stiffness(*run.wall_stiffness, units::droplet_diameter) / units::droplet_mass);
}

/// A key, and how fast what it stands for would be [1/t0^2].
struct Rate {
  const char* key;
  double value;
  double squared;
};

/// Which key asks for the smallest step, by the bounds of automatic_time_step().
Rate fastest_rate(const RunParameters& run) {
  const double speed = run.drag.terminal_speed;
  std::vector<Rate> rates = {{"terminal-speed", speed, 100 / (speed * speed)}};
  if (run.model == Model::sp) {
    const double omega = soft_disk_frequency(run);
    rates.push_back({"wall-stiffness", *run.wall_stiffness, 100 * omega * omega});
  } else {
    const DpParameters& dp = run.dp;
    const StiffModes modes = stiff_modes_of_circle(dp, run.wall_stiffness.value_or(0));
    rates.push_back({"line-tension", dp.line_tension, modes.tension});
    rates.push_back({"area-stiffness", *dp.area_stiffness, modes.area});
    rates.push_back({"perimeter-stiffness", *dp.perimeter_stiffness, modes.spring});
    rates.push_back({"wall-stiffness", run.wall_stiffness.value_or(0), modes.contact});
  }
  return *std::max_element(rates.begin(), rates.end(),
                           [](const Rate& a, const Rate& b) { return a.squared < b.squared; });
}

void choose_time_step(RunParameters& run) {
  run.time_step = automatic_time_step(run);
  if (*run.time_step >= parameter("time-step").range.lower->value) return;
  const Rate rate = fastest_rate(run);
  refuse(
      rate.key, rate.value,
      "would need a time-step of " + rounded_text(*run.time_step) + ") use a value nearer to the usual ones");
}

void resolve_time_step(RunParameters& run) {
  if (!run.time_step) choose_time_step(run);
  const double time_step = *run.time_step;
  require(run.max_time >= time_step, "max-time", run.max_time,
          [&] { return "shorter than one time-step) use at least " + rounded_text(time_step); });
  require(run.max_time / time_step <= 1e15, "max-time", run.max_time,
          [&] { return "more than 1e15 steps) use at most " + rounded_text(1e15 * time_step); });
  require(time_step <= run.drag.terminal_speed, "time-step", time_step, [&] {
    return "does not resolve the drag's relaxation time, terminal-speed=" +
           rounded_text(run.drag.terminal_speed) + ") try " + rounded_text(0.1 * run.drag.terminal_speed);
  });
}

/// The droplet keeps its area under its own line tension.
void validate_compression(const DpParameters& dp, bool automatic_area) {
  constexpr double largest = 0.05;
  const double softest_per_tension = 1 / (units::droplet_diameter / 2) / (largest * units::rest_area);
  const double softest = dp.line_tension * softest_per_tension;
  if (automatic_area)
    require(*dp.area_stiffness >= softest, "line-tension", dp.line_tension, [&] {
      return "would compress the droplet by more than 5 %, with the stiffest automatic "
             "area-stiffness) use at most " +
             rounded_text(rounded_down(*dp.area_stiffness / softest_per_tension)) +
             ", or give area-stiffness";
    });
  require(*dp.area_stiffness >= softest, "area-stiffness", *dp.area_stiffness, [&] {
    return "the line tension would compress the droplet by more than 5 %) use at least " +
           rounded_text(softest);
  });
}

void resolve_dp(RunParameters& run) {
  DpParameters& dp = run.dp;
  if (!dp.contact_range) dp.contact_range = half_vertex_diameter(dp);
  if (!dp.perimeter_stiffness) dp.perimeter_stiffness = automatic_perimeter_stiffness(run);
  const bool automatic_area = !dp.area_stiffness;
  if (automatic_area) dp.area_stiffness = automatic_area_stiffness(run);
  validate_compression(dp, automatic_area);

  if (dp.perimeter_spring == PerimeterSpring::along && dp.gravity == Gravity::vertex)
    throw Error(
        "perimeter-spring=along contradicts gravity=vertex (springs without tension cannot carry the weight "
        "of "
        "vertices) use gravity=area, or perimeter-spring=mean");

  const double vertex_mass = units::droplet_mass / dp.vertices;
  const double vertex_diameter = units::regular_edge_length(dp.vertices);
  const bool automatic = !run.wall_stiffness;
  resolve_time_step(run);
  const double time_step = *run.time_step;
  if (automatic) {
    const double stiffest = auto_contact_omega_dt2 / 2 * vertex_mass / (time_step * time_step);
    run.wall_stiffness = wall_stiffness(stiffest, vertex_diameter);
  }
  const StiffModes modes = stiff_modes_of_circle(dp, *run.wall_stiffness);
  const double largest = automatic ? largest_step_with_automatic_contact(dp) : largest_stable_step(modes);
  const double stiffest_omega_dt = std::sqrt(modes.sum()) * time_step;
  require(num_substeps(modes, time_step) == 1, "time-step", time_step, [&] {
    return "contact, area, tension and spring modes together have omega*dt = " +
           rounded_text(stiffest_omega_dt) + ", wall-stiffness=" + rounded_text(*run.wall_stiffness) +
           ") try " + rounded_text(0.99 * largest);
  });
  // A contact too soft to carry the droplet lets obstacles sink into it: demand that a weight of M g on
  // the vertices of an eighth of the circumference leaves less than half the contact range.
  const double softest = units::droplet_mass / (dp.vertices / 8.0) / (vertex_diameter / 4);
  require(contact_stiffness(*run.wall_stiffness, vertex_diameter) >= softest, "wall-stiffness",
          *run.wall_stiffness, [&] {
            return "too soft to hold the droplet's weight off an obstacle) use at least " +
                   rounded_text(wall_stiffness(softest, vertex_diameter)) + " or a smaller time-step";
          });
}

void resolve_sp(RunParameters& run) {
  if (!run.wall_stiffness)
    throw Error(
        "missing wall-stiffness (E_w is the parameter of model=sp, there is no automatic value) "
        "give for example wall-stiffness=1");
  resolve_time_step(run);
  const double omega = soft_disk_frequency(run);
  // Up to a dozen obstacles of a saturated array overlap a soft disk at once.
  const double largest = std::sqrt(max_total_omega_dt2 / 12) / omega;
  require(*run.time_step <= largest, "time-step", *run.time_step, [&] {
    return "contact has omega*dt = " + rounded_text(omega * *run.time_step) + ") try " +
           rounded_text(0.99 * largest);
  });
}

}  // namespace

double half_vertex_diameter(const DpParameters& dp) { return units::regular_edge_length(dp.vertices) / 2; }

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

double expected_pressure(const RunParameters& run) {
  const double bend = scene_of(run).sharpest_bend(run) / 2 + run.dp.contact_range.value();
  return run.dp.line_tension * (2 / units::droplet_diameter + 1 / bend) +
         units::gravity * units::droplet_diameter;
}

double automatic_area_stiffness(const RunParameters& run) {
  constexpr double published = 1e4;
  constexpr double compression = 2e-3;
  return std::min(published, rounded_down(expected_pressure(run) / (compression * units::rest_area)));
}

double automatic_time_step(const RunParameters& run) {
  const double drag = 0.1 * run.drag.terminal_speed / units::gravity;
  if (run.model == Model::sp) return rounded_down(std::min(drag, 0.1 / soft_disk_frequency(run)));
  constexpr double depth = 0.02;  // of an obstacle in the contact range, over the vertex diameter
  const double vertex_mass = units::droplet_mass / run.dp.vertices;
  if (run.wall_stiffness)
    return rounded_down(
        std::min(drag, std::sqrt(auto_step_margin) *
                           largest_stable_step(stiff_modes_of_circle(run.dp, *run.wall_stiffness))));
  const double stable = std::sqrt(auto_step_margin) * largest_step_with_automatic_contact(run.dp);
  const double stiff_contact =
      std::sqrt(depth * auto_contact_omega_dt2 * vertex_mass / expected_pressure(run));
  return rounded_down(std::min({drag, stable, stiff_contact}));
}

RunParameters resolve(RunParameters run) {
  check_each(run);
  const Scene& scene = scene_of(run);
  scene.check(run);
  if (run.model == Model::dp)
    resolve_dp(run);
  else
    resolve_sp(run);
  scene.resolve(run);
  return run;
}

}  // namespace clog
