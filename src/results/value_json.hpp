#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "clog/fit/survival.hpp"
#include "clog/sweep/columns.hpp"

namespace clog::results {

/// @returns null for an unset value and for a number that is not finite
nlohmann::ordered_json json_of(const sweep::Value& value);
nlohmann::ordered_json json_of(const fit::SurvivalStep& step);
/// For a table: four figures; `-` for an unset value. A foreign file's words may hold control characters.
std::string short_text(const sweep::Value& value);
/// For CSV: all digits; in quotes where a word holds a comma or a quote.
std::string csv_cell(const sweep::Value& value);

}  // namespace clog::results
