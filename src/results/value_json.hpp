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
/// Text for a printed table: four figures; `-` for an unset value. Escapes control characters, which the
/// words of a foreign file may contain.
std::string short_text(const sweep::Value& value);
/// Text for CSV: all digits; quoted if a word contains a comma or a quote.
std::string csv_cell(const sweep::Value& value);
/// CSV with the names of the fields, then a line for each row.
std::string csv_table(const std::vector<std::vector<Field>>& rows);

}  // namespace clog::results
