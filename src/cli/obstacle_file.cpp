#include "clog/cli/obstacle_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "clog/console/csv.hpp"
#include "clog/console/text_file.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::cli {
namespace {

std::string shortened(const std::string& text) {
  constexpr std::size_t longest = 60;
  return text.size() > longest ? text.substr(0, longest) + "..." : text;
}

std::string in_lower_case(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return text;
}

/// Metres in a unit of length. @throws Error
double metres_in(const std::string& unit) {
  static const std::map<std::string, double> units = {{"nm", 1e-9}, {"um", 1e-6}, {"µm", 1e-6}, {"μm", 1e-6},
                                                      {"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}};
  const auto found = units.find(unit);
  if (found == units.end())
    throw Error(fmt::format("'{}' is no unit of length; use nm, um, mm, cm or m", shortened(unit)));
  return found->second;
}

/// Lengths of the file in droplet diameters: one of them is `value` units long.
struct Scale {
  std::string unit;  ///< of the numbers; empty: droplet diameters
  double droplet_metres = 0;

  /// Rounded to the digits that people write, so that a file in other units gives the same bits.
  double in_diameters(double number) const {
    if (unit.empty()) return number;
    constexpr int digits = 13;
    return sweep::to_number(fmt::format("{:.{}g}", number * (metres_in(unit) / droplet_metres), digits));
  }
};

/// `units=um droplet=200um`, which a comment may say; anything else in a comment is skipped. @throws Error
void read_scale(const std::string& comment, Scale& scale) {
  std::istringstream words(comment.substr(1));
  std::optional<std::string> unit, droplet;
  for (std::string word; words >> word;) {
    if (word.starts_with("units=")) unit = word.substr(6);
    if (word.starts_with("droplet=")) droplet = word.substr(8);
  }
  if (!unit && !droplet) return;
  if (!unit || !droplet)
    throw Error("units and the droplet's diameter belong together, as in '# units=um droplet=200um'");
  const std::size_t begin_of_unit = droplet->find_first_not_of("0123456789.eE+-");
  const double diameter = sweep::to_number(droplet->substr(0, begin_of_unit));
  const std::string unit_of_droplet =
      begin_of_unit == std::string::npos ? *unit : droplet->substr(begin_of_unit);
  metres_in(*unit);
  scale = {.unit = *unit, .droplet_metres = diameter * metres_in(unit_of_droplet)};
  if (!(scale.droplet_metres > 0) || !std::isfinite(scale.droplet_metres))
    throw Error("droplet must be a diameter above 0, as in '# units=um droplet=200um'");
}

/// Splits a line at semicolons, tabs or commas, whichever comes first in this list, or else at blanks. A
/// comma beside semicolons or tabs is a decimal comma.
std::vector<std::string> cells_of(std::string line) {
  const char separator = line.find(';') != std::string::npos    ? ';'
                         : line.find('\t') != std::string::npos ? '\t'
                         : line.find(',') != std::string::npos  ? ','
                                                                : ' ';
  if (separator == ';' || separator == '\t') std::replace(line.begin(), line.end(), ',', '.');
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, separator);)
    if (separator != ' ' || !console::trimmed(cell).empty()) cells.push_back(console::trimmed(cell));
  return cells;
}

/// Places of the columns in a line; -1: there is none.
struct Columns {
  int x = 0, y = 1, diameter = 2, radius = -1;
  std::size_t number = 3;  ///< most cells in a line
  bool have_header = false;
};

/// The names of the columns, if the first line has any. @throws Error  if x or y is missing, or sizes may be
std::optional<Columns> columns_named(const std::vector<std::string>& cells) {
  if (cells.empty() || cells[0].empty()) return {};
  if (std::ranges::none_of(cells, [](const std::string& cell) {
        return !cell.empty() && std::isalpha(static_cast<unsigned char>(cell[0])) && cell != "nan" &&
               cell != "inf";
      }))
    return {};
  Columns columns{
      .x = -1, .y = -1, .diameter = -1, .radius = -1, .number = cells.size(), .have_header = true};
  std::vector<std::string> others;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string name = in_lower_case(cells[i]);
    int* const column = name == "x"                         ? &columns.x
                        : name == "y"                       ? &columns.y
                        : name == "diameter" || name == "d" ? &columns.diameter
                        : name == "radius" || name == "r"   ? &columns.radius
                                                            : nullptr;
    if (!column)
      others.push_back(cells[i]);
    else if (std::exchange(*column, static_cast<int>(i)) >= 0)
      throw Error(fmt::format("there are two columns '{}'", shortened(cells[i])));
  }
  const bool has_size = columns.diameter >= 0 || columns.radius >= 0;
  if (columns.x < 0 || columns.y < 0 || (!has_size && !others.empty()) ||
      (columns.diameter >= 0 && columns.radius >= 0))
    throw Error(fmt::format(
        "the columns have to be x, y and one of diameter and radius, in any order, with or without others; "
        "or x and y alone, if all diameters are obstacle-diameter; here they are '{}'",
        shortened(joined(cells, ","))));
  return columns;
}

