#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace clog::console {

/// The document with a line break at its end. U+FFFD replaces bytes that are not UTF-8, because the names of
/// files may contain any bytes.
/// @param indent  number of blanks for each level; -1 puts the document on one line
std::string json_text(const nlohmann::ordered_json& document, int indent = 2);

}  // namespace clog::console
