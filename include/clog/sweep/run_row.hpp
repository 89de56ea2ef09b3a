#pragma once

#include <bitset>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "clog/core/parameters/parameters.hpp"
#include "clog/core/run/droplet_run.hpp"

namespace clog::sweep {

/// How a clog was found; `nothing` of a run that has not clogged.
enum class FoundBy { nothing, threshold, certified };

}  // namespace clog::sweep

template <>
struct clog::Words<clog::sweep::FoundBy> {
  static constexpr Worded<sweep::FoundBy> all[] = {{sweep::FoundBy::certified, "certified"},
                                                   {sweep::FoundBy::threshold, "threshold"},
                                                   {sweep::FoundBy::nothing, "none"}};
};

namespace clog::sweep {

/// Instruction set of a run that went on from a snapshot of another one.
inline constexpr const char* mixed_instruction_sets = "mixed";

/// One row of the table of runs: parameters, results, circumstances. Its columns, their units and meanings
/// are listed in columns.cpp.
struct RunRow {
  static constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

  std::int64_t task = -1;

  RunParameters parameters;  ///< resolved
  std::bitset<64> unknown;   ///< by place in parameter_schema(): parameters that the row's file does not have
  double obstacle_density = 0;     ///< of a saturated array the jamming limit, see Scene
  std::string preset;              ///< the one that the interface agrees with, "custom", or "none" for sp
  std::int64_t model_version = 0;  ///< see parameters.hpp

  RunStatus status = RunStatus::running;
  std::optional<FoundBy> clogged_by;  ///< nothing: not known; so below
  double distance = 0;
  double lateral_displacement = 0;
  double time = 0;
  double mean_speed = not_known;
  double mean_speed_error = not_known;
  double transient = not_known;
  double travel_time = not_known;
  Dwells dwells;
  std::int64_t contacts = -1;  ///< -1: not known
  double first_contact_at = not_known;
  double kinetic_energy_ratio = 0;
  double shape_parameter = 0;
  std::optional<ClogMechanism> mechanism;
  double wrapped_support = not_known;
  std::int64_t num_wrapped = -1;  ///< -1: not known
  std::int64_t num_gaps = -1;
  std::int64_t num_arcs = -1;
  double mesh_hold = not_known;
  double largest_shape_parameter = not_known;  ///< of a passage through a channel; so the next
  double largest_shape_parameter_at = not_known;
  double largest_relative_speed = not_known;
  double largest_relative_speed_at = not_known;
  double smallest_relative_speed = not_known;
  double smallest_relative_speed_at = not_known;
  double sag = not_known;  ///< on a flat wall
  double top_sag = not_known;
  ThinnestNeck neck;
  double release_x = not_known;  ///< in the coordinates of user-supplied circles
  double release_y = not_known;
  std::int64_t steps = 0;

  double wall_seconds = 0;
  double processor_seconds = not_known;
  std::int64_t rank = 0;
  std::string instruction_set;  ///< of the polygon's step; "none" for sp; or mixed_instruction_sets
  std::string host;
  std::int64_t attempt = 1;
  std::string message;

  std::string unreadable;  ///< which column of a stored row holds what no row can hold; no column itself
};

/// Has the run come to its end, so that it has a result?
inline bool is_result(RunStatus status) {
  return status == RunStatus::clogged || status == RunStatus::broken || status == RunStatus::flowing ||
         status == RunStatus::passed;
}
/// Is the run in progress, or was it interrupted?
inline bool is_unfinished(RunStatus status) {
  return status == RunStatus::running || status == RunStatus::interrupted;
}

/// Cost of a run so far [s]: its processor time, or its wall-clock time if that is not known.
inline double cost_seconds(const RunRow& row) {
  return std::isnan(row.processor_seconds) ? row.wall_seconds : row.processor_seconds;
}

/// What was run, seed included, as bytes: equal for equal runs, whatever their place in a sweep.
std::string identity(const RunRow& row);

/// The columns that say what was run.
/// @param run  resolved
RunRow describe(const RunParameters& run);
/// Fills the columns of results.
void record(const RunResult& result, RunRow& row);

/// The row as bytes, one column after the other: so it is stored, and sent to other processes of this
/// version.
std::size_t packed_size();
void pack(const RunRow& row, std::span<std::byte> packed);
RunRow unpack(std::span<const std::byte> packed);

}  // namespace clog::sweep
