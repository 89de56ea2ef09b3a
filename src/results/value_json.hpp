#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "clog/results/groups.hpp"

namespace clog::results {

/// Unset if the number is not finite.
inline Value finite_value(double number) { return std::isfinite(number) ? Value(number) : Value(); }
/// @returns null for an unset value and for a number that is not finite
nlohmann::ordered_json json_of(const sweep::Value& value);
/// The groups with all their fields and curves.
nlohmann::ordered_json groups_json(const std::vector<Group>& groups);
/// The values by their names.
nlohmann::ordered_json json_of(const std::vector<Field>& row);
/// A step of a survival or incidence curve as JSON. @param name  key of the number of ends
template <class Step>
nlohmann::ordered_json step_json(const Step& step, const char* name, int num_ends) {
  return {{"distance", step.distance},
          {"at_risk", step.num_at_risk},
          {name, num_ends},
          {"probability", step.probability},
          {"standard_error", step.standard_error},
          {"lower", step.interval.lower},
          {"upper", step.interval.upper}};
}
inline constexpr int few_digits = 4;
inline constexpr int all_digits = 17;  ///< with so many digits, different numbers have different texts
/// The smallest number of digits, at least four, with which different values have different texts.
int distinct_digits(const std::vector<sweep::Value>& values);
/// Text for a printed table, with `digits` significant digits; `-` for an unset value. Escapes control
/// characters, which the words of a foreign file may contain.
/// @param digits  from all_digits on, the text has as many digits as identify the number
std::string short_text(const sweep::Value& value, int digits = few_digits);
/// The distinct_digits() of a value of all groups. @param value_of  the group's value
template <class ValueOf>
int digits_in(const std::vector<Group>& groups, const ValueOf& value_of) {
  std::vector<Value> values;
  values.reserve(groups.size());
  for (const Group& group : groups) values.push_back(value_of(group));
  return distinct_digits(values);
}
/// Text for CSV: all digits; quoted if a word contains a comma or a quote.
std::string csv_cell(const sweep::Value& value);
/// CSV with the names of the fields of all rows, then a line for each row. Fields that a row lacks are empty.
std::string csv_table(const std::vector<std::vector<Field>>& rows);
/// The fields with a head as an aligned table. Different values of a field have different texts.
/// @param rows  not empty; all rows have the same fields
std::string text_table(const std::vector<std::vector<Field>>& rows);

}  // namespace clog::results
