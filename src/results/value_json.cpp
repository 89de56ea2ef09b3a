#include "value_json.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <variant>

#include "clog/console/printable.hpp"
#include "clog/console/table.hpp"
#include "clog/core/tools/joined.hpp"

namespace clog::results {

nlohmann::ordered_json json_of(const sweep::Value& value) {
  if (const auto* count = std::get_if<std::int64_t>(&value)) return *count;
  if (const auto* number = std::get_if<double>(&value); number && std::isfinite(*number)) return *number;
  if (const auto* word = std::get_if<std::string>(&value); word && !word->empty()) return *word;
  return nullptr;
}

nlohmann::ordered_json json_of(const std::vector<Field>& row) {
  nlohmann::ordered_json entry;
  for (const Field& field : row) entry[field.name] = json_of(field.value);
  return entry;
}

int distinct_digits(const std::vector<sweep::Value>& values) {
  std::set<double> numbers;
  for (const sweep::Value& value : values)
    if (const auto* number = std::get_if<double>(&value); number && std::isfinite(*number))
      numbers.insert(*number);
  int digits = few_digits;
  for (; digits < all_digits; ++digits) {
    std::set<std::string> texts;
    for (const double number : numbers) texts.insert(fmt::format("{:.{}g}", number, digits));
    if (texts.size() == numbers.size()) break;
  }
  return digits;
}

std::string short_text(const sweep::Value& value, int digits) {
  if (const auto* number = std::get_if<double>(&value); number && digits < all_digits)
    return fmt::format("{:.{}g}", *number, digits);
  const std::string text = console::printable(sweep::text_of(value));
  return text.empty() ? "-" : text;
}

std::string csv_cell(const sweep::Value& value) {
  std::string text = console::printable(sweep::text_of(value));
  if (text.find_first_of(",\"") == std::string::npos) return text;
  for (std::size_t i = text.find('"'); i != std::string::npos; i = text.find('"', i + 2))
    text.insert(i, 1, '"');
  return '"' + text + '"';
}

std::string csv_table(const std::vector<std::vector<Field>>& rows) {
  std::vector<std::string> names;
  std::map<std::string, std::size_t> places;
  for (const std::vector<Field>& row : rows)
    for (const Field& field : row)
      if (places.try_emplace(field.name, names.size()).second) names.push_back(field.name);
  std::string table = rows.empty() ? "" : joined(names, ",") + '\n';
  for (const std::vector<Field>& row : rows) {
    std::vector<std::string> cells(names.size());
    for (const Field& field : row) cells[places.at(field.name)] = csv_cell(field.value);
    table += joined(cells, ",") + '\n';
  }
  return table;
}

std::string text_table(const std::vector<std::vector<Field>>& rows) {
  std::vector<std::vector<std::string>> lines(rows.size() + 1);
  for (std::size_t place = 0; place < rows.front().size(); ++place) {
    if (rows.front()[place].head.empty()) continue;
    lines.front().push_back(rows.front()[place].head);
    std::vector<Value> values;
    values.reserve(rows.size());
    for (const std::vector<Field>& row : rows) values.push_back(row[place].value);
    const int digits = distinct_digits(values);
    for (std::size_t i = 0; i < rows.size(); ++i)
      lines[i + 1].push_back(rows[i][place].text.value_or(short_text(values[i], digits)));
  }
  return console::aligned(lines);
}

}  // namespace clog::results
