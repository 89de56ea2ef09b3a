#include "value_json.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <variant>

namespace clog::campaign {

nlohmann::ordered_json json_of(const sweep::Value& value) {
  if (const auto* count = std::get_if<std::int64_t>(&value)) return *count;
  if (const auto* number = std::get_if<double>(&value); number && std::isfinite(*number)) return *number;
  if (const auto* word = std::get_if<std::string>(&value); word && !word->empty()) return *word;
  return nullptr;
}

}  // namespace clog::campaign
