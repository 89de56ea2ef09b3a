#include "clog/results/merger.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "clog/console/json_text.hpp"
#include "clog/console/printable.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/results/repetition.hpp"
#include "clog/results/salvage.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/results/usual_parameters.hpp"
#include "clog/sweep/row_check.hpp"

namespace clog::results {
namespace {

using sweep::RunRow;

/// One of the files.
struct Part {
  std::string path;
  store::SweepFile table;
  std::vector<store::Journal::Entry> snapshots;
};

Part whole_part(const std::string& path) {
  if (store::Journal::is_open(store::journal_path(path)))
    throw Error("cannot merge " + path + " (a sweep is writing to it); wait for it to end, or stop it");
  store::read_sweep(path);  // throws if the file is damaged
  Salvage found = salvage(path);
  if (!found.damage.empty())
    throw Error(fmt::format("cannot merge {} (damaged: {}); `clogsweep salvage` keeps what is whole", path,
                            found.damage.front()));
  return {path, std::move(found.table), std::move(found.snapshots)};
}

/// Joins the rows of all parts, so that each run occurs once.
class Rows {
 public:
  void add(const Part& part) {
    for (const RunRow& row : part.table.rows) add(row, part.path);
  }
  MergedSweep take() {
    MergedSweep merged;
    merged.table.rows = std::move(rows_);
    merged.num_shared = static_cast<std::int64_t>(shared_.size());
    merged.num_differing = static_cast<std::int64_t>(differing_.size());
    merged.num_faulty = num_faulty_;
    return merged;
  }

 private:
  std::vector<RunRow> rows_;
  std::vector<std::string> paths_;                       // the files of the rows
  std::unordered_map<std::string, std::size_t> places_;  // places of rows, by identity()
  std::set<std::size_t> shared_, differing_;
  std::int64_t num_faulty_ = 0;

  void add(const RunRow& row, const std::string& path) {
    if (!sweep::fault_of(row).empty()) {
      ++num_faulty_;
      return;
    }
    if (!rows_.empty() && row.model_version != rows_.front().model_version)
      throw Error(fmt::format(
          "cannot join {} and {} (their runs are of model versions {} and {}: the same parameters "
          "give other results)",
          paths_.front(), path, rows_.front().model_version, row.model_version));
    const auto [known, is_new] = places_.emplace(sweep::identity(row), rows_.size());
    if (is_new) {
      rows_.push_back(row);
      paths_.push_back(path);
      return;
    }
    const std::size_t place = known->second;
    shared_.insert(place);
    if (!is_better(row, place, path)) return;
    rows_[place] = row;
    paths_[place] = path;
  }

  /// The rank of a row. If two files have the same run, the row with the higher rank is kept.
  static int rank_of(const RunRow& row) {
    if (sweep::is_result(row.status)) return 3;
    if (sweep::is_final(row)) return 2;
    return sweep::is_unfinished(row.status) ? 1 : 0;
  }

