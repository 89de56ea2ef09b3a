#pragma once

#include <cmath>

#include "clog/sweep/run_row.hpp"

namespace clog::results {

/// Makes a row that fault_of() accepts. The droplet moved over `distance` at its terminal speed, and then its
/// run ended. If the status is flowing, the droplet rested there until max-time. With break-up=daughters, the
/// table of droplets has only the ancestor, which clogged.
/// @param distance  [sigma]
inline void end_run(sweep::RunRow& row, RunStatus status, double distance) {
  row.status = status;
  row.distance = distance;
  const bool is_flowing = status == RunStatus::flowing;
  row.time = is_flowing ? row.parameters.max_time : distance / row.parameters.drag.terminal_speed;
  row.steps = std::llround(row.time / row.parameters.time_step.value());
  row.wall_seconds = 1;
  row.kinetic_energy_ratio = 0;
  row.shape_parameter = 1;
  if (row.parameters.dp.break_up == BreakUp::daughters) {
    Member& ancestor = row.family.emplace_back();
    ancestor.end = {.distance = distance, .lateral = 0, .time = row.time};
    ancestor.status = MemberEnd::clogged;
  }
}

}  // namespace clog::results
