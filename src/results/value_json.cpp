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
#include "clog/core/tools/joined.hpp"

namespace clog::results {

nlohmann::ordered_json json_of(const sweep::Value& value) {
  if (const auto* count = std::get_if<std::int64_t>(&value)) return *count;
  if (const auto* number = std::get_if<double>(&value); number && std::isfinite(*number)) return *number;
  if (const auto* word = std::get_if<std::string>(&value); word && !word->empty()) return *word;
  return nullptr;
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
    for (const auto& [name, value] : row)
      if (places.try_emplace(name, names.size()).second) names.push_back(name);
  std::string table = rows.empty() ? "" : joined(names, ",") + '\n';
  for (const std::vector<Field>& row : rows) {
    std::vector<std::string> cells(names.size());
    for (const auto& [name, value] : row) cells[places.at(name)] = csv_cell(value);
    table += joined(cells, ",") + '\n';
  }
  return table;
}

}  // namespace clog::results
