#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "clog/fit/clogging_length.hpp"
#include "clog/fit/length_ratio.hpp"
#include "clog/fit/survival.hpp"
#include "clog/results/groups.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/run_row.hpp"

namespace clog::results {

/// One side of a comparison: the runs of a file, or the runs with one value of a parameter.
struct Side {
  std::string name;
  std::vector<sweep::RunRow> rows;
  std::vector<std::string> lists;  ///< see listed_columns()
};

/// The model's units in each laboratory. The key of the map is the checksum of the laboratory's description
/// (the text of `lab.cfg`), or "" if one laboratory applies to all runs.
using ScalesByLaboratory = std::map<std::string, LaboratoryScale>;
const LaboratoryScale& scale_in(const ScalesByLaboratory& scales, const sweep::RunRow& row);
/// Whether the value of this column follows from the droplet's diameter and tilt in these runs. Each run must
/// have a laboratory in `scales`. The result is false for columns without a unit, such as friction, because
/// their values could agree by chance.
bool follows_from_droplet(const sweep::Column& column, const std::vector<const sweep::RunRow*>& rows,
                          const ScalesByLaboratory& scales);

/// Properties of a side's runs that may make its clogging length unreliable.
struct Flaws {
  int num_failed = 0;
  std::vector<Doubt> doubts;
  fit::WeibullTest weibull{};
  std::string runs{};  ///< identifies simulated runs, see runs_of()
  /// Number of the group. Two comparisons may contain the same group, or copies of its runs in two
  /// laboratories.
  int group = 0;
};
/// The number of a group. Groups with the same runs in different laboratories have the same number.
int number_of(const Flaws& group, std::map<std::string, int>& known, int& num_groups);
/// The flaws of each group of the runs, see group_runs(); the key is parameter_values().
std::map<std::vector<Value>, Flaws> flaws_by_parameters(const std::vector<sweep::RunRow>& rows,
                                                        double confidence);

/// A parameter set of one side (`here`), compared with a parameter set of the first side (`there`).
struct Comparison {
  std::string here, there;    ///< names of the sides
  std::vector<Value> common;  ///< see Comparisons::columns
  fit::CloggingLength length_here{}, length_there{};
  Flaws flaws_here{}, flaws_there{};
  fit::LengthRatio ratio{};  ///< ratio of the length here to the length there
  /// p-value of the log-rank test, which treats all runs as independent, and this p-value after Holm's
  /// correction for all comparisons. NaN if unknown.
  double log_rank_p = sweep::RunRow::not_known, log_rank_p_holm = sweep::RunRow::not_known;
  int num_both_clogged = 0;  ///< pairs of runs that both clogged
  int num_same_place = 0;    ///< pairs of runs that both clogged, at the same place
  /// Whether the runs here and there have the same ends at the same places, because they are copies. The
  /// ratio is then exactly 1 and has no interval.
  bool are_identical = false;
};
/// Groups of a side that do not match any group of another side, and are therefore in no comparison with it.
struct LeftOut {
  std::string side, other;
  std::size_t number = 0, number_of_all = 0;
  std::string example;  ///< the first of these groups, as `label=value, label=value`
};
struct Comparisons {
  double confidence = 0;             ///< confidence of the intervals
  std::vector<std::string> columns;  ///< columns whose values name a comparison: the listed columns in which
                                     ///< both sides have a common value
  std::vector<std::string> differing;  ///< columns with different values here and there
  std::vector<Comparison> all;
  std::vector<LeftOut> left_out;
  std::string unit = "sigma";      ///< unit of lengths: "sigma" or "mm"
  std::optional<double> sigma_mm;  ///< the droplet's diameter, if lengths are also given in mm
  std::ptrdiff_t num_tests = 0;    ///< log-rank tests; copies of runs in other laboratories are not counted
  double within = 0;               ///< clogs this close count as at the same place [sigma]; 0: half a spacing
};

/// Appends to Comparisons::left_out the groups of `side` that match no group of `other`, if there are any.
/// @param labels  names of a group's values
void append_left_out(Comparisons& comparisons, const std::string& side, const std::string& other,
                     const std::vector<std::string>& labels, const std::vector<std::vector<Value>>& unmatched,
                     std::size_t number_of_all);

/// Corrects the tests of all comparisons for the number of tests (Holm). The tests are the log-rank tests of
/// the comparisons, and the tests of the groups for an exponential P(r) (Doubt::not_exponential).
void correct_tests(Comparisons& all);

/// `column=value`, or `no column` for an unset value.
std::string named_value(const std::string& column, const Value& value);

/// @throws Error if the side has no runs, or runs without a clogging length
void require_lengths(const Side& side);

/// Makes a side for each file; the first file is the reference. @throws Error as read_with_caution()
std::vector<Side> sides_of_files(const std::vector<std::string>& paths);
/// Makes a side for each value of a column, in the order of numbers or words. The first value is the
/// reference.
/// @throws Error if there is no such column of parameters, or only one value
std::vector<Side> sides_of_column(const std::string& name, const store::SweepFile& file);

/// Compares each side with the first side. Compares parameter sets with equal values in Comparisons::columns.
/// Two runs with equal seeds form a pair.
/// @param sides  two or more
/// @param within  see Comparisons; nullopt: half an obstacle spacing
/// @param scales  units of the runs' laboratories. If there are several laboratories, and the two sides of
/// each comparison have the same droplet, lengths are in mm. The droplet's diameter [mm] and tilt [degrees]
/// then name the comparison. These two replace the columns that follow from them.
/// @throws std::invalid_argument if there are fewer than two sides
/// @throws Error if two sides have no value in common, or if it is not clear which parameter sets belong
/// together
Comparisons compare(const std::vector<Side>& sides, double confidence, std::optional<double> within,
                    const ScalesByLaboratory& scales = {});

std::string to_text(const Comparisons& comparisons);
std::string to_csv(const Comparisons& comparisons);
std::string to_json(const Comparisons& comparisons);
/// Names of all results that these functions print beside Comparisons::columns.
std::vector<std::string> names_of_comparisons();

}  // namespace clog::results
