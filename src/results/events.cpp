#include "clog/results/events.hpp"

#include <algorithm>
#include <utility>

#include "clog/console/clock.hpp"
#include "clog/console/json_text.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/plan.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

using Json = nlohmann::ordered_json;
using sweep::RunRow;

Json event(const char* name) { return {{"event", name}, {"seen", console::utc_now()}}; }

std::string line(const Json& event) { return console::json_text(event, -1); }

}  // namespace

/// Counts the runs. Returns whether there are more runs to do than at the last call.
bool Events::count_runs(const store::SweepFile& file) {
  std::string config = attribute(file.provenance, "config");
  std::string num_wanted = attribute(file.provenance, "num_wanted");
  if (has_looked_ && config == config_ && num_wanted == num_wanted_) return false;
  config_ = std::move(config);
  num_wanted_ = std::move(num_wanted);
  const std::int64_t before = num_runs_;
  num_runs_ = stored_num_runs(path_, file, stored_plan(path_, file)).num_runs;
  columns_ = listed_columns(file.provenance);
  if (std::ranges::find(columns_, "seed") == columns_.end()) columns_.emplace_back("seed");
  return num_runs_ > before;
}

std::vector<std::string> Events::of_row(const RunRow& row) const {
  const auto before = known_.find(row.task);
  const bool is_new = before == known_.end();
  const bool was_over = !is_new && !sweep::is_unfinished(before->second.status);
  if (was_over && before->second.attempt == row.attempt) return {};
  const bool is_tried_again = (is_new ? 1 : before->second.attempt) < row.attempt;
  const bool was_running = !is_new && before->second.status == RunStatus::running;
  const bool is_over = !sweep::is_unfinished(row.status);
  std::vector<std::string> lines;
  const auto add = [&](const char* name, const std::vector<std::string>& more) {
    Json one = event(name);
    one["task"] = row.task;
    one["attempt"] = row.attempt;
    for (const auto* names : {&columns_, &more})
      for (const std::string& column : *names) one[column] = json_of(sweep::column(column).get(row));
    lines.push_back(line(one));
  };
  if (is_tried_again) add("retry", {});
  const bool has_started = row.status == RunStatus::running || is_over;
  if (has_started && (!was_running || is_tried_again)) add("start", {"rank", "host"});
  if (is_over)
    add("end", {"status", "distance", "time", "mechanism", "wall_seconds", "rank", "host", "message"});
  else if (was_running && row.status == RunStatus::interrupted && !is_tried_again)
    add("interrupt", {"distance", "time", "rank", "host"});
  return lines;
}

std::vector<std::string> Events::look(const store::SweepFile& file) {
  const bool is_round = count_runs(file);
  std::vector<std::string> lines;
  num_finished_ = 0;
  for (const RunRow& row : file.rows) {
    num_finished_ += !sweep::is_unfinished(row.status);
    if (has_looked_)
      for (std::string& one : of_row(row)) lines.push_back(std::move(one));
    known_[row.task] = {row.status, row.attempt};
  }
  if (!has_looked_ || is_round) {
    Json one = event(has_looked_ ? "round" : "begin");
    one["runs"] = num_runs_;
    one["finished"] = num_finished_;
    lines.push_back(line(one));
  }
  has_looked_ = true;
  return lines;
}

std::string Events::end() const {
  Json one = event("done");
  one["runs"] = num_runs_;
  one["finished"] = num_finished_;
  one["complete"] = num_finished_ >= num_runs_;
  return line(one);
}

}  // namespace clog::results
