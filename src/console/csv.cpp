#include "clog/console/csv.hpp"

#include <fmt/core.h>

#include <sstream>

#include "clog/console/text_file.hpp"
#include "clog/core/tools/error.hpp"

namespace clog::console {

std::string trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(blanks) - first + 1));
}

void read_csv(const std::string& path,
              const std::function<void(int number, const std::vector<std::string>& cells)>& each,
              EmptyEnd end) {
  std::istringstream file(read_text(path));
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (trimmed(line).empty() || line.starts_with('#')) continue;
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(trimmed(cell));
    if (end == EmptyEnd::kept && trimmed(line).ends_with(',')) cells.emplace_back();
    try {
      each(number, cells);
    } catch (const Error& error) {
      throw Error(fmt::format("{} line {}: {}", path, number, error.what()));
    }
  }
}

}  // namespace clog::console
