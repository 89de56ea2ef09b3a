#include "run_sample.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <unordered_map>

#include "clog/console/signals.hpp"
#include "clog/core/model/model.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/sweep/obstacle_arrays.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/row_limits.hpp"
#include "clog/sweep/run_row.hpp"

namespace clog::results {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double seconds_to_try = 10;

double longest_work(const RunParameters& run) { return run.max_time / *run.time_step * work_per_step(run); }

/// Cost of a run up to `row`. @param first  row of the same run when it had just started
RunCost cost_of(const sweep::RunRow& row, const sweep::RunRow& first, const RunParameters& run,
                std::int64_t parameter_set) {
  return {.parameter_set = parameter_set,
          .begin_seconds = sweep::cost_seconds(first),
          .seconds = sweep::cost_seconds(row) - sweep::cost_seconds(first),
          .work = static_cast<double>(row.steps - first.steps) * work_per_step(run),
          .longest_work = longest_work(run),
          .is_over = !sweep::is_unfinished(row.status)};
}

/// Tasks spread over parameter sets and, if there are few sets, over seeds. Tasks of one array are adjacent.
std::vector<std::int64_t> tasks_to_try(const sweep::Plan& plan) {
  constexpr std::int64_t most_tasks = 24;
  constexpr std::int64_t most_seeds = 4;  // with many parameter sets, because building arrays may take long
  const std::int64_t num_tasks = std::min(plan.size(), most_tasks);
  const std::int64_t num_groups = plan.num_groups();
  std::vector<std::int64_t> tasks;
  for (std::int64_t i = 0; i < num_tasks; ++i) {
    const std::int64_t group = i * num_groups / num_tasks;
    tasks.push_back(
        num_groups <= num_tasks ? i : plan.task_of(group, i % std::min(most_seeds, plan.num_seeds(group))));
  }
  std::stable_sort(tasks.begin(), tasks.end(), [&](std::int64_t a, std::int64_t b) {
    const auto array = [&](std::int64_t task) {
      const RunParameters run = plan.task(task);
      return sweep::array_key(run);
    };
    return array(a) < array(b);
  });
  return tasks;
}

}  // namespace

double work_per_step(const RunParameters& run) { return model_of(run).num_points(run); }

void Sample::count(const sweep::RunRow& row) {
  if (row.status != RunStatus::clogged) return;
  ++num_clogged;
  if (!(row.distance < sweep::obstacle_spacing(row))) return;
  ++num_short;
  spacing = sweep::obstacle_spacing(row);
  has_own_circles |= row.parameters.obstacles.layout == ObstacleLayout::file;
}

StoredSample stored_runs(const sweep::Plan& plan, const std::string& path) {
  StoredSample stored;
  stored.sample.source = "in " + path;
  if (path.empty() || !std::filesystem::exists(path)) return stored;
  std::unordered_multimap<std::string, sweep::RunRow> rows;
  for (const sweep::RunRow& row : read_with_caution(path).rows)
    if (sweep::fault_of(row).empty()) rows.emplace(sweep::identity_in_any_laboratory(row), row);
  for (std::int64_t set = 0; set < plan.num_groups(); ++set)
    stored.waiting.push_back(
        {set, plan.has_twin(set) ? 0 : plan.num_seeds(set), longest_work(plan.group(set))});
  for (std::int64_t task = 0; task < plan.size() && !rows.empty(); ++task) {
    if (plan.twin(task)) continue;
    const RunParameters run = plan.task(task);
    const auto found = rows.extract(sweep::identity_in_any_laboratory(sweep::describe(run)));
    if (found.empty()) continue;
    const sweep::RunRow& row = found.mapped();
    const std::int64_t set = plan.group_of(task);
    const bool is_over = !sweep::is_unfinished(row.status);
    const bool has_moved = row.steps > 0 && sweep::cost_seconds(row) > 0;
    stored.num_done += is_over;
    stored.seconds += sweep::cost_seconds(row);
    if (has_moved) stored.sample.costs.push_back(cost_of(row, {}, run, set));
    stored.sample.count(row);
    if (is_over || has_moved) --stored.waiting[set].number;
  }
  return stored;
}

Sample tried_sample(const sweep::Plan& plan, const sweep::JobFactory& jobs) {
  constexpr double fewest_seconds =
      0.1;  // time for a run if building its array has used up the run's share of the time [s]
  constexpr double grace = 0.5;  // time to wait for the last answer [s]
  const Clock::time_point begin = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const auto advance_until = [&](sweep::Job& job, double end, const auto& is_enough) {
    while (!job.advance())
      if (is_enough() || elapsed() >= end || console::stop_signalled()) return;
  };
  Sample sample;
  const std::vector<std::int64_t> tasks = tasks_to_try(plan);
  for (std::size_t i = 0; i < tasks.size() && elapsed() < seconds_to_try && !console::stop_signalled(); ++i) {
    const double share = (seconds_to_try - elapsed()) / static_cast<double>(tasks.size() - i);
    const double end = elapsed() + share;
    const auto job = jobs(tasks[i], {});
    const auto answers = [&] { return job->refresh(); };
    advance_until(*job, seconds_to_try + grace, answers);  // includes the time for array and release
    const sweep::RunRow first = job->row();
    advance_until(*job, std::max(end, elapsed() + fewest_seconds), [] { return false; });
    advance_until(*job, seconds_to_try + grace, answers);
    const sweep::RunRow row = job->row();
    const bool is_short = !sweep::is_unfinished(row.status) && !sweep::is_unfinished(first.status);
    sample.count(row);
    if (row.steps > 0)
      sample.costs.push_back(
          cost_of(row, is_short ? sweep::RunRow() : first, plan.task(tasks[i]), plan.group_of(tasks[i])));
    else if (sample.failure.empty())
      sample.failure = row.message;
  }
  if (sample.failure.empty())
    sample.failure =
        fmt::format("its release takes longer than {:.2g} s; a narrower box takes less", seconds_to_try);
  sample.source = fmt::format("tried for {:.2g} s in total", elapsed());
  return sample;
}

SweepCost tried_cost(const sweep::Plan& plan, const Sample& sample) {
  double all_work = 0;
  for (std::int64_t group = 0; group < plan.num_groups(); ++group)
    if (!plan.has_twin(group))
      all_work += longest_work(plan.group(group)) * static_cast<double>(plan.num_seeds(group));
  return sweep_cost(sample.costs, all_work, plan.num_runs());
}

}  // namespace clog::results