  /// Whether a row replaces the existing row of the same run. @throws Error if the two rows contradict each
  /// other
  bool is_better(const RunRow& row, std::size_t place, const std::string& path) {
    const RunRow& known = rows_[place];
    if (!sweep::is_result(row.status) || !sweep::is_result(known.status))
      return std::pair(rank_of(row), row.steps) > std::pair(rank_of(known), known.steps);
    const std::vector<std::string> differing = differing_results(known, row);
    if (differing.empty()) return false;
    // A replay cannot reproduce a run that used two instruction sets.
    const bool is_mixed = row.instruction_set == sweep::mixed_instruction_sets;
    if (known.instruction_set == row.instruction_set && !is_mixed)
      throw Error(fmt::format(
          "cannot join {} and {} (task {} of the first and task {} of the second are the same run, but their "
          "results differ: {}); exclude the wrong file, `clogsweep replay` tells which",
          paths_[place], path, known.task, row.task, joined(differing)));
    differing_.insert(place);
    return false;
  }
};

/// Numerical keys, such as `vertices`, if parameter sets of two files differ only in these keys. Empty if two
/// files have a parameter set in common.
std::set<std::string> differing_numerics(const std::vector<Part>& parts) {
  const auto is_numerical = [](const sweep::Column& column) {
    return column.parameter && column.parameter->role == ParameterRole::numerics;
  };
  std::map<std::vector<Value>, const Part*> sets;
  std::map<std::vector<Value>, std::pair<const Part*, const RunRow*>>
      alike;  // sets that are equal apart from numerical keys
  std::set<std::string> names;
  for (const Part& part : parts)
    for (const RunRow& row : part.table.rows) {
      const auto [set, is_new] = sets.try_emplace(parameter_values(row), &part);
      if (set->second != &part) return {};
      if (!is_new) continue;
      std::vector<Value> others;
      for (const sweep::Column* column : group_columns())
        if (!is_numerical(*column)) others.push_back(separating_value(*column, row));
      const auto [known, first] = alike.try_emplace(std::move(others), &part, &row).first->second;
      if (known == &part) continue;
      for (const sweep::Column* column : group_columns())
        if (is_numerical(*column) && separating_value(*column, row) != separating_value(*column, *first))
          names.insert(column->name);
    }
  return names;
}

/// Adds the circles of a file that `all` does not contain yet.
void add_circles(const store::SweepFile& file, std::vector<store::CircleFile>& all) {
  for (const store::CircleFile& one : file.circles) {
    const auto known =
        std::ranges::find_if(all, [&](const auto& other) { return other.circles == one.circles; });
    if (known == all.end())
      all.push_back(one);
    else if (known->name.empty())
      known->name = one.name;
  }
}

/// Adds all runs of the plan (with --until-precision only those that have begun), and the runs outside the
/// plan.
void add_runs(const Part& part, RunList& runs) {
  const sweep::Plan plan = stored_plan(part.path, part.table);
  if (attribute(part.table.provenance, "stopping_rule").empty()) runs.add(plan);
  runs.add_rows(part.path, plan, part.table.rows);
}

std::vector<const store::SweepFile*> tables_of(const std::vector<Part>& parts) {
  std::vector<const store::SweepFile*> tables;
  tables.reserve(parts.size());
  for (const Part& part : parts) tables.push_back(&part.table);
  return tables;
}

std::string lines_of(const std::vector<Part>& parts) {
  std::string lines;
  for (const Part& part : parts) lines += part_line(part.path, part.table);
  return lines;
}

MergedSweep join(const std::vector<Part>& parts) {
  Rows rows;
  for (const Part& part : parts) rows.add(part);
  MergedSweep merged = rows.take();
  for (const Part& part : parts) add_circles(part.table, merged.table.circles);
  return merged;
}

}  // namespace

std::string number_tasks(const RunList& runs, store::SweepFile& table) {
  const sweep::Settings settings = runs.settings();
  for (store::CircleFile& one : table.circles) {
    const auto named = std::ranges::find_if(settings.circle_files(),
                                            [&](const auto& file) { return file.second == one.circles; });
    one.name = named == settings.circle_files().end() ? "" : named->first;
  }
  const sweep::Plan plan(settings);
  std::unordered_map<std::string, std::int64_t> tasks;
  for (std::int64_t task = 0; task < plan.size(); ++task)
    tasks.emplace(sweep::identity_in_any_version(sweep::describe(plan.task(task))), task);
  std::int64_t next = plan.size();
  for (RunRow& row : table.rows) {
    const auto found = tasks.find(sweep::identity_in_any_version(row));
    row.task = found == tasks.end() ? next++ : found->second;
  }
  std::ranges::sort(table.rows, {}, &RunRow::task);
  return settings.to_config();
}

std::string part_line(const std::string& path, const store::SweepFile& file, const std::string& condition) {
  nlohmann::ordered_json part;
  part["file"] = console::printable(path);
  if (!condition.empty()) part["selected"] = condition;
  part["rows"] = file.rows.size();
  for (const char* name : {"program", "version", "git_describe", "git_hash", "compiler", "mpi_version",
                           "start_time", "command_line", "stopping_rule"})
    if (const std::string text = attribute(file.provenance, name); !text.empty()) part[name] = text;
  std::set<std::string> hosts;
  for (const RunRow& row : file.rows) hosts.insert(row.host);
  part["hosts"] = hosts;
  return console::json_text(part, -1) + attribute(file.provenance, "parts");
}

/// Attributes that a new file does not take from `maker`. They summarise the attributes of the file's parts
/// instead.
static constexpr std::string_view replaced_attributes[] = {"config", "sessions", "parts", "stopping_rule",
                                                           "num_wanted"};

store::Provenance joint_provenance(const store::Provenance& maker, const std::string& config,
                                   const std::vector<const store::SweepFile*>& files,
                                   const std::string& parts) {
  store::Provenance all = maker;
  std::set<std::string> sessions;  // each session begins with its time, so the set is in order of time
  if (attribute(maker, "sessions").empty())
    sessions.insert(fmt::format("{} {} {} 1 {}", attribute(maker, "start_time"), attribute(maker, "version"),
                                attribute(maker, "git_describe"), attribute(maker, "command_line")));
  std::erase_if(all, [](const auto& attribute) {
    return std::ranges::find(replaced_attributes, attribute.first) != std::end(replaced_attributes);
  });
  if (!config.empty()) all.emplace_back("config", config);
  for (const store::SweepFile* file : files) {
    std::istringstream lines(attribute(file->provenance, "sessions"));
    for (std::string line; std::getline(lines, line);) sessions.insert(line);
  }
  std::string text;
  for (const std::string& line : sessions) text += line + '\n';
  all.emplace_back("sessions", text);
  all.emplace_back("parts", parts);
  return all;
}

MergedSweep merge(const std::vector<std::string>& paths, const store::Provenance& maker) {
  std::vector<Part> parts;
  parts.reserve(paths.size());
  for (const std::string& path : paths) parts.push_back(whole_part(path));
  MergedSweep merged = join(parts);
  merged.differing_numerics = differing_numerics(parts);
  RunList runs;
  for (const Part& part : parts) add_runs(part, runs);
  if (runs.empty()) throw Error("there is nothing to merge: the files have no runs");
  const std::string config = number_tasks(runs, merged.table);
  std::unordered_map<std::string, const RunRow*> unfinished;
  for (const RunRow& row : merged.table.rows)
    if (sweep::is_unfinished(row.status)) unfinished.emplace(sweep::identity(row), &row);
  for (Part& part : parts)
    for (store::Journal::Entry& entry : part.snapshots)
      if (const auto row = unfinished.find(sweep::identity(entry.row));
          row != unfinished.end() && row->second->steps == entry.row.steps) {
        entry.row = *row->second;
        merged.snapshots.push_back(std::move(entry));
        unfinished.erase(row);
      }
  merged.table.provenance = joint_provenance(maker, config, tables_of(parts), lines_of(parts));
  return merged;
}

store::SweepFile read_together(const std::vector<std::string>& paths) {
  if (paths.size() == 1) return read_with_caution(paths.front());
  std::vector<Part> parts;
  parts.reserve(paths.size());
  for (const std::string& path : paths) parts.push_back({path, read_with_caution(path), {}});
  MergedSweep merged = join(parts);
  std::string config;
  try {
    RunList runs;
    for (const Part& part : parts) add_runs(part, runs);
    if (!runs.empty()) config = number_tasks(runs, merged.table);
  } catch (const Error& error) {  // another version wrote the config, or two configs contradict each other
    say_unread(joined(paths), "read together without their settings", error);
  }
  merged.table.provenance =
      joint_provenance(parts.front().table.provenance, config, tables_of(parts), lines_of(parts));
  return std::move(merged.table);
}

}  // namespace clog::results
