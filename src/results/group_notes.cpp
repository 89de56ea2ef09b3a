#include "group_notes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "clog/console/rounded.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/results/usual_parameters.hpp"
#include "result_columns.hpp"

namespace clog::results {
namespace {

/// Explains the letters in the last column.
std::string legend(const std::vector<Group>& groups) {
  std::vector<Doubt> all;
  for (const Group& group : groups) all.insert(all.end(), group.doubts.begin(), group.doubts.end());
  return legend_of(all);
}

/// Explains the stars of parameters whose values follow from other parameters.
/// @param named  parameters that are columns or words above the table
std::string note_of_automatic(const std::vector<Group>& groups, const std::vector<bool>& named) {
  for (std::size_t i = 0; i < named.size(); ++i)
    for (const Group& group : groups)
      if (named[i] && is_automatic(*group_columns()[i], group.first_row))
        return "*: the automatic value, which follows from other parameters\n";
  return "";
}

/// Explains the columns that need more than a head.
std::string column_notes(const std::vector<Group>& groups) {
  if (!has_clogging_length(groups.front().first_row)) return "";
  std::string text;
  const std::string of_others =
      fmt::format("other (for instance at rest on one obstacle{})",
                  std::ranges::any_of(groups, is_dwell_possible) ? "; or droplets that moved on" : "");
  const std::vector<const CauseText*> mechanisms = mechanisms_of_clogs(groups);
  if (are_mechanisms_shown(groups))
    text += fmt::format("w/s/h/o: clogs that are wrapped, squeezed, hybrid, {}\n", of_others);
  else if (!mechanisms.empty())
    text += fmt::format("clogs: all {}\n",
                        mechanisms.front()->cause == Cause::other ? of_others : mechanisms.front()->count);
  if (have_some_broken(groups))
    text +=
        "lambda_b: mean distance before break-up. Broken droplets are censored in lambda, clogged ones in "
        "lambda_b\n";
  if (have_families(groups))
    text +=
        "daughters: only the table with droplets per ancestor counts them. lambda, lambda_b, clogs and "
        "droplets that came past x are of released droplets until they break up. --dwell and "
        "--from-distance do not change the table of daughters. Droplets in small are not counted in "
        "droplets; for passing, their fate is unknown, like that of droplets in not known\n";
  if (std::ranges::any_of(groups, [](const Group& group) { return group.num_passed > 0; }))
    text +=
        "passed: droplets that reached the exit. They count as not clogged up to there, so lambda may "
        "exceed the device's length\n";
  if (std::ranges::all_of(groups, [](const Group& group) { return is_device(group.first_row.parameters); }))
    text +=
        "lambda_met: from the first obstacle that a droplet met; droplets that met none count only in the "
        "speeds\n";
  return text;
}

/// The largest time below the given time that has one significant digit.
double shorter_dwell(double rest) {
  const double unit = std::pow(10, std::floor(std::log10(rest)));
  const double digit = std::ceil(rest / unit) - 1;
  return digit < 1 ? 0.9 * unit : digit * unit;
}

/// Prints the number of resting droplets that are treated as moving, and names the option that treats them as
/// clogged.
std::string note_of_rest(const std::vector<Group>& groups) {
  int num_resting = 0;
  double shortest_rest = std::numeric_limits<double>::infinity(), known_from = 0;
  for (const Group& group : groups) {
    num_resting += group.num_resting;
    shortest_rest = std::min(shortest_rest, group.shortest_rest);
    known_from = std::max(known_from, group.dwells_known_from);
  }
  if (num_resting == 0 || !has_clogging_length(groups.front().first_row)) return "";
  std::string text = fmt::format("   {} ended by max-time with the droplet at rest for {} t0 or longer",
                                 count_text(num_resting, "run"), console::plain(shortest_rest));
  if (const double dwell = shorter_dwell(shortest_rest); dwell >= known_from)
    text +=
        fmt::format(": --dwell={} counts {} as clogged", shortest(dwell), num_resting == 1 ? "it" : "them");
  return text + '\n';
}

/// Gives the droplets that were not released on the entrance.
std::string note_of_displaced(const std::vector<Group>& groups) {
  std::vector<double> places;
  for (const Group& group : groups)
    places.insert(places.end(), group.displaced.begin(), group.displaced.end());
  if (places.empty()) return "";
  const auto [first, last] = std::ranges::minmax(places);
  return fmt::format(
      "   {} released in the nearest void, from x = {:.4g} to {:.4g}, because posts are at their place on "
      "the "
      "entrance; they count only at lines downstream of their release\n",
      places.size() == 1 ? "1 droplet was" : fmt::format("{} droplets were", places.size()), first, last);
}

/// Counts the runs that are missing from the table, or from some of its columns.
std::string left_out(const std::vector<Group>& groups) {
  const auto sum = [&](int Group::*number) {
    int all = 0;
    for (const Group& group : groups) all += group.*number;
    return all;
  };
  const int num_failed = sum(&Group::num_failed), num_damaged = sum(&Group::num_damaged),
            num_interrupted = sum(&Group::num_interrupted), num_left_out = sum(&Group::num_left_out),
            num_repeated = sum(&Group::num_repeated), num_excluded = sum(&Group::num_failed_somewhere);
  std::string text;
  if (num_left_out > 0)
    text += fmt::format(
        "   {} ended before --from-distance, left out of runs, clogs and lambda; <v_g> is still of all "
        "runs\n",
        count_text(num_left_out, "run"));
  if (num_interrupted > 0)
    text += fmt::format(
        "   {} {} unfinished: lambda holds for the distances reached so far, and the clogs so far are the "
        "early ones\n",
        count_text(num_interrupted, "run"), num_interrupted == 1 ? "is" : "are");
  if (num_repeated > 0)
    text += fmt::format("   {} repeat droplets of longer runs and do not count (--pool)\n",
                        count_text(num_repeated, "run"));
  if (num_failed > 0) {
    text += fmt::format("   {} failed; the column `message` says why", num_failed);
    if (has_clogging_length(groups.front().first_row))
      text += num_failed == num_excluded ? ", and left out because the distance is unknown"
              : num_excluded == 0
                  ? ", and counted as not clogged up to sound_distance"
                  : fmt::format(", counted as not clogged up to sound_distance, except {} without one",
                                num_excluded);
    text += '\n';
  }
  if (num_damaged > 0) text += fmt::format("   {} damaged; clogsweep verify tells which\n", num_damaged);
  return text;
}

}  // namespace

std::string notes_below(const std::vector<Group>& groups, const std::vector<bool>& named) {
  return legend(groups) + note_of_automatic(groups, named) + column_notes(groups) + note_of_rest(groups) +
         note_of_displaced(groups) + left_out(groups);
}

}  // namespace clog::results
