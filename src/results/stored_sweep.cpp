#include "clog/results/stored_sweep.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <span>

#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/instruction_set.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/value_list.hpp"
#include "latest_rows.hpp"

namespace clog::results {
namespace {

/// Applies `read` to an attribute's text; an error names the file and the attribute.
template <class Read>
auto read_attribute(const std::string& path, const store::Provenance& provenance, const std::string& name,
                    const Read& read) {
  try {
    return read(attribute(provenance, name));
  } catch (const Error& error) {
    throw Error(fmt::format(
        "cannot read {} (its attribute {}: {}); the file is damaged, or of another version of the program",
        path, name, error.what()));
  }
}

sweep::Settings settings_from(const std::string& config) {
  if (config.empty()) throw Error("it is missing; the sweep's own command restores it");
  return sweep::Settings::from_config(config);
}

const sweep::RunRow& row_of_task(const store::SweepFile& file, const std::string& word) {
  const double task = sweep::to_number(word);
  for (const sweep::RunRow& row : file.rows)
    if (static_cast<double>(row.task) == task) return row;
  throw Error("the file has no task " + word + "; its column `task` names those it has");
}

}  // namespace

sweep::RunRow replayable_row(const store::SweepFile& file, const std::string& task) {
  sweep::RunRow row = row_of_task(file, task);
  const auto refuse = [&](const std::string& why, const std::string& remedy) {
    throw Error(fmt::format("cannot replay task {} ({}); {}", task, why, remedy));
  };
  if (sweep::is_unfinished(row.status)) refuse("it has not ended", "resume the sweep first");
  if (row.instruction_set == sweep::mixed_instruction_sets)
    refuse("it was interrupted and resumed with another instruction set, at an unknown step",
           "--instruction-set pins one for all sessions of a sweep");
  if (row.model_version != model_version)
    refuse(fmt::format("it is of model version {}, this program's is {}", row.model_version, model_version),
           "use the version that wrote the file");
  if (const std::string fault = sweep::fault_of(row); !fault.empty()) refuse(fault, "the row is damaged");
  for (const store::CircleFile& one : file.circles)
    if (row.parameters.obstacles.own == one.circles) row.parameters.obstacles.own = one.circles;
  return row;
}

void use_instruction_set_of(const sweep::RunRow& row) {
  if (row.parameters.model == Model::dp) use_instruction_set(row.instruction_set);
}

void say_unread(const std::string& path, const std::string& consequence, const Error& why) {
  console::say(fmt::format("{}: {}: {}", path, consequence, why.what()));
}

/// Counts runs of a stopped sweep that have ended according to the journal, but not according to the table.
static std::int64_t num_ended_in_journal(const std::string& path, std::span<sweep::RunRow> rows) {
  std::optional<store::Journal::Contents> contents;
  try {
    const std::string journal = store::journal_path(path);
    if (store::Journal::is_open(journal)) return 0;
    contents = store::Journal::look(journal);
  } catch (const Error& error) {  // the journal is of another version, or the file is no journal
    say_unread(path, "runs that only its journal has are missing here", error);
  }
  if (!contents) return 0;
  std::erase_if(contents->entries, [](const auto& record) { return !sweep::is_final(record.row); });
  return std::ranges::count_if(latest_rows(rows, contents->entries),
                               [](const LatestRow& run) { return run.record && !run.was_final(); });
}

store::SweepFile read_with_caution(const std::string& path) {
  store::SweepFile file = store::read_sweep(path);
  if (const std::string words = store::caution(path, file); !words.empty()) console::say(words);
  if (const std::int64_t number = num_ended_in_journal(path, file.rows); number > 0)
    console::say(
        fmt::format("{}: {} ended that only the journal of the stopped sweep has; the sweep's own "
                    "command adds {}",
                    path, count_text(number, "run"), number == 1 ? "it" : "them"));
  for (const store::CircleFile& one : file.circles) {
    const OwnCircles named(one.circles.circles(), one.name);
    for (sweep::RunRow& row : file.rows)
      if (row.parameters.obstacles.own == named) row.parameters.obstacles.own = named;
  }
  return file;
}

std::string attribute(const store::Provenance& provenance, const std::string& name) {
  const auto found = std::find_if(provenance.begin(), provenance.end(),
                                  [&](const auto& attribute) { return attribute.first == name; });
  return found == provenance.end() ? "" : found->second;
}

void set_attribute(store::Provenance& provenance, const std::string& name, const std::string& text) {
  std::erase_if(provenance, [&](const auto& attribute) { return attribute.first == name; });
  if (!text.empty()) provenance.emplace_back(name, text);
}

sweep::Settings stored_settings(const std::string& path, const store::Provenance& provenance) {
  return read_attribute(path, provenance, "config", settings_from);
}

sweep::Plan stored_plan(const std::string& path, const store::SweepFile& file) {
  return read_attribute(path, file.provenance, "config", [&](const std::string& config) {
    sweep::Settings settings = settings_from(config);
    for (const store::CircleFile& one : file.circles)
      if (!one.name.empty()) settings.attach(one.name, one.circles);
    return sweep::Plan(settings);
  });
}

/// Whether the user gave the key a list, or a list in points. Other keys may also have several values, but
/// these follow from a word in a list.
static bool is_listed(const sweep::Key& key, const sweep::Settings& settings) {
  const std::vector<std::string>& keys = settings.points().keys;
  return settings.values(key.name).size() > 1 || std::ranges::find(keys, key.name) != keys.end();
}

std::vector<std::string> listed_columns(const store::Provenance& provenance) {
  const std::string config = attribute(provenance, "config");
  if (config.empty()) return {};
  std::optional<sweep::Settings> settings;
  try {
    settings = settings_from(config);
  } catch (const Error& error) {  // the config is from a version with other keys
    console::say(fmt::format("the lists of the stored settings are unknown here: {}", error.what()));
    return {};
  }
  std::vector<std::string> columns;
  const auto values = settings->all_values();
  for (const sweep::Key& key : sweep::keys())
    if (key.parameter && values.at(key.name).size() > 1 && is_listed(key, *settings))
      columns.emplace_back(key.parameter->column);
  return columns;
}

std::int64_t stored_num_wanted(const std::string& path, const store::Provenance& provenance,
                               const sweep::Plan& plan) {
  return read_attribute(path, provenance, "num_wanted", [&](const std::string& number) {
    return number.empty() ? plan.size() : sweep::to_integer(number);
  });
}

RunCount stored_num_runs(const std::string& path, const store::SweepFile& file, const sweep::Plan& plan) {
  RunCount count;
  count.num_beyond = std::count_if(file.rows.begin(), file.rows.end(),
                                   [&](const sweep::RunRow& row) { return row.task >= plan.size(); });
  // The stored number belongs to the last command. An earlier command with --until-precision may have
  // requested more runs; the file has rows of these.
  count.num_runs = std::max(stored_num_wanted(path, file.provenance, plan) + count.num_beyond,
                            static_cast<std::int64_t>(file.rows.size()));
  return count;
}

std::string RunCount::text_of_beyond() const {
  return num_beyond == 0 ? "" : fmt::format(" ({} outside the lists of its last command)", num_beyond);
}

}  // namespace clog::results
