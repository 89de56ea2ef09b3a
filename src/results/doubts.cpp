#include "clog/results/doubts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "clog/core/parameters/contact_angle.hpp"
#include "clog/core/polygon/wetting/contact_line.hpp"
#include "clog/results/groups.hpp"
#include "clog/sweep/row_limits.hpp"

namespace clog::results {
namespace {

/// Whether so many clogs may be artefacts of the mesh that the length may be wrong.
bool hangs_on_mesh(const Group& group) {
  constexpr double tolerated = 0.1;  // tolerated fraction of the clogs
  return group.num_on_mesh > 0 && group.num_on_mesh >= tolerated * group.clogging.num_clogs;
}

/// Whether the length may be wrong because a finer mesh may let many of the clogged droplets go.
bool is_near_friction_limit(const Group& group) {
  constexpr double tolerated = 0.15;  // tolerated fraction of the clogs
  return group.num_near_friction_limit > tolerated * group.clogging.num_clogs;
}

}  // namespace

std::vector<Doubt> doubts_about(const Group& group) {
  const fit::CloggingLength& clogging = group.clogging;
  const bool has_length = has_clogging_length(group.first_row);
  // If all droplets passed the exit, few clogs are no reason for a doubt, because more seeds would only raise
  // the lower bound.
  const bool lacks_clogs =
      clogging.num_runs > 0 && group.num_passed != clogging.num_runs && clogging.num_clogs < enough_clogs;
  // Assumes the worst case, in which every failure hides a clog.
  const int num_failures = group.num_failed_counted + group.num_failed_somewhere;
  const bool do_failures_matter =
      num_failures > 0 &&
      clogging.total_distance < (clogging.num_clogs + num_failures) * clogging.interval.lower;
  const bool is_below_spacing = clogging.length < sweep::obstacle_spacing(group.first_row);
  const RunParameters& run = group.first_row.parameters;
  const bool wets_walls = run.model == Model::dp && (wall_tension(run.dp) < 1 || has_hysteresis(run.dp));
  const std::pair<Doubt, bool> all[] = {
      {Doubt::few_clogs, has_length && lacks_clogs},
      {Doubt::equal_distances, has_length && group.are_runs_equal},
      {Doubt::censored_by_time, has_length && group.num_flowing > 0},
      {Doubt::incomplete, group.num_interrupted > 0 || group.num_failed_somewhere > 0},
      {Doubt::damaged, group.num_damaged > 0},
      {Doubt::held_by_mesh, has_length && hangs_on_mesh(group)},
      {Doubt::near_friction_limit, has_length && is_near_friction_limit(group)},
      {Doubt::wetted_mesh, has_length && clogging.num_clogs > 0 && wets_walls},
      {Doubt::array_repeats, has_length && group.num_repeating > 0},
      {Doubt::met_none, has_length && group.num_free > 0 && !is_device(group.first_row.parameters)},
      {Doubt::below_spacing, has_length && is_below_spacing},
      {Doubt::failures_matter, has_length && do_failures_matter},
      {Doubt::untested, !sweep::untested_parameters(group.first_row).empty()}};
  std::vector<Doubt> doubts;
  for (const auto& [doubt, holds] : all)
    if (holds) doubts.push_back(doubt);
  return doubts;
}

void doubt_exponentiality(std::vector<Group>& groups) {
  std::map<std::string, std::size_t> first;  // groups by their runs
  std::vector<fit::WeibullTest> tests;
  std::vector<std::size_t> test_of;
  for (const Group& group : groups) {
    const auto [known, is_new] = first.emplace(runs_of(group.first_row), tests.size());
    if (is_new) tests.push_back(group.weibull);
    test_of.push_back(known->second);
  }
  const std::vector<bool> are_not = fit::are_not_exponential(tests);
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (are_not[test_of[i]]) groups[i].doubts.push_back(Doubt::not_exponential);
}

const DoubtText& text_of(Doubt doubt) {
  return *std::find_if(std::begin(doubt_texts), std::end(doubt_texts),
                       [=](const DoubtText& text) { return text.doubt == doubt; });
}

std::string letters_of(const std::vector<Doubt>& doubts) {
  std::string letters;
  for (const Doubt doubt : doubts) letters += text_of(doubt).letter;
  return letters;
}

std::string words_of(const std::vector<Doubt>& doubts) {
  std::string words;
  for (const Doubt doubt : doubts) words += (words.empty() ? "" : " ") + std::string(text_of(doubt).word);
  return words;
}

std::string legend_of(const std::vector<Doubt>& doubts) {
  std::string legend;
  for (const DoubtText& text : doubt_texts)
    if (std::ranges::find(doubts, text.doubt) != doubts.end())
      legend += fmt::format("{}{}: {}\n", legend.empty() ? "\n" : "", text.letter, text.sentence);
  return legend;
}

}  // namespace clog::results
