#pragma once

#include <string>
#include <vector>

namespace clog::console {

/// Lines of cells as a table, columns aligned to the right.
std::string aligned(const std::vector<std::vector<std::string>>& lines);

}  // namespace clog::console
