#include "clog/cli/obstacle_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "clog/console/csv.hpp"
#include "clog/console/decimal_commas.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/excerpt.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::cli {
namespace {

constexpr const char* droplet_diameters = "sigma";  ///< the unit that means droplet diameters

/// Metres in a unit of length. @throws Error
double metres_in(const std::string& unit) {
  if (const std::optional<double> metres = console::metres_of(unit)) return *metres;
  throw Error(fmt::format("'{}' is no unit of length; use nm, um, mm, cm or m", excerpt(unit)));
}

bool is_unit(const std::string& unit) {
  return unit == droplet_diameters || console::metres_of(unit).has_value();
}

/// @throws Error if one of the words is not a unit of length
bool is_same_unit(const std::string& unit, const std::string& other) {
  if (unit == droplet_diameters || other == droplet_diameters) return unit == other;
  return metres_in(unit) == metres_in(other);
}

/// Converts lengths of the file to droplet diameters.
struct Scale {
  std::string unit;           ///< unit of the numbers; empty: droplet diameters
  double droplet_metres = 0;  ///< 0: not known

  /// Rounds to a few digits, so that the same circles in other units give the same bits.
  double in_diameters(double number) const {
    if (unit.empty()) return number;
    constexpr int digits = 13;
    return sweep::to_number(fmt::format("{:.{}g}", number * (metres_in(unit) / droplet_metres), digits));
  }
};

/// Reads `units=um droplet=200um` from a comment; anything else in a comment is skipped. @throws Error
/// @param is_droplet_known  whether the comment need not state the droplet's diameter
/// @param are_below_circles  whether circles precede the comment
void read_scale(const std::string& comment, Scale& scale, bool is_droplet_known, bool are_below_circles) {
  const auto [unit, droplet] = console::units_in(comment);
  if (!unit && !droplet) return;
  if (unit == droplet_diameters && !droplet && scale.unit.empty()) return;
  if (!unit || (!droplet && !is_droplet_known))
    throw Error(
        "units and the droplet's diameter belong together, as in '# units=um droplet=200um'; --lab FILE "
        "with the diameter may replace droplet=");
  metres_in(*unit);
  Scale stated{*unit, scale.droplet_metres};
  if (droplet) {
    const std::size_t begin_of_unit = droplet->find_first_not_of("0123456789.eE+-");
    const double diameter = sweep::to_number(droplet->substr(0, begin_of_unit));
    const std::string unit_of_droplet =
        begin_of_unit == std::string::npos ? *unit : droplet->substr(begin_of_unit);
    stated.droplet_metres = diameter * metres_in(unit_of_droplet);
  }
  const Scale earlier = std::exchange(scale, stated);
  const bool are_known = !earlier.unit.empty() && is_same_unit(earlier.unit, scale.unit) &&
                         earlier.droplet_metres == scale.droplet_metres;
  if (are_below_circles && !are_known)
    throw Error("units stand below circles, whose units they are not; move this line above all circles");
  if (!earlier.unit.empty() && !are_known)
    throw Error("units contradict those of an earlier line; delete one of the two");
  if (droplet && (!(scale.droplet_metres > 0) || !std::isfinite(scale.droplet_metres)))
    throw Error("droplet must be a diameter above 0, as in '# units=um droplet=200um'");
}

/// Positions of the columns in a line; -1: missing.
struct Columns {
  int x = 0, y = 1, diameter = 2, radius = -1;
  std::vector<std::string> header;  ///< empty: the file has no header
  std::string unit;                 ///< unit of the lengths, as named in the header
};

/// Stores the column that a cell of the header names.
/// @return whether the reader needs this column
/// @throws Error if the column occurs twice, or if its unit differs from that of the other columns
bool take_column(Columns& columns, int place, const std::string& cell) {
  const auto [name, unit] = console::column_head(cell);
  int* const column = name == "x"                                            ? &columns.x
                      : name == "y"                                          ? &columns.y
                      : name == "diameter" || name == "d" || name == "feret" ? &columns.diameter
                      : name == "radius" || name == "r"                      ? &columns.radius
                                                                             : nullptr;
  const bool is_in_brackets = cell.find_first_of("[(") != std::string::npos;
  if (!column || (!is_in_brackets && !unit.empty() && !is_unit(unit))) return false;
  if (std::exchange(*column, place) >= 0) {
    const std::string_view what = column == &columns.diameter ? "the diameter"
                                  : column == &columns.radius ? "the radius"
                                                              : std::string_view{name};
    throw Error(
        fmt::format("there are two columns for {}, the second is '{}'; delete one", what, excerpt(cell)));
  }
  if (unit.empty()) return true;
  if (columns.unit.empty()) columns.unit = unit;
  if (!is_same_unit(columns.unit, unit))
    throw Error(
        fmt::format("'{}' is not in {} as another column is; use one unit", excerpt(cell), columns.unit));
  return true;
}

/// Whether a line names columns: a cell begins with a letter.
bool is_header(const std::vector<std::string>& cells) {
  return std::ranges::any_of(cells, [](const std::string& cell) {
    return !cell.empty() && std::isalpha(static_cast<unsigned char>(cell[0])) && cell != "nan" &&
           cell != "inf";
  });
}

/// The columns that a header names. @throws Error if x or y is missing, or if sizes are ambiguous
Columns columns_named(std::vector<std::string> cells) {
  Columns columns{.x = -1, .y = -1, .diameter = -1, .radius = -1, .header = {}, .unit = ""};
  cells = console::without_surplus_cells(std::move(cells), 0);
  bool are_all = true;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (!take_column(columns, static_cast<int>(i), cells[i]) && !cells[i].empty()) are_all = false;
  const bool has_size = columns.diameter >= 0 || columns.radius >= 0;
  if (columns.diameter >= 0 && columns.radius >= 0)
    throw Error("there are columns of diameters and of radii; leave one of them out");
  if (columns.x < 0 || columns.y < 0 || (!has_size && !are_all))
    throw Error(fmt::format(
        "the columns have to be x, y and one of diameter and radius, in any order, with or without others; "
        "or x and y alone, if all diameters are obstacle-diameter, below comments, which begin with #; here "
        "they are '{}'",
        excerpt(joined(cells, ","))));
  columns.header = std::move(cells);
  return columns;
}

/// The columns that a comment names, as in files written by NumPy; nullopt for other comments.
std::optional<Columns> columns_in(std::string comment) {
  for (char& letter : comment)
    if (std::string_view("#,;\t\"").find(letter) != std::string_view::npos) letter = ' ';
  std::istringstream words(comment);
  Columns columns{.x = -1, .y = -1, .diameter = -1, .radius = -1, .header = {}, .unit = ""};
  for (std::string word; words >> word; columns.header.push_back(word))
    if (!take_column(columns, static_cast<int>(columns.header.size()), word)) return {};
  return columns.x >= 0 && columns.y >= 0 ? std::optional(columns) : std::nullopt;
}

/// The number in a cell. @param place  number of the cell in its line, from 0. @throws Error
double number_in(const console::TableLine& line, const Columns& columns, int place,
                 console::DecimalCommas& commas) {
  const std::string& cell = line.cells[static_cast<std::size_t>(place)];
  const std::string name = columns.header.empty() ? fmt::format("cell {}", place + 1)
                                                  : excerpt(columns.header[static_cast<std::size_t>(place)]);
  if (cell.empty()) throw Error(name + ": is empty; fill it, or remove the line");
  const std::string with_point = commas.with_point(name, cell, line.separator);
  try {
    return sweep::to_number(with_point);
  } catch (const Error&) {
    throw Error(fmt::format(
        "{}: '{}' is not a finite number; correct it, or put # before a line that is none of the table", name,
        excerpt(cell)));
  }
}

/// Checks the unit that the header names. @throws Error if the file's comment does not define this unit, or
/// contradicts it
void check_unit(const Columns& columns, const Scale& scale) {
  const std::string unit = scale.unit.empty() ? droplet_diameters : scale.unit;
  if (columns.unit.empty() || is_same_unit(columns.unit, unit)) return;
  if (scale.unit.empty())
    throw Error(
        fmt::format("the columns are in {0}; put a line '# units={0} droplet=200um' with your droplet's "
                    "diameter above them, or add --lab FILE with the diameter",
                    columns.unit));
  throw Error(fmt::format("the columns are in {}, but the file says units={}; correct one of them",
                          columns.unit, scale.unit));
}

void check_number_of_cells(const std::vector<std::string>& cells, const Columns& columns) {
  if (columns.header.empty() && (cells.size() < 2 || cells.size() > 3))
    throw Error("needs x,y or x,y,diameter, separated by commas");
  if (!columns.header.empty() && cells.size() != columns.header.size())
    throw Error(fmt::format("has {}, but the line of names has {}; give each column a name, such as id",
                            count_text(std::ssize(cells), "cell"), columns.header.size()));
}

Obstacle parse_circle(console::TableLine line, const Columns& columns, const Scale& scale,
                      console::DecimalCommas& commas) {
  line.cells =
      console::without_surplus_cells(std::move(line.cells), std::max<std::size_t>(columns.header.size(), 1));
  check_number_of_cells(line.cells, columns);
  check_unit(columns, scale);
  const auto has = [&](int column) { return column >= 0 && column < std::ssize(line.cells); };
  const auto number = [&](int column) {
    return scale.in_diameters(number_in(line, columns, column, commas));
  };
  Obstacle circle{number(columns.x), number(columns.y)};
  if (has(columns.diameter)) circle.radius = number(columns.diameter) / 2;
  if (has(columns.radius)) circle.radius = number(columns.radius);
  const bool has_size = has(columns.diameter) || has(columns.radius);
  if (has_size && !(circle.radius > 0)) throw Error("diameter must be positive");
  return circle;
}

/// Parts of a name like posts.csv@0.8mm: the file, and the diameter [m] of the droplet to which the circles
/// are scaled.
std::pair<std::string, std::optional<double>> parts_of(const std::string& name) {
  const auto at = name.rfind('@');
  std::error_code none;
  if (at == std::string::npos || std::filesystem::exists(name, none)) return {name, {}};
  const auto unit = std::min(name.find_first_not_of("0123456789.eE+-", at + 1), name.size());
  return {name.substr(0, at),
          sweep::to_number(name.substr(at + 1, unit - at - 1)) * metres_in(name.substr(unit))};
}

}  // namespace

