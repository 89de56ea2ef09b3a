#include "clog/console/table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>

namespace clog::console {

std::string aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i)
      text += fmt::format("{:>{}}", line[i], widths[i] + (i > 0 ? 2 : 0));
    text += '\n';
  }
  return text;
}

}  // namespace clog::console