Obstacle parse_circle(const std::vector<std::string>& cells, const Columns& columns, const Scale& scale) {
  const auto has = [&](int column) { return column >= 0 && static_cast<std::size_t>(column) < cells.size(); };
  if (!has(columns.x) || !has(columns.y) || cells.size() > columns.number)
    throw Error(columns.have_header ? "has not as many cells as there are columns"
                                    : "needs x,y or x,y,diameter, separated by commas");
  const auto number = [&](int column) {
    return scale.in_diameters(sweep::to_number(cells[static_cast<std::size_t>(column)]));
  };
  Obstacle circle{number(columns.x), number(columns.y)};
  if (has(columns.diameter)) circle.radius = number(columns.diameter) / 2;
  if (has(columns.radius)) circle.radius = number(columns.radius);
  const bool has_size = has(columns.diameter) || has(columns.radius);
  if (has_size && !(circle.radius > 0)) throw Error("diameter must be positive");
  if (!has_size && !scale.unit.empty())
    throw Error("needs a diameter, as the file is in " + scale.unit +
                " and obstacle-diameter in droplet diameters");
  return circle;
}

}  // namespace

OwnCircles read_circles(const std::string& path) {
  static const std::set<std::string> drawings = {".dxf", ".gds",  ".gdsii", ".svg", ".png",
                                                 ".tif", ".tiff", ".bmp",   ".jpg", ".jpeg"};
  if (drawings.contains(in_lower_case(std::filesystem::path(path).extension())))
    throw Error(path + " is a drawing; python3 -m clogsweep circles converts it to a file of circles");
  std::vector<Obstacle> circles;
  std::istringstream file(console::read_text(path));
  Columns columns;
  Scale scale;
  bool is_first = true;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (number == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);  // with which spreadsheets begin
    const std::string text = console::trimmed(line);
    if (text.empty()) continue;
    try {
      if (text.starts_with('#')) {
        read_scale(text, scale);
        continue;
      }
      const std::vector<std::string> cells = cells_of(text);
      const std::optional<Columns> named =
          std::exchange(is_first, false) ? columns_named(cells) : std::nullopt;
      if (named)
        columns = *named;
      else
        circles.push_back(parse_circle(cells, columns, scale));
    } catch (const Error& error) {
      throw Error(fmt::format("{} line {}: {}", path, number, error.what()));
    }
  }
  if (circles.empty()) throw Error(path + " holds no obstacles; lines are x,y[,diameter]");
  const std::optional droplet = scale.unit.empty() ? std::nullopt : std::optional(scale.droplet_metres);
  return OwnCircles(std::move(circles), path, droplet);
}

void write_obstacles(const std::string& path, std::span<const Obstacle> obstacles) {
  std::ofstream file(path);
  file << "x,y,diameter\n";
  for (const Obstacle& obstacle : obstacles)
    file << sweep::shortest(obstacle.x) << ',' << sweep::shortest(obstacle.y) << ','
         << sweep::shortest(2 * obstacle.radius) << '\n';
  file.close();
  if (!file) throw Error("cannot write " + path + "; check the disk and the permissions");
}

}  // namespace clog::cli
