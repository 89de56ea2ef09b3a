#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clog/core/scene/scene.hpp"
#include "clog/fit/clogging_length.hpp"
#include "clog/fit/incidence.hpp"
#include "clog/fit/mean_speed.hpp"
#include "clog/fit/migration.hpp"
#include "clog/fit/survival.hpp"
#include "clog/results/doubts.hpp"
#include "clog/results/families.hpp"
#include "clog/sweep/columns.hpp"

namespace clog::results {

inline constexpr int enough_clogs = 5;  ///< with fewer clogs, the interval is wide and its coverage varies

/// Competing causes that may end a run: a clog, by the mechanism that holds it (`other`: none of the three),
/// or the break-up of the droplet.
enum class Cause { wrapped, squeezed, hybrid, other, broken };
/// Names of two columns: the number of runs that the cause ended, and the total distance of all runs divided
/// by this number.
struct CauseText {
  Cause cause;
  bool is_clog;
  const char *count, *length;
};
inline constexpr CauseText cause_texts[] = {{Cause::wrapped, true, "wrapped", "clogging_length_wrapped"},
                                            {Cause::squeezed, true, "squeezed", "clogging_length_squeezed"},
                                            {Cause::hybrid, true, "hybrid", "clogging_length_hybrid"},
                                            {Cause::other, true, "other", "clogging_length_other"},
                                            {Cause::broken, false, "broken", "break_up_length"}};

/// The model's units in a laboratory; NaN if unknown.
struct LaboratoryScale {
  double length = std::numeric_limits<double>::quiet_NaN();  ///< sigma [mm]
  double time = std::numeric_limits<double>::quiet_NaN();    ///< t0 [s]
  double speed = std::numeric_limits<double>::quiet_NaN();   ///< v_t [mm/s]
  /// Interfacial tension of a droplet with Gamma = 1 [mN/m].
  double tension = std::numeric_limits<double>::quiet_NaN();
  /// Gamma of the laboratory's droplet, rounded as in the laboratory's runs. `own_tension` is the droplet's
  /// interfacial tension, not rounded [mN/m].
  double line_tension = std::numeric_limits<double>::quiet_NaN();
  double own_tension = std::numeric_limits<double>::quiet_NaN();
  double tilt = std::numeric_limits<double>::quiet_NaN();  ///< tilt of the plates [degrees]
};

/// The droplets of a device that were released upstream of a line across the flow, and may have passed it.
struct Passage {
  double x;  ///< x of the line, in the coordinates of the circles [sigma]
  int num_passed;
  int num_stopped;      ///< droplets that clogged or broke up before the line; all others were still moving
  fit::Interval share;  ///< interval of the fraction num_passed / (num_passed + num_stopped)
};

/// The runs of a sweep that differ only in their seed, and the results of these runs.
struct Group {
  sweep::RunRow first_row;  ///< parameters of all runs, except the seed
  /// A rest longer than this counts as a clog, see group_runs() [t0].
  double dwell = std::numeric_limits<double>::infinity();
  /// The latest Dwells::known_from of all runs; NaN if the dwells of a run are unknown [t0]
  double dwells_known_from = 0;
  fit::CloggingLength clogging;
  double least_squares_length = 0;  ///< length by the published, biased method; NaN for fewer than two clogs
  fit::WeibullTest weibull;
  /// Clogging length of the runs that met an obstacle, with distances counted from the first obstacle of each
  /// run.
  fit::CloggingLength clogging_met;
  /// Total number of contacts divided by total distance, of all runs that record contacts [1/sigma].
  double contacts_per_length = std::numeric_limits<double>::quiet_NaN();
  std::vector<fit::SurvivalStep> survival;
  /// Distances of the runs that did not clog, in increasing order [sigma].
  std::vector<double> censored_distances;
  /// The runs that ended by one cause. `causes` has an entry for each Cause, in the order of the enum; it is
  /// empty if the mechanism of a clog is unknown. Runs that the cause ended are events, all other runs are
  /// censored.
  struct EndsBy {
    const CauseText* text;
    fit::CloggingLength ends;
    std::vector<fit::IncidenceStep> incidence;  ///< steps of F_c; empty without a clogging length
  };
  std::vector<EndsBy> causes;
  fit::MeanSpeed relative_speed;         ///< mean of v_g/v_t over the runs that have a mean speed
  fit::MeanSpeed relative_speed_pooled;  ///< v_g/v_t, total distance divided by total time of these runs
  /// v_g/v_t, as total distance divided by total time of all runs, including those with a short distance. A
  /// run counts until its end, a clogged run until its last dwell began. This speed is not biased towards
  /// fast runs. `relative_speed` is biased if droplets clog, because only the faster droplets go far enough
  /// to have a mean speed.
  fit::MeanSpeed relative_speed_all;
  /// v_g/v_t, as total distance divided by total time of all runs from a fixed time on (SteadyRecord). A
  /// clogged run counts until its last dwell began. No choice in this method depends on the data.
  fit::MeanSpeed relative_speed_steady;
  fit::Migration migration;
  /// Tilt of the rows of posts from the flow towards +y, given by a lattice or by --row-angle; NaN: unknown
  /// [degrees].
  double row_angle = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::uint32_t> seeds;    ///< seeds of the runs that count for the clogging length
  std::vector<fit::Observation> runs;  ///< outcomes of these runs, in the same order
  int num_passed = 0;                  ///< runs with a droplet that reached the exit of the device
  int num_flowing = 0;                 ///< runs that max-time ended
  /// Number of runs in num_flowing whose droplet, at the end, had rested for longer than a free droplet takes
  /// to fall ten diameters. The next member is the shortest of these rests [t0].
  int num_resting = 0;
  double shortest_rest = std::numeric_limits<double>::infinity();
  int num_interrupted = 0;
  int num_repeated = 0;        ///< runs excluded by pooling, because a longer run of the same droplet counts
  int num_failed = 0;          ///< failed runs; those that count for the clogging length are censored
  int num_failed_counted = 0;  ///< failed runs that count for the clogging length
  int num_failed_somewhere = 0;  ///< failed runs at an unknown distance, excluded from all fits
  int num_damaged = 0;           ///< damaged runs, excluded from all fits
  /// Runs that ended before the distance from which runs count (see group_runs()). They are excluded from all
  /// fits.
  int num_left_out = 0;
  int num_on_mesh = 0;  ///< clogs that the corners of the polygon may hold (sweep::may_hang_on_mesh)
  int num_stability_unknown = 0;    ///< clogs with unknown stability (column stability)
  int num_near_friction_limit = 0;  ///< clogs with almost all friction used (sweep::is_near_friction_limit)
  /// Whether at least half of the clogs are at one place, or have exactly the distance of another clog. If no
  /// run clogged, this member compares the distances of the runs that met an obstacle.
  bool are_runs_equal = false;
  int num_free = 0;  ///< runs that met no obstacle
  /// For a device, the x of the droplets that were released away from their place on the entrance [sigma].
  std::vector<double> displaced;
  int num_repeating = 0;  ///< runs that went farther than their array's period
  /// Passages through a device, in downstream order; the last one is the exit.
  std::vector<Passage> passages;
  Families families;  ///< families of the runs that are over, with break-up=daughters
  std::vector<Doubt> doubts;
  std::optional<LaboratoryScale> laboratory = {};  ///< units in which results are also given
};

/// Terminal speed of the group's runs [mm/s]. The laboratory's droplet may have another terminal speed. NaN
/// if the laboratory does not specify a speed.
double terminal_speed_in_laboratory(const Group& group);

/// Number of failures divided by the distance of the runs that count for the clogging length; NaN if this
/// distance is 0 [1/sigma].
double failures_per_length(const Group& group);
/// Whether there are user-supplied circles with an entrance or an exit.
bool is_device(const RunParameters& run);
/// Whether some of the groups have families.
bool have_families(const std::vector<Group>& groups);

/// Whether a run has an outcome: it is intact, and did not fail at an unknown distance.
bool is_observed(const sweep::RunRow& run);

/// The outcome of a run that is_observed(). A failed run is censored at its sound distance. The distance
/// counts from the release. In a device it counts from the first obstacle that the droplet met; the outcome
/// is nullopt if the droplet met no obstacle.
std::optional<fit::Observation> observation_of(const sweep::RunRow& run);

/// Lines across the flow for the runs with the parameters of a row [sigma].
using LinesOf = std::function<std::vector<double>(const sweep::RunRow&)>;

/// Groups rows by all parameters except the seed. Sorts the groups by their findings, then by their
/// parameters. Runs count as in observation_of().
/// @param from_distance  the distance from which on runs are observed [sigma]. Runs that ended earlier are
/// excluded; the others count with their distance beyond it (left truncation).
/// @param dwell  a droplet that rested for longer than this counts as clogged at the place of its first such
/// rest [t0]. A droplet that neither clogged nor rested for so long is censored at the place where its last
/// dwell began, because the full length of that dwell is unknown. A `dwell` of max-time or more has no
/// effect.
/// @param pooled  columns of max-time and boxes that do not separate groups. If several runs have equal seeds
/// and arrays, only the run with the largest max-time counts. Runs with different `boxes` all count, because
/// equal seeds then give different arrays.
/// @param lines  returns lines [sigma] for a group, given its first row: the x of lines across a device (by
/// default the rows of posts), or the distances of lines for families
/// @throws Error if the rows do not record which droplets rested for longer than `dwell`
std::vector<Group> group_runs(std::span<const sweep::RunRow> rows, double confidence,
                              double from_distance = 0,
                              double dwell = std::numeric_limits<double>::infinity(),
                              std::span<const sweep::Column* const> pooled = {}, const LinesOf& lines = {});
/// The columns of a list of keys, which may be max-time, boxes or both: `max-time,boxes`. @throws Error for
/// any other key
std::vector<const sweep::Column*> pooled_columns(const std::string& keys);
/// Lateral displacement divided by the lateral displacement of a droplet that follows the rows of posts. In
/// deterministic lateral displacement, this ratio is 0 in the zigzag mode and 1 in the displacement (bump)
/// mode. NaN for rows along the flow.
fit::Migration share_along_rows(const Group& group);
/// Whether a run of this group can last longer than Group::dwell.
bool is_dwell_possible(const Group& group);

using sweep::Value;
/// A named value: a column of a CSV file, an entry of a JSON document and, with a head, a printed column.
struct Field {
  std::string name;
  Value value;
  std::string_view unit = {};            ///< e.g. "sigma"; empty for counts, words and pure numbers
  std::string head = {};                 ///< head of the printed column
  std::optional<std::string> text = {};  ///< printed in place of the value
};
/// Columns that define a group: all parameters except the seed. Physical parameters come first, and among
/// them those that shape the array.
std::span<const sweep::Column* const> group_columns();
/// The values of a row in these columns.
std::vector<Value> parameter_values(const sweep::RunRow& row);
/// Text that identifies the runs of a parameter set. Copies of the runs in other laboratories have the same
/// text.
/// @param row  row of one of the runs
std::string runs_of(sweep::RunRow row);
/// The kind of the group's results.
Finding finding_of(const Group& group);
/// Whether the results include a clogging length. There is no clogging length in a channel or on a wall,
/// because nothing is random there. Each group is then a single run, whose row has the results.
bool has_clogging_length(const sweep::RunRow& row);
inline constexpr const char* outcome_at_rest = "at rest";
/// How a run ended: the status in words. A droplet that stops on a bare wall is at rest, not clogged.
std::string outcome_of(const sweep::RunRow& row);
std::vector<Field> result_fields(const Group& group);

}  // namespace clog::results
