#pragma once

#include <nlohmann/json.hpp>

#include "clog/sweep/columns.hpp"

namespace clog::campaign {

/// @returns null for an unset value and for a number that is not finite
nlohmann::ordered_json json_of(const sweep::Value& value);

}  // namespace clog::campaign
