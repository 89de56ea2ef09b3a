#pragma once

#include <nlohmann/json_fwd.hpp>

#include "clog/sweep/columns.hpp"

namespace clog::sweep {

/// A column's name, meaning, unit and purpose.
nlohmann::ordered_json to_json(const Column& column);

/// All keys and columns: `keys`, `columns`.
nlohmann::ordered_json schema_json();

}  // namespace clog::sweep
