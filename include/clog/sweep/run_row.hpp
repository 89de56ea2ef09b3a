#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "clog/core/parameters/schema.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/run/family.hpp"

namespace clog::sweep {

/// RunRow::instruction_set of a run that resumed from a snapshot of another instruction set.
inline constexpr const char* mixed_instruction_sets = "mixed";

/// One row of the table of runs: parameters, results, circumstances. Its columns, their units and meanings
/// are listed in columns.cpp. An unknown word is an empty optional, an unknown number is NaN, and an unknown
/// count is -1. (Optional numbers would have two unknown values.)
struct RunRow : RunResult {
  static constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
  static constexpr std::int64_t not_counted = -1;

  /// Results that files of older formats may lack start as unknown.
  RunRow() {
    clogged_by.reset(), stability.reset(), failed_by.reset(), hold.mechanism.reset();
    sound_distance = not_known;
    contacts.number = healed_crossings = not_counted;
    hold.geometry.num_wrapped = hold.geometry.num_gaps = hold.geometry.num_arcs = not_counted;
  }

  /// The members of a family that has ended, with break-up=daughters. They are not columns of this table, but
  /// lines of the table of droplets.
  std::vector<Member> family;

  std::int64_t task = -1;

  RunParameters parameters;                       ///< resolved parameters
  std::set<const Parameter*> unknown_parameters;  ///< parameters that the row's file does not have
  double obstacle_density = 0;     ///< density, see Scene; saturated arrays have that of the jamming limit
  std::string preset;              ///< the preset with this interface, "custom", or "none" for sp
  std::int64_t model_version = 0;  ///< see parameters.hpp

  double wall_seconds = 0;
  double processor_seconds = not_known;
  std::int64_t rank = 0;
  /// Instruction set of the polygon's step; "none" for sp; or mixed_instruction_sets.
  std::string instruction_set;
  std::string host;
  std::int64_t attempt = 1;
};

/// Whether this number of a row is known.
inline bool is_known(double number) { return !std::isnan(number); }
inline bool is_known(std::int64_t count) { return count != RunRow::not_counted; }

/// Whether the run is over, so that it has a result.
inline bool is_result(RunStatus status) {
  return status == RunStatus::clogged || status == RunStatus::broken || status == RunStatus::flowing ||
         status == RunStatus::passed;
}
/// Whether the run is in progress, or was interrupted.
inline bool is_unfinished(RunStatus status) {
  return status == RunStatus::running || status == RunStatus::interrupted;
}

/// Whether another attempt may succeed, because the run failed for reasons other than its parameters and
/// seed.
inline bool may_succeed_later(const RunRow& row) {
  return row.status == RunStatus::failed && row.failed_by != FailedBy::divergence &&
         row.failed_by != FailedBy::crossing;
}
/// Whether no further attempt can change the row.
inline bool is_final(const RunRow& row) {
  return is_result(row.status) || (row.status == RunStatus::failed && !may_succeed_later(row));
}
/// Distance up to which a run was observed; nullopt for failed runs of older files that diverged or crashed,
/// because their `distance` may be wrong. In these files a run that crossed itself was observed up to the
/// check that found the crossing, at most 2048 steps too far [sigma].
std::optional<double> observed_distance(const RunRow& row);

/// Whether the row names a preset of some version.
inline bool has_named_preset(const RunRow& row) { return row.preset != "none" && row.preset != "custom"; }

/// Cost of a run so far [s]: its processor time, or its wall-clock time if that is unknown.
inline double cost_seconds(const RunRow& row) {
  return is_known(row.processor_seconds) ? row.processor_seconds : row.wall_seconds;
}

/// The parameters and the seed of a run as bytes. These bytes are equal for equal runs, whatever the task
/// numbers are. Numbers are rounded to twelve digits, so that a gap equals the same gap computed from a
/// pitch.
std::string identity(const RunRow& row);
/// identity() without the laboratory, on which runs do not depend.
std::string identity_in_any_laboratory(RunRow row);
/// identity() without the model version, to find the task of a row that another version wrote.
std::string identity_in_any_version(RunRow row);

/// The columns of parameters. @param run  resolved
RunRow describe(const RunParameters& run);
/// Fills the columns of results.
inline void record(const RunResult& result, RunRow& row) { static_cast<RunResult&>(row) = result; }
/// The row of a run that has just begun. Its results are those of RunResult{}, so none of them is unknown.
/// @param run  resolved
RunRow begun_row(const RunParameters& run, std::int64_t task);

/// The row as bytes, one column after the other, as it is stored and sent to other processes of this version.
std::size_t packed_size();
void pack(const RunRow& row, std::span<std::byte> packed);

/// A row, and a description of the first value in its bytes that no row can have; empty if there is none.
struct UnpackedRow {
  RunRow row;
  std::string fault;
};
UnpackedRow unpack(std::span<const std::byte> packed);

}  // namespace clog::sweep
