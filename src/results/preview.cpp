#include "clog/results/preview.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "clog/console/exit_codes.hpp"
#include "clog/console/json_text.hpp"
#include "clog/console/printable.hpp"
#include "clog/console/signals.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/core/world/lattice.hpp"
#include "clog/results/cost.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/row_limits.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/value_list.hpp"
#include "run_sample.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

using Json = nlohmann::ordered_json;
constexpr double hour = 3600;

/// The preview, as text and as numbers.
struct Preview {
  std::string text;
  Json json;

  template <class... Values>
  void line(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
    text += '\n';
  }
};

void print(Preview& preview, PreviewFormat format) {
  preview.json["text"] = preview.text;
  std::cout << (format == PreviewFormat::json ? console::json_text(preview.json, -1) : preview.text);
}

/// Prints the text of a preview that a signal or a failure has ended early.
void print_incomplete(const Preview& preview, PreviewFormat format) {
  if (format == PreviewFormat::text) std::cout << preview.text;
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

void add_task(Preview& preview, const sweep::Plan& plan, std::int64_t task,
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
  preview.line("{}", line);
  preview.json["tasks"].push_back(std::move(json));
}

/// Adds seconds to a cost; negative seconds subtract.
SweepCost plus(SweepCost cost, double seconds) {
  for (double* part : {&cost.bound, &cost.expected, &cost.lower, &cost.upper})
    *part = std::max(0.0, *part + seconds);
  return cost;
}

/// Replaces the estimate and the bound by those of `stored`. The interval keeps its relative width.
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

void add_expected(Preview& preview, const sweep::Plan& plan, const Sample& sample, const SweepCost& cost) {
  const double us_per_step = 1e6 * cost.seconds_per_work * work_per_step(plan.task(0));
  preview.line(
      "# at most {:.3g} core-hours on this machine, {:.3g} us per step measured; runs that clog end sooner",
      cost.bound / hour, us_per_step);
  const auto num_finished =
      std::count_if(sample.costs.begin(), sample.costs.end(), [](const RunCost& run) { return run.is_over; });
  const auto num_runs = static_cast<std::int64_t>(sample.costs.size());
  preview.line("# expected {:.2g} core-hours (95 %: {:.2g} to {:.2g}), from {} {}, {} of them ended",
               cost.expected / hour, cost.lower / hour, cost.upper / hour, count_text(num_runs, "run"),
               sample.source, num_finished);
  preview.json["at_most"] = cost.bound / hour;
  preview.json["us_per_step"] = us_per_step;
  preview.json.update(hours_json(cost));
  preview.json["sample"] = {{"runs", num_runs}, {"ended", num_finished}, {"source", sample.source}};
}

/// @param cost  cost of the whole plan
void add_left(Preview& preview, const sweep::Plan& plan, const std::string& output,
              const StoredSample& stored, const SweepCost& cost) {
  const SweepCost left = plus(cost, -stored.seconds);
  preview.line("# {} has {} of {}; {} to go: expected {:.2g} core-hours more (95 %: {:.2g} to {:.2g})",
               console::printable(output), stored.num_done, count_text(plan.num_runs(), "run"),
               plan.num_runs() - stored.num_done, left.expected / hour, left.lower / hour, left.upper / hour);
  preview.json["left"] = hours_json(left);
}

/// Adds a warning if clogging lengths may be below an obstacle spacing. clogfit would mark such lengths with
/// the doubt `v`.
void add_short_lengths(Preview& preview, const Sample& sample) {
  constexpr std::int64_t fewest = 3;
  constexpr std::int64_t one_in =
      4;  // with a clogging length of five spacings, one distance in six would be below one spacing
  if (sample.num_short < fewest || one_in * sample.num_short < sample.num_clogged) return;
  preview.line(
      "# {} of {} clogged within one obstacle spacing ({:.3g} sigma) of their release: such lengths "
      "reflect the release void, not clogging (v); {}",
      sample.num_short, count_text(sample.num_clogged, "run"), sample.spacing,
      sample.has_own_circles ? "the share of droplets that got past says more"
                             : "give fewer obstacles, e.g. the default obstacle-density");
  preview.json["short_lengths"] = {
      {"runs", sample.num_short}, {"clogged", sample.num_clogged}, {"obstacle_spacing", sample.spacing}};
}

SweepCost times(SweepCost cost, double factor) {
  for (double* part : {&cost.bound, &cost.expected, &cost.lower, &cost.upper}) *part *= factor;
  return cost;
}

/// Prints limits of the cost of a sweep that adds seeds.
/// @param cost  cost of the sweep's first round
void add_rounds(Preview& preview, const SeedRule& rule, std::int64_t first_seeds, const SweepCost& cost) {
  const std::int64_t needed = rule.clogs_needed(), most = rule.most_seeds();
  preview.line("# this is the first round: +-{} % needs {} per parameter set",
               sweep::shortest(100 * rule.precision()), count_text(needed, "clog"));
  if (most < needed) preview.line("# --most-seeds={} ends it before that; give {} or more", most, needed);
  const auto of_rounds = [&](std::int64_t num_seeds) {
    return times(cost, static_cast<double>(num_seeds) / static_cast<double>(first_seeds));
  };
  const auto expected = [](const SweepCost& all) {
    return fmt::format("expected {:.2g} core-hours (95 %: {:.2g} to {:.2g})", all.expected / hour,
                       all.lower / hour, all.upper / hour);
  };
  const std::int64_t fewest = std::clamp(needed, first_seeds, most);
  const SweepCost least = of_rounds(fewest), largest = of_rounds(most);
  preview.line(
      "# all rounds: {} each if every run clogs, {}; {} each (--most-seeds) if few do, {}, at most {:.3g}",
      count_text(fewest, "seed"), expected(least), count_text(most, "seed"), expected(largest),
      largest.bound / hour);
  Json if_all_clog = hours_json(least), if_few_clog = hours_json(largest);
  if_all_clog["seeds"] = fewest;
  if_few_clog["seeds"] = most;
  if_few_clog["at_most"] = largest.bound / hour;
  preview.json["all_rounds"] = {
      {"clogs_needed", needed}, {"if_all_clog", if_all_clog}, {"if_few_clog", if_few_clog}};
}

void add_lattices(Preview& preview, const sweep::Plan& plan) {
  constexpr std::size_t most_lines = 10;
  std::vector<std::string> lines;
  for (std::int64_t group = 0; group < plan.num_groups() && lines.size() <= most_lines; ++group) {
    const ObstacleParameters obstacles = plan.group(group).obstacles;
    if (obstacles.layout != ObstacleLayout::lattice) continue;
    std::string line = lattice_text(obstacles);
    if (std::ranges::find(lines, line) != lines.end()) continue;
    lines.push_back(std::move(line));
    if (lines.size() <= most_lines)
      preview.json["lattices"].push_back({{"pitch", obstacles.spacing()},
                                          {"row_spacing", row_spacing(obstacles)},
                                          {"angle", obstacles.lattice_angle},
                                          {"length", obstacles.period().along()},
                                          {"box", obstacles.box}});
  }
  if (lines.size() > most_lines) lines.back() = "more lattices: not listed";
  for (const std::string& line : lines) preview.line("# {}", line);
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
  Preview preview{.text = "# task",
                  .json = {{"number_of_tasks", plan.size()},
                           {"parameter_sets", plan.num_groups()},
                           {"runs", plan.num_runs()},
                           {"tasks", Json::array()}}};
  for (const sweep::Column* column : columns) preview.text += ' ' + column->name;
  preview.text += '\n';
  for (std::int64_t task = 0; task < plan.size(); ++task) {
    if (console::stop_signalled()) return print_incomplete(preview, format);
    if (num_skipped > 0 && task == lines_at_an_end) {
      preview.line("# ... {} more ...", num_skipped);
      task += num_skipped;
    }
    add_task(preview, plan, task, columns);
  }
  preview.line("# {}: {}, {} each", count_text(plan.size(), "task"),
               count_text(plan.num_groups(), "parameter set"), seeds_in_words(plan));
  if (const std::int64_t number = plan.size() - plan.num_runs(); number > 0)
    preview.line("# {} the same {} in another laboratory, which {} once",
                 number == 1 ? "1 task is" : fmt::format("{} tasks are", number),
                 number == 1 ? "run" : "runs", number == 1 ? "is computed" : "are computed");
  add_lattices(preview, plan);
  for (const std::string& words : sweep::limits_of_results(plan))
    preview.line("# {}", console::printable(words));
  print(preview, format);
}

void print_refusal(const Refusal& refusal) {
  const Refusal::About& about = refusal.about();
  Json json = {{"refused", about.key.empty() ? about.excluded.front() : about.key}, {"text", refusal.what()}};
  if (!about.nearest.empty()) json["nearest"] = about.nearest;
  std::cout << console::json_text(json, -1);
}

int print_cost(const sweep::Plan& plan, const std::string& output, const SeedRule* rule,
               const sweep::JobFactory& jobs, PreviewFormat format) {
  Preview preview{.text = "", .json = {}};
  const StoredSample stored = stored_runs(plan, output);
  const bool is_done = stored.num_done == plan.num_runs();
  preview.json = {{"runs", plan.num_runs()}, {"finished", stored.num_done}, {"spent", stored.seconds / hour}};
  if (is_done)
    preview.line("# {} has all {}, which took {:.2g} core-hours{}", console::printable(output),
                 count_text(plan.num_runs(), "run"), stored.seconds / hour,
                 rule ? "" : "; nothing is left to do");
  if (!is_done || rule) {
    const Sample sample = stored.knows_enough() ? stored.sample : tried_sample(plan, jobs);
    if (console::stop_signalled() || sample.costs.empty()) print_incomplete(preview, format);
    if (console::stop_signalled()) return console::exit_incomplete;
    if (sample.costs.empty()) {
      console::say("clogsweep: no trial run can start; the first one: " + sample.failure);
      return console::exit_internal_fault;
    }
    const SweepCost of_trials = tried_cost(plan, sample);
    const SweepCost cost =
        stored.knows_enough() ? plus(cost_left(sample.costs, stored.waiting), stored.seconds) : of_trials;
    if (!is_done) add_short_lengths(preview, sample);
    if (!is_done) add_expected(preview, plan, sample, cost);
    if (!is_done && stored.seconds > 0) add_left(preview, plan, output, stored, cost);
    if (rule) add_rounds(preview, *rule, plan.size() / plan.num_groups(), with_expected(of_trials, cost));
  }
  print(preview, format);
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
