#include "clog/results/preview.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "clog/console/exit_codes.hpp"
#include "clog/console/json_text.hpp"
#include "clog/console/printable.hpp"
#include "clog/console/signals.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/core/world/lattice.hpp"
#include "clog/results/cost.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/obstacle_arrays.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/row_limits.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/value_list.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

/// One part of the preview, as text and as numbers.
struct Part {
  std::string text;
  Json json;

  template <class... Values>
  void line(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
    text += '\n';
  }
};

void print(Part part, PreviewFormat format) {
  part.json["text"] = part.text;
  std::cout << (format == PreviewFormat::json ? console::json_text(part.json, -1) : part.text);
}

/// Prints the text of a part that a signal or a failure ended early.
void print_incomplete(const Part& part, PreviewFormat format) {
  if (format == PreviewFormat::text) std::cout << part.text;
}

/// The columns that differ between tasks.
std::vector<const sweep::Column*> varying_columns(const sweep::Plan& plan) {
  const sweep::RunRow first = sweep::describe(plan.task(0));
  std::vector<bool> varies;
  for (const sweep::Column& column : sweep::columns())
    varies.push_back(column.parameter && column.parameter->role == ParameterRole::ensemble);
  for (std::int64_t group = 1; group < plan.num_groups(); ++group) {
    const sweep::RunRow row = sweep::describe(plan.group(group));
    for (std::size_t i = 0; i < varies.size(); ++i) {
      const sweep::Column& column = sweep::columns()[i];
      if (column.role == sweep::ColumnRole::parameter && !varies[i])
        varies[i] = column.get(row) != column.get(first);
    }
  }
  std::vector<const sweep::Column*> varying;
  for (std::size_t i = 0; i < varies.size(); ++i)
    if (varies[i]) varying.push_back(&sweep::columns()[i]);
  return varying;
}

void add_task(Part& part, const sweep::Plan& plan, std::int64_t task,
              const std::vector<const sweep::Column*>& columns) {
  const sweep::RunRow row = sweep::describe(plan.task(task));
  std::string line = std::to_string(task);
  Json json = {{"task", task}};
  for (const sweep::Column* column : columns) {
    const Value value = column->get(row);
    const std::string text = sweep::text_of(value);
    line += ' ' + (text.empty() ? "-" : text);
    json[column->name] = json_of(value);
  }
  part.line("{}", line);
  part.json["tasks"].push_back(std::move(json));
}

double work_per_step(const RunParameters& run) { return model_of(run).num_points(run); }
double longest_work(const RunParameters& run) { return run.max_time / *run.time_step * work_per_step(run); }

/// Sample of a sweep's runs from which its cost is estimated.
struct Sample {
  std::vector<RunCost> costs;
  std::string source;
  std::string failure;  ///< why the first run that could not begin failed; `costs` does not contain such runs
  std::int64_t num_clogged = 0;
  std::int64_t num_short = 0;  ///< clogged runs that ended within one obstacle spacing of their release
  double spacing = 0;          ///< obstacle spacing of such a run [sigma]
  bool has_own_circles = false;

  void count(const sweep::RunRow& row) {
    if (row.status != RunStatus::clogged) return;
    ++num_clogged;
    if (!(row.distance < sweep::obstacle_spacing(row))) return;
    ++num_short;
    spacing = sweep::obstacle_spacing(row);
    has_own_circles |= row.parameters.obstacles.layout == ObstacleLayout::file;
  }
};

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

constexpr std::size_t fewest_stored_runs = 5;
constexpr double hour = 3600;

/// The sample of runs in the sweep's own file; empty without a file.
struct Stored {
  Sample sample;
  std::vector<WaitingRuns> waiting;  ///< runs of each parameter set that are not in the sample
  std::int64_t num_done = 0;         ///< tasks that need not run again
  double seconds = 0;                ///< time that the tasks have taken so far

