#include "clog/results/status.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "clog/console/json_text.hpp"
#include "clog/console/printable.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/results/progress.hpp"
#include "clog/store/journal.hpp"
#include "clog/sweep/plan.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

using sweep::RunRow;

/// Times of the parameter sets of the last config. With --until-precision, sets may have different numbers of
/// seeds. This function does not know these numbers, so it uses their mean for each set.
std::vector<SetTimes> times_of_sets(const std::vector<RunRow>& rows, const sweep::Plan& plan,
                                    std::int64_t num_wanted) {
  std::vector<SetTimes> sets(static_cast<std::size_t>(plan.num_groups()));
  for (const RunRow& row : rows) {
    if (row.task < 0 || row.task >= plan.size()) continue;
    sets[static_cast<std::size_t>(plan.group_of(row.task))].count(row);
  }
  for (std::int64_t group = 0; group < plan.num_groups(); ++group) {
    SetTimes& set = sets[static_cast<std::size_t>(group)];
    const std::int64_t wanted =
        num_wanted == plan.size() ? plan.num_seeds(group) : num_wanted / plan.num_groups();
    // Tasks with a twin are not computed.
    if (!plan.has_twin(group))
      set.num_waiting = std::max<std::int64_t>(0, wanted - set.num_finished - set.num_running);
  }
  return sets;
}

}  // namespace

Status status_of(const std::string& path, const store::SweepFile& file, double confidence) {
  Status status;
  const sweep::Plan plan = stored_plan(path, file);
  status.runs = stored_num_runs(path, file, plan);
  status.stopping_rule = attribute(file.provenance, "stopping_rule");
  status.is_alive = store::Journal::is_open(store::journal_path(path));
  for (const RunRow& row : file.rows) {
    ++status.by_status[row.status];
    ++status.by_outcome[outcome_of(row)];
    status.core_hours += sweep::cost_seconds(row) / 3600;
  }
  const std::int64_t num_wanted = status.runs.num_runs - status.runs.num_beyond;
  status.left = time_left(times_of_sets(file.rows, plan, num_wanted),
                          std::max<std::size_t>(1, static_cast<std::size_t>(status.num_unfinished())));
  if (!file.rows.empty()) status.groups = group_runs(file.rows, confidence);
  return status;
}

std::string to_text(const std::string& path, const Status& status, double confidence,
                    SharedParameters shared) {
  std::string text = fmt::format(
      "{}: {} of {} finished{}, {}, {} flowing, {} failed", console::printable(path), status.num_finished(),
      count_text(status.runs.num_runs, "run"), status.runs.text_of_beyond(), text_of_clogs(status.by_outcome),
      status.count(RunStatus::flowing), status.count(RunStatus::failed));
  for (const RunStatus rare : {RunStatus::passed, RunStatus::broken})
    if (const std::int64_t number = status.count(rare); number > 0)
      text += fmt::format(", {} {}", number, name(rare));
  if (const std::int64_t unfinished = status.num_unfinished(); unfinished > 0)
    text += fmt::format("; {} {}", unfinished, status.is_alive ? "running" : "interrupted");
  text += fmt::format("; {:.3g} core-hours", status.core_hours);
  if (status.num_finished() == status.runs.num_runs)
    text += "; complete";
  else if (!status.is_alive)
    text += "; no sweep is writing to it: the command that started it resumes it";
  else
    text += ", " + status.left.text();
  text += '\n';
  if (!status.stopping_rule.empty()) text += console::printable(status.stopping_rule) + '\n';
  if (!status.groups.empty()) text += '\n' + to_text(status.groups, confidence, shared);
  return text;
}

std::string to_json(const Status& status) {
  nlohmann::ordered_json all;
  all["runs"] = status.runs.num_runs;
  all["runs_beyond_lists"] = status.runs.num_beyond;
  all["finished"] = status.num_finished();
  for (const RunStatus one :
       {RunStatus::clogged, RunStatus::broken, RunStatus::passed, RunStatus::flowing, RunStatus::failed})
    all[name(one)] = count_in(status.by_outcome, name(one));
  all["at_rest"] = count_in(status.by_outcome, outcome_at_rest);
  all["unfinished"] = status.num_unfinished();
  all["alive"] = status.is_alive;
  all["core_hours"] = status.core_hours;
  all["seconds_left"] = status.left.is_known
                            ? nlohmann::ordered_json{status.left.shortest, status.left.longest}
                            : nlohmann::ordered_json();
  if (!status.stopping_rule.empty()) all["stopping_rule"] = status.stopping_rule;
  all["groups"] = groups_json(status.groups);
  return console::json_text(all);
}

}  // namespace clog::results
