#include "sweep_reports.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/cli/printable.hpp"
#include "clog/cli/program.hpp"
#include "clog/core/error.hpp"
#include "clog/core/instruction_set.hpp"
#include "clog/store/journal.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/run_job.hpp"
#include "clog/sweep/value_list.hpp"
#include "group_table.hpp"
#include "stored_sweep.hpp"
#include "sweep_input.hpp"
#include "time_left.hpp"

namespace clog {
namespace {

namespace po = boost::program_options;
using sweep::RunRow;

constexpr const char* clear_screen = "\x1b[H\x1b[2J";

cli::CommandLine command(const char* name, const char* usage) {
  cli::CommandLine line(std::string("clogsweep ") + name, usage, cli::CommandLine::SweepKeys::none);
  line.add_options()("file", po::value<std::string>(), "sweep file");
  line.add_positional("file", 1);
  return line;
}

/// Parses what follows the command's name. Returns whether there is something to do.
bool parse(cli::CommandLine& line, int argc, const char* const* argv) {
  line.parse(argc - 1, argv + 1);
  if (cli::answer_help_or_version(line, {{"HDF5", store::library_version()}})) return false;
  if (!line.has("file")) throw Error("missing sweep file; try " + line.program() + " sweep.h5");
  return true;
}

struct Status {
  RunCount runs;
  std::map<RunStatus, std::int64_t> by_status;
  bool is_alive = false;
  double core_hours = 0;
  TimeLeft left;
  std::string stopping_rule;  ///< empty: none
  std::vector<Group> groups;