  bool knows_enough() const { return sample.costs.size() >= fewest_stored_runs; }
};
Stored stored_runs(const sweep::Plan& plan, const std::string& path) {
  Stored stored;
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

/// Tasks spread over parameter sets and, if there are few sets, over seeds; tasks of the same array are
/// adjacent.
std::vector<std::int64_t> tasks_to_try(const sweep::Plan& plan) {
  constexpr std::int64_t most_tasks = 24;
  constexpr std::int64_t most_seeds = 4;  // with many parameter sets, because arrays may take long to build
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

constexpr double seconds_to_try = 10;

/// Runs short pieces of these tasks. The jobs may be computed by another process, which answers between
/// slices of its work; a job that takes too long, such as a release that does not come to rest, is dropped.
Sample tried_sample(const sweep::Plan& plan, const sweep::JobFactory& jobs) {
  constexpr double fewest_seconds =
      0.1;                       // time for a run if its array has used up the run's share of the time [s]
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
    advance_until(*job, seconds_to_try + grace, answers);  // time of its array and its release
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
    sample.failure = fmt::format("its release takes longer than {:.2g} s", seconds_to_try);
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

/// Adds seconds to a cost; negative seconds subtract.
SweepCost plus(SweepCost cost, double seconds) {
  for (double* part : {&cost.bound, &cost.expected, &cost.lower, &cost.upper})
    *part = std::max(0.0, *part + seconds);
  return cost;
}

/// Replaces the estimate and its limit; the interval keeps its relative width.
SweepCost with_expected(SweepCost trials, const SweepCost& stored) {
  trials.bound = stored.bound;
  trials.lower *= stored.expected / trials.expected;
  trials.upper = std::min(trials.bound, trials.upper * stored.expected / trials.expected);
  trials.expected = stored.expected;
  return trials;
}

Json hours_json(const SweepCost& cost) {
  return {{"expected", cost.expected / hour}, {"lower", cost.lower / hour}, {"upper", cost.upper / hour}};
}

void add_expected(Part& part, const sweep::Plan& plan, const Sample& sample, const SweepCost& cost) {
  const double us_per_step = 1e6 * cost.seconds_per_work * work_per_step(plan.task(0));
  part.line(
      "# at most {:.3g} core-hours on this machine, {:.3g} us per step measured; runs that clog end sooner",
      cost.bound / hour, us_per_step);
  const auto num_finished =
      std::count_if(sample.costs.begin(), sample.costs.end(), [](const RunCost& run) { return run.is_over; });
  const auto num_runs = static_cast<std::int64_t>(sample.costs.size());
  part.line("# expected {:.2g} core-hours (95 %: {:.2g} to {:.2g}), from {} {}, {} of them ended",
            cost.expected / hour, cost.lower / hour, cost.upper / hour, count_text(num_runs, "run"),
            sample.source, num_finished);
  part.json["at_most"] = cost.bound / hour;
  part.json["us_per_step"] = us_per_step;
  part.json.update(hours_json(cost));
  part.json["sample"] = {{"runs", num_runs}, {"ended", num_finished}, {"source", sample.source}};
}

/// @param cost  of the whole plan
void add_left(Part& part, const sweep::Plan& plan, const std::string& output, const Stored& stored,
              const SweepCost& cost) {
  const SweepCost left = plus(cost, -stored.seconds);
  part.line("# {} has {} of {}; {} to go: expected {:.2g} core-hours more (95 %: {:.2g} to {:.2g})",
            console::printable(output), stored.num_done, count_text(plan.num_runs(), "run"),
            plan.num_runs() - stored.num_done, left.expected / hour, left.lower / hour, left.upper / hour);
  part.json["left"] = hours_json(left);
}

/// Warns before the runs about clogging lengths below an obstacle spacing, which clogfit would doubt (`v`).
void add_short_lengths(Part& part, const Sample& sample) {
  constexpr std::int64_t fewest = 3;
  constexpr std::int64_t one_in =
      4;  // with a clogging length of five spacings, one distance in six would be below one spacing
  if (sample.num_short < fewest || one_in * sample.num_short < sample.num_clogged) return;
  part.line(
      "# {} of {} clogged within one obstacle spacing ({:.3g} sigma) of their release: such lengths "
      "reflect the release void, not clogging (v); {}",
      sample.num_short, count_text(sample.num_clogged, "run"), sample.spacing,
      sample.has_own_circles ? "the share of droplets that got past says more"
                             : "give fewer obstacles, e.g. the default obstacle-density");
  part.json["short_lengths"] = {
      {"runs", sample.num_short}, {"clogged", sample.num_clogged}, {"obstacle_spacing", sample.spacing}};
}

SweepCost times(SweepCost cost, double factor) {
  for (double* part : {&cost.bound, &cost.expected, &cost.lower, &cost.upper}) *part *= factor;
  return cost;
}

/// Limits of the cost of a sweep that adds seeds.
/// @param cost  of the sweep's first round
void add_rounds(Part& part, const SeedRule& rule, std::int64_t first_seeds, const SweepCost& cost) {
  const std::int64_t needed = rule.clogs_needed(), most = rule.most_seeds();
  part.line("# this is the first round: +-{} % needs {} per parameter set",
            sweep::shortest(100 * rule.precision()), count_text(needed, "clog"));
  if (most < needed) part.line("# --most-seeds={} ends it before that; give {} or more", most, needed);
  const auto of_rounds = [&](std::int64_t num_seeds) {
    return times(cost, static_cast<double>(num_seeds) / static_cast<double>(first_seeds));
  };
  const auto expected = [](const SweepCost& all) {
    return fmt::format("expected {:.2g} core-hours (95 %: {:.2g} to {:.2g})", all.expected / hour,
                       all.lower / hour, all.upper / hour);
  };
  const std::int64_t fewest = std::clamp(needed, first_seeds, most);
  const SweepCost least = of_rounds(fewest), largest = of_rounds(most);
  part.line(
      "# all rounds: {} each if every run clogs, {}; {} each (--most-seeds) if few do, {}, at most {:.3g}",
      count_text(fewest, "seed"), expected(least), count_text(most, "seed"), expected(largest),
      largest.bound / hour);
  Json if_all_clog = hours_json(least), if_few_clog = hours_json(largest);
  if_all_clog["seeds"] = fewest;
  if_few_clog["seeds"] = most;
  if_few_clog["at_most"] = largest.bound / hour;
  part.json["all_rounds"] = {
      {"clogs_needed", needed}, {"if_all_clog", if_all_clog}, {"if_few_clog", if_few_clog}};
}

void add_lattices(Part& part, const sweep::Plan& plan) {
  constexpr std::size_t most_lines = 10;
  std::vector<std::string> lines;
  for (std::int64_t group = 0; group < plan.num_groups() && lines.size() <= most_lines; ++group) {
    const ObstacleParameters obstacles = plan.group(group).obstacles;
    if (obstacles.layout != ObstacleLayout::lattice) continue;
    std::string line = lattice_text(obstacles);
    if (std::ranges::find(lines, line) != lines.end()) continue;
    lines.push_back(std::move(line));
    if (lines.size() <= most_lines)
      part.json["lattices"].push_back({{"pitch", obstacles.spacing()},
                                       {"row_spacing", row_spacing(obstacles)},
                                       {"angle", obstacles.lattice_angle},
                                       {"length", obstacles.period().along()},
                                       {"box", obstacles.box}});
  }
  if (lines.size() > most_lines) lines.back() = "more lattices: not listed";
  for (const std::string& line : lines) part.line("# {}", line);
}

std::string seeds_in_words(const sweep::Plan& plan) {
  std::int64_t fewest = plan.num_seeds(0), most = 0;
  for (std::int64_t group = 0; group < plan.num_groups(); ++group) {
    fewest = std::min(fewest, plan.num_seeds(group));
    most = std::max(most, plan.num_seeds(group));
  }
  return fewest == most ? count_text(most, "seed") : fmt::format("{} to {} seeds", fewest, most);
}

}  // namespace

void print_tasks(const sweep::Plan& plan, PreviewFormat format) {
  constexpr std::int64_t most_lines = 1000;
  constexpr std::int64_t lines_at_an_end = 20;
  const std::int64_t num_skipped = plan.size() > most_lines ? plan.size() - 2 * lines_at_an_end : 0;
  const std::vector<const sweep::Column*> columns = varying_columns(plan);
  Part part{.text = "# task",
            .json = {{"number_of_tasks", plan.size()},
                     {"parameter_sets", plan.num_groups()},
                     {"runs", plan.num_runs()},
                     {"tasks", Json::array()}}};
  for (const sweep::Column* column : columns) part.text += ' ' + column->name;
  part.text += '\n';
  for (std::int64_t task = 0; task < plan.size(); ++task) {
    if (console::stop_signalled()) return print_incomplete(part, format);
    if (num_skipped > 0 && task == lines_at_an_end) {
      part.line("# ... {} more ...", num_skipped);
      task += num_skipped;
    }
    add_task(part, plan, task, columns);
  }
  part.line("# {}: {}, {} each", count_text(plan.size(), "task"),
            count_text(plan.num_groups(), "parameter set"), seeds_in_words(plan));
  if (const std::int64_t number = plan.size() - plan.num_runs(); number > 0)
    part.line("# {} the same {} in another laboratory, which {} once",
              number == 1 ? "1 task is" : fmt::format("{} tasks are", number), number == 1 ? "run" : "runs",
              number == 1 ? "is computed" : "are computed");
  add_lattices(part, plan);
  print(std::move(part), format);
}

void print_refusal(const Refusal& refusal) {
  const Refusal::About& about = refusal.about();
  Json json = {{"refused", about.key.empty() ? about.excluded.front() : about.key}, {"text", refusal.what()}};
  if (!about.nearest.empty()) json["nearest"] = about.nearest;
  std::cout << console::json_text(json, -1);
}

int print_cost(const sweep::Plan& plan, const std::string& output, const SeedRule* rule,
               const sweep::JobFactory& jobs, PreviewFormat format) {
  Part part;
  for (const std::string& words : sweep::limits_of_results(plan))
    part.line("# {}", console::printable(words));
  const Stored stored = stored_runs(plan, output);
  const bool is_done = stored.num_done == plan.num_runs();
  part.json = {{"runs", plan.num_runs()}, {"finished", stored.num_done}, {"spent", stored.seconds / hour}};
  if (is_done)
    part.line("# {} has all {}, which took {:.2g} core-hours{}", console::printable(output),
              count_text(plan.num_runs(), "run"), stored.seconds / hour,
              rule ? "" : "; nothing is left to do");
  if (!is_done || rule) {
    const Sample sample = stored.knows_enough() ? stored.sample : tried_sample(plan, jobs);
    if (console::stop_signalled() || sample.costs.empty()) print_incomplete(part, format);
    if (console::stop_signalled()) return console::exit_incomplete;
    if (sample.costs.empty()) {
      console::say("clogsweep: no trial run can start; the first one: " + sample.failure);
      return console::exit_internal_fault;
    }
    const SweepCost of_trials = tried_cost(plan, sample);
    const SweepCost cost =
        stored.knows_enough() ? plus(cost_left(sample.costs, stored.waiting), stored.seconds) : of_trials;
    if (!is_done) add_short_lengths(part, sample);
    if (!is_done) add_expected(part, plan, sample, cost);
    if (!is_done && stored.seconds > 0) add_left(part, plan, output, stored, cost);
    if (rule) add_rounds(part, *rule, plan.size() / plan.num_groups(), with_expected(of_trials, cost));
  }
  print(std::move(part), format);
  return console::exit_success;
}

void print_config(const sweep::Settings& settings, const sweep::Plan& plan) {
  const RunParameters first = plan.task(0);
  std::cout << settings.to_config(sweep::Comments::help) << "\n# Values behind `auto` in the first task:\n";
  for (const Parameter& parameter : parameter_schema())
    if (parameter.may_be_automatic(first) || parameter.key == std::string_view("wall-tension"))
      if (const ParameterValue value = parameter.get(first); value != ParameterValue())
        fmt::print(std::cout, "# {} = {}\n", parameter.key, sweep::text_of(value));
}

}  // namespace clog::results