OwnCircles read_circles(const std::string& name, const std::optional<double>& laboratory_droplet) {
  const std::pair<std::string, std::optional<double>> parts = parts_of(name);
  const auto& path = parts.first;
  const auto& droplet = parts.second;  // clang captures no structured bindings
  static const std::set<std::string> drawings = {".dxf", ".gds",  ".gdsii", ".svg", ".png",
                                                 ".tif", ".tiff", ".bmp",   ".jpg", ".jpeg"};
  if (drawings.contains(console::in_lower_case(std::filesystem::path(path).extension())))
    throw Error(path + " is a drawing; python3 -m clogsweep circles converts it to a file of circles");
  std::vector<Obstacle> circles;
  std::map<std::array<double, 3>, int> lines;  // the line of each circle
  Columns columns;
  Scale scale{.unit = "", .droplet_metres = laboratory_droplet.value_or(0)};
  const bool is_droplet_known = droplet || laboratory_droplet;
  console::DecimalCommas commas;
  bool is_first = true;
  const auto scale_to = [&scale](const std::optional<double>& other_droplet) {
    return other_droplet ? Scale{scale.unit, *other_droplet} : scale;
  };
  console::read_table(
      path,
      [&](const console::TableLine& line) {
        if (std::exchange(is_first, false) && is_header(line.cells)) {
          columns = columns_named(line.cells);
          return;
        }
        if (is_droplet_known && scale.unit.empty() && columns.unit != droplet_diameters)
          scale.unit = columns.unit;
        const Obstacle circle = parse_circle(line, columns, scale_to(droplet), commas);
        if (circle.radius == 0 && !scale.unit.empty() && !is_droplet_known)
          throw Error("needs a diameter, as the file is in " + scale.unit +
                      " and obstacle-diameter in droplet diameters");
        const auto [known, is_new] =
            lines.emplace(std::array{circle.x, circle.y, circle.radius}, line.number);
        if (!is_new)
          throw Error(
              fmt::format("lists the circle of line {} again; delete one of the two lines", known->second));
        circles.push_back(circle);
      },
      [&](const std::string& comment) {
        read_scale(comment, scale, is_droplet_known, !circles.empty());
        if (is_first) columns = columns_in(comment).value_or(columns);
      });
  commas.check(path);
  if (circles.empty()) throw Error(path + " holds no obstacles; lines are x,y[,diameter]");
  if (droplet && scale.unit.empty())
    throw Error(path +
                " is in droplet diameters and cannot be scaled to another droplet; put a line such as "
                "'# units=um droplet=200um' above its circles");
  return OwnCircles(std::move(circles), name,
                    scale.unit.empty() ? std::nullopt : std::optional(scale_to(droplet).droplet_metres));
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