  std::int64_t count(RunStatus status) const {
    const auto found = by_status.find(status);
    return found == by_status.end() ? 0 : found->second;
  }
  std::int64_t num_under_way() const { return count(RunStatus::running) + count(RunStatus::interrupted); }
  std::int64_t num_over() const {
    std::int64_t sum = -num_under_way();
    for (const auto& [status, number] : by_status) sum += number;
    return sum;
  }
};

/// Of the parameter sets of the last config. With --until-precision a set may want more seeds than others,
/// which is not known here: each is taken to want the mean of all.
std::vector<SetTimes> times_of_sets(const std::vector<RunRow>& rows, const sweep::Plan& plan,
                                    std::int64_t num_wanted) {
  const std::int64_t num_sets = plan.num_groups();
  std::vector<SetTimes> sets(num_sets);
  for (const RunRow& row : rows) {
    if (row.task < 0 || row.task >= plan.size()) continue;
    SetTimes& set = sets[row.task % num_sets];
    ++(sweep::is_unfinished(row.status) ? set.num_running : set.num_finished);
    set.seconds += row.wall_seconds;
  }
  for (SetTimes& set : sets)
    set.num_waiting = std::max<std::int64_t>(0, num_wanted / num_sets - set.num_finished - set.num_running);
  return sets;
}

Status status_of(const std::string& path, const store::SweepFile& file, double confidence) {
  Status status;
  const sweep::Plan plan = stored_plan(path, file.provenance);
  status.runs = stored_num_runs(path, file, plan);
  status.stopping_rule = attribute(file.provenance, "stopping_rule");
  status.is_alive = store::Journal::is_open(store::journal_path(path));
  for (const RunRow& row : file.rows) {
    ++status.by_status[row.status];
    status.core_hours += row.wall_seconds / 3600;
  }
  const std::int64_t num_wanted = status.runs.num_runs - status.runs.num_beyond;
  status.left = time_left(times_of_sets(file.rows, plan, num_wanted),
                          std::max<std::size_t>(1, static_cast<std::size_t>(status.num_under_way())));
  if (!file.rows.empty()) status.groups = group_runs(file.rows, confidence);
  return status;
}

std::string to_text(const std::string& path, const Status& status, double confidence,
                    SharedParameters shared) {
  const auto number = [](std::int64_t value) { return std::to_string(value); };
  std::string text = cli::printable(path) + ": " + number(status.num_over()) + " of " +
                     sweep::counted(status.runs.num_runs, "run") + " over" + status.runs.text_of_beyond() +
                     ", " + number(status.count(RunStatus::clogged)) + " clogged, " +
                     number(status.count(RunStatus::flowing)) + " flowing, " +
                     number(status.count(RunStatus::failed)) + " failed";
  if (const std::int64_t under_way = status.num_under_way(); under_way > 0)
    text += "; " + number(under_way) + (status.is_alive ? " running" : " interrupted");
  char hours[64];
  std::snprintf(hours, sizeof hours, "; %.3g core-hours", status.core_hours);
  text += hours;
  if (status.num_over() == status.runs.num_runs)
    text += "; complete";
  else if (!status.is_alive)
    text += "; no sweep is writing to it: the command that began it goes on";
  else
    text += ", " + status.left.text();
  text += '\n';
  if (!status.stopping_rule.empty()) text += status.stopping_rule + '\n';
  if (!status.groups.empty()) text += '\n' + to_text(status.groups, confidence, shared);
  return text;
}

std::string to_json(const Status& status, double confidence) {
  nlohmann::ordered_json all;
  all["runs"] = status.runs.num_runs;
  all["runs_beyond_lists"] = status.runs.num_beyond;
  all["over"] = status.num_over();
  for (const RunStatus one : {RunStatus::clogged, RunStatus::flowing, RunStatus::failed})
    all[name(one)] = status.count(one);
  all["under_way"] = status.num_under_way();
  all["alive"] = status.is_alive;
  all["core_hours"] = status.core_hours;
  all["seconds_left"] = status.left.is_known
                            ? nlohmann::ordered_json{status.left.shortest, status.left.longest}
                            : nlohmann::ordered_json();
  if (!status.stopping_rule.empty()) all["stopping_rule"] = status.stopping_rule;
  all["groups"] = status.groups.empty()
                      ? nlohmann::ordered_json::array()
                      : nlohmann::ordered_json::parse(to_json(status.groups, confidence, {})).at("groups");
  return all.dump(2) + '\n';
}

std::string to_text(const store::Journal::Contents& journal, bool is_alive) {
  const auto num_snapshots = std::count_if(journal.entries.begin(), journal.entries.end(),
                                           [](const auto& entry) { return !entry.snapshot.empty(); });
  std::string text = sweep::counted(static_cast<std::int64_t>(journal.entries.size()), "record") + ", " +
                     std::to_string(num_snapshots) + " of them with snapshots, ";
  text +=
      journal.num_unreadable == 0 ? "all whole" : std::to_string(journal.num_unreadable) + " more damaged";
  if (is_alive) return text + "; a sweep is writing to it";
  if (journal.has_torn_end) text += "; the last one is torn, as after a kill, and will be dropped";
  return text;
}

std::vector<std::string> differing_results(const RunRow& a, const RunRow& b) {
  const auto packed = [](const sweep::Column& column, const RunRow& row) {
    std::vector<std::byte> bytes(column.size);
    column.pack(row, bytes.data());
    return bytes;
  };
  std::vector<std::string> all;
  for (const sweep::Column& column : sweep::columns())
    if (column.role == sweep::ColumnRole::result && packed(column, a) != packed(column, b))
      all.push_back(column.name);
  return all;
}

}  // namespace

int clogsweep_status(int argc, const char* const* argv) {
  cli::CommandLine line =
      command("status", R"(clogsweep status says how far a sweep is, while it runs or afterwards.

  clogsweep status sweep.h5
  clogsweep status sweep.h5 --watch

Clogging lengths count runs under way as not clogged so far, at the distance they have reached: finished runs alone
would give too short ones, since runs that clog early finish first.
)");
  line.add_options()("watch", "again every two seconds, until the sweep ends")(
      "format", po::value<std::string>()->default_value("text"), "text or json")(
      "confidence", po::value<std::string>()->default_value("0.95"), "of the intervals")(
      "all-parameters", "name in the text also what all runs have as by default");
  if (!parse(line, argc, argv)) return cli::exit_success;
  const std::string format = line.get("format");
  if (format != "text" && format != "json")
    throw Error("invalid --format=" + format + " (is not one of text, json)");
  const double confidence = line.get_positive("confidence");
  if (confidence >= 1)
    throw Error("invalid --confidence=" + line.get("confidence") + " (must lie between 0 and 1)");
  const SharedParameters shared =
      line.has("all-parameters") ? SharedParameters::all : SharedParameters::unusual;
  cli::catch_stop_signals();
  const std::string path = line.get("file");
  for (bool is_first = true;; is_first = false) {
    const Status status =
        status_of(path, is_first ? read_with_caution(path) : store::read_sweep(path), confidence);
    if (line.has("watch") && format == "text" && isatty(STDOUT_FILENO)) std::cout << clear_screen;
    std::cout << (format == "json" ? to_json(status, confidence) : to_text(path, status, confidence, shared))
              << std::flush;
    if (!line.has("watch") || !status.is_alive) return cli::exit_success;
    for (int i = 0; i < 20; ++i) {
      if (cli::stop_signalled()) return cli::exit_success;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
}

int clogsweep_verify(int argc, const char* const* argv) {
  cli::CommandLine line =
      command("verify", R"(clogsweep verify reads every row of a sweep's file and says whether it is whole.

  clogsweep verify sweep.h5

The same for the journal beside it, which is there while the sweep is not complete.

Exit code 0: every bit is as it was written, every row makes sense, none is there twice, no record of the journal is
damaged. 1: this is not so; `clogsweep salvage` keeps what is whole. 2: the file or its journal cannot be read.
)");
  if (!parse(line, argc, argv)) return cli::exit_success;
  const store::Examination found = store::examine_sweep(line.get("file"));
  const store::SweepFile& file = found.whole;
  RunCount runs;  // not asked for where the file is damaged
  if (found.damage.empty())
    runs = stored_num_runs(line.get("file"), file, stored_plan(line.get("file"), file.provenance));
  for (const std::string& damage : found.damage) std::cout << cli::printable(damage) << '\n';
  auto num_faults = static_cast<std::int64_t>(found.damage.size());
  std::unordered_map<std::string, std::int64_t> seen;
  for (const RunRow& row : file.rows) {
    std::string fault = sweep::fault_of(row);
    const auto [first, is_new] = seen.emplace(sweep::identity(row), row.task);
    if (fault.empty() && !is_new) fault = "the same run as task " + std::to_string(first->second);
    if (fault.empty()) continue;
    ++num_faults;
    std::cout << "task " << row.task << ": " << cli::printable(fault) << '\n';
  }
  const auto num_rows = static_cast<std::int64_t>(file.rows.size());
  std::cout << cli::printable(line.get("file")) << ": ";
  if (num_faults == 0)
    std::cout << sweep::counted(num_rows, "row") << " of " << sweep::counted(runs.num_runs, "run")
              << runs.text_of_beyond() << ", all whole\n";
  else
    std::cout << sweep::counted(num_rows, "whole row") << ", " << sweep::counted(num_faults, "fault") << '\n';
  if (const std::string words = store::caution(line.get("file"), file); !words.empty())
    std::cout << cli::printable(words) << '\n';
  const std::string journal = store::journal_path(line.get("file"));
  if (const auto contents = store::Journal::look(journal)) {
    std::cout << cli::printable(journal) << ": " << to_text(*contents, store::Journal::is_open(journal))
              << '\n';
    num_faults += contents->num_unreadable;
  }
  return num_faults == 0 ? cli::exit_success : cli::exit_internal_fault;
}

int clogsweep_replay(int argc, const char* const* argv) {
  cli::CommandLine line = command(
      "replay", R"(clogsweep replay does one run of a sweep once more and compares the results bit for bit.

  clogsweep replay sweep.h5 12

Exit code 0: the same bits. 1: other results. 2: it cannot be done again. The run uses the row's instruction set; one
that went on under another set than it began with cannot be repeated.
)");
  line.add_options()("task", po::value<std::string>(), "the row's number, column `task`");
  line.add_positional("task", 1);
  if (!parse(line, argc, argv)) return cli::exit_success;
  if (!line.has("task")) throw Error("missing task; try clogsweep replay " + line.get("file") + " 0");
  const store::SweepFile file = read_with_caution(line.get("file"));
  const RunRow& row = replayable_row(file, line.get("task"));
  sweep::RunJob job(row.parameters, row.task);
  while (!job.advance()) {
  }
  const RunRow again = job.row();
  const std::vector<std::string> differing = differing_results(row, again);
  std::printf("task %s: %s, distance %.17g, %.3g s\n", line.get("task").c_str(), name(again.status),
              again.distance, again.wall_seconds);
  if (differing.empty()) {
    std::printf("the same bits as the row's\n");
    return cli::exit_success;
  }
  std::printf("differs from the row in:");
  for (const std::string& name : differing) std::printf(" %s", name.c_str());
  std::printf("\nthe row has %s, distance %.17g\n", name(row.status), row.distance);
  return cli::exit_internal_fault;
}

}  // namespace clog
