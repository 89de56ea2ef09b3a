#include "clog/results/selection.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>
#include <variant>

#include "clog/console/csv.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/split.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/results/merger.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/sweep/value_list.hpp"
#include "latest_rows.hpp"

namespace clog::results {
namespace {

const sweep::Column& find_column(const std::string& name, const std::string& condition) {
  const auto columns = sweep::columns();
  const auto found = std::ranges::find(columns, name, &sweep::Column::name);
  if (found != columns.end()) return *found;
  std::vector<std::string> names;
  for (const sweep::Column& column : columns) names.push_back(column.name);
  std::string meant = name;
  std::ranges::replace(meant, '-', '_');
  if (std::ranges::find(names, meant) == names.end()) meant = did_you_mean(meant, names);
  throw Error(fmt::format("invalid condition '{}' (the table has no column '{}'){}", condition, name,
                          hint_at_column(name, meant)));
}

}  // namespace

std::string hint_at_column(const std::string& name, const std::string& meant) {
  if (name == "diameter" || name == "angle")
    return "; clogfit lists the lengths in mm of each droplet, and with --format csv its laboratory, which "
           "clogsweep select takes";
  return meant.empty() ? "; clogsweep --schema lists them" : fmt::format("; did you mean {}?", meant);
}

Condition::Condition(const std::string& text) : text_(text) {
  constexpr std::pair<const char*, Relation> relations[] = {
      {"!=", Relation::unequal}, {"<=", Relation::at_most}, {">=", Relation::at_least},
      {"==", Relation::equal},   {"=", Relation::equal},    {"<", Relation::less},
      {">", Relation::more}};
  const std::size_t place = std::min(text.find_first_of("!<>="), text.size());
  const auto* const relation = std::ranges::find_if(relations, [&](const auto& one) {
    return text.compare(place, std::string(one.first).size(), one.first) == 0;
  });
  if (place == 0 || place == text.size() || relation == std::end(relations))
    throw Error(
        fmt::format("invalid condition '{}'; give one like line_tension>=0.5 or status=clogged", text));
  column_ = &find_column(console::trimmed(text.substr(0, place)), text);
  relation_ = relation->second;
  const bool is_word = column_->kind == ValueKind::word;
  for (const std::string& value : split_at_commas(text.substr(place + std::string(relation->first).size())))
    try {
      if (is_word)
        words_.push_back(console::trimmed(value));
      else
        numbers_.push_back(sweep::to_number(console::trimmed(value)));
    } catch (const Error& error) {
      throw Error(fmt::format("invalid condition '{}' ({})", text, error.what()));
    }
  const bool is_order = relation_ != Relation::equal && relation_ != Relation::unequal;
  if (is_order && is_word)
    throw Error(fmt::format("invalid condition '{}' ({} is a word) use = or !=", text, column_->name));
  if (is_order && numbers_.size() > 1)
    throw Error(
        fmt::format("invalid condition '{}' (a number cannot be compared with a list) use = or !=", text));
}

template <class T>
bool Condition::compare(const T& value, const std::vector<T>& others) const {
  switch (relation_) {
    case Relation::equal:
      return std::ranges::find(others, value) != others.end();
    case Relation::unequal:
      return std::ranges::find(others, value) == others.end();
    case Relation::less:
      return value < others.front();
    case Relation::at_most:
      return value <= others.front();
    case Relation::more:
      return value > others.front();
    case Relation::at_least:
      return value >= others.front();
  }
  return false;
}

bool Condition::holds(const sweep::RunRow& row) const {
  const sweep::Value value = column_->get(row);
  if (const auto* word = std::get_if<std::string>(&value)) return compare(*word, words_);
  if (const auto* number = std::get_if<double>(&value)) return compare(*number, numbers_);
  if (const auto* integer = std::get_if<std::int64_t>(&value))
    return compare(static_cast<double>(*integer), numbers_);
  return false;
}

void Condition::require_known_words(std::span<const sweep::RunRow> rows) const {
  if (words_.empty()) return;
  std::set<std::string> known;
  for (const sweep::RunRow& row : rows)
    if (const sweep::Value value = column_->get(row); const auto* word = std::get_if<std::string>(&value))
      known.insert(*word);
  for (const std::string& word : words_)
    if (!known.contains(word))
      throw Error(fmt::format("invalid condition '{}' (no row has {}={}) the rows have {}", text_,
                              column_->name, word,
                              joined(std::vector<std::string>(known.begin(), known.end()))));
}

store::SweepFile select(const std::string& path, const std::vector<std::string>& conditions,
                        const store::Provenance& maker) {
  const std::vector<Condition> all(conditions.begin(), conditions.end());
  store::SweepFile file = read_with_caution(path);
  for (const Condition& one : all) one.require_known_words(file.rows);
  const sweep::Plan plan = stored_plan(path, file);
  std::erase_if(file.rows, [&](const sweep::RunRow& row) {
    return !std::ranges::all_of(all, [&](const Condition& one) { return one.holds(row); });
  });
  if (file.rows.empty())
    throw Error(fmt::format("no row of {} satisfies {}", path, joined(conditions, " and ")));
  std::ranges::for_each(file.rows, interrupt_if_running);
  RunList runs;
  runs.add_rows(path, plan, file.rows);
  const std::string part = part_line(path, file, joined(conditions, " and "));
  const std::string config = runs.empty() ? "" : number_tasks(runs, file);
  file.provenance = joint_provenance(maker, config, {&file}, part);
  return file;
}

}  // namespace clog::results
