#pragma once

#include <optional>
#include <string>
#include <vector>

#include "clog/fit/clogging_length.hpp"
#include "clog/results/comparison.hpp"
#include "clog/results/groups.hpp"
#include "clog/sweep/columns.hpp"

namespace clog::results {

/// Droplets with the same values of DistanceTable::labels.
struct DistanceGroup {
  std::vector<Value> labels;
  std::vector<fit::Observation> runs;
  Flaws flaws{};  ///< flaws of simulated runs
};
/// Distances that droplets travelled, measured or simulated.
struct DistanceTable {
  std::string source;
  std::string unit;                 ///< unit of the distances: "sigma" or "mm"
  std::vector<std::string> labels;  ///< columns that separate groups
  std::vector<DistanceGroup> groups;
  bool is_measured = false;
  double from = 0;  ///< the distance from which on the runs are counted, see counted_from()
};

/// The diameter of a group's droplets [mm]. It is the value of the label `diameter`, which may be unknown.
/// Without this label, it is `sigma_mm`.
std::optional<double> diameter_of(const DistanceTable& table, const DistanceGroup& group,
                                  std::optional<double> sigma_mm);

/// The table with distances counted from `from` on, in the table's unit (left truncation, see group_runs()).
/// Excludes droplets that ended before `from`, and prints their number.
DistanceTable counted_from(double from, DistanceTable table);
/// Splits a table into one table for each value of a label, in the order of the values.
/// @throws Error if there is no such label, or only one value
std::vector<DistanceTable> tables_of_values(const DistanceTable& table, const std::string& label);
/// The runs of a sweep. Runs form a group if they have equal values of all parameters that vary or are
/// requested.
/// @param scales  units of the laboratories, if any. If there are several, or if `diameter` or `angle` is
/// requested, distances are in mm. The droplet's diameter [mm] and the tilt [degrees] then separate groups.
/// They replace the parameters that follow from diameter and tilt.
/// @param asked  labels of the tables to compare with
/// @throws Error as require_lengths()
/// @param confidence  confidence of the intervals that decide on the doubt about failures
DistanceTable distances_of(const Side& side, const ScalesByLaboratory& scales,
                           const std::vector<std::string>& asked, double confidence);
/// Properties of each group that may make its clogging length unreliable. For measured distances, only
/// few_clogs, not_exponential and equal_distances are known.
std::vector<Flaws> flaws_of(const DistanceTable& table);
/// The name of a sweep's column that corresponds to a label.
std::string label_key(std::string label);
/// Labels of a table that the other table lacks.
std::vector<std::string> unmatched_labels(const DistanceTable& table, const DistanceTable& other);

/// These functions print lengths, intervals, doubts and survival of each group. The methods are those for
/// sweeps.
/// @param sigma_mm  see diameter_of(); groups with a known diameter have lengths in both units
std::string lengths_text(const DistanceTable& table, double confidence, std::optional<double> sigma_mm);
std::string lengths_csv(const DistanceTable& table, double confidence, std::optional<double> sigma_mm);
std::string lengths_json(const DistanceTable& table, double confidence, std::optional<double> sigma_mm);
/// Names of all results that these functions print beside the labels.
std::vector<std::string> names_of_lengths();

/// Compares each group of the other tables with groups of the first table. Groups are compared if they have
/// equal values of all labels that occur in both tables. The runs are not paired. If the tables have
/// different units, lengths are in the diameters of each group's own droplets (diameter_of()).
/// @throws Error if units differ and a diameter is unknown, or if no groups can be compared
Comparisons compare_distances(const std::vector<DistanceTable>& tables, double confidence,
                              std::optional<double> sigma_mm);

}  // namespace clog::results
