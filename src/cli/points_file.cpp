#include "clog/cli/points_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "clog/console/csv.hpp"
#include "clog/console/decimal_commas.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::cli {
namespace {

/// The columns whose heads name keys. A column without a head, such as the index of pandas, is ignored.
std::vector<std::size_t> columns_of(const std::vector<std::string>& header) {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < header.size(); ++i) try {
      if (header[i].empty()) continue;
      sweep::find_key(header[i]);
      columns.push_back(i);
    } catch (const Error& error) {
      const bool has_unit = header[i].find_first_of(" [(") != std::string::npos;
      throw Error(std::string(error.what()) + (has_unit ? "; the first line names keys alone, without units"
                                                        : "; the first line names keys"));
    }
  return columns;
}

/// The value of a key in a cell. A comma is a decimal comma unless commas separate the cells. If a column has
/// an empty cell, pandas writes the column's integers as 64.0 or 64,0; this function removes the zero.
/// @throws Error if it is not clear whether a comma is decimal or separates the items of a list, or if other
/// numbers have decimal points
std::string value_of(const sweep::Key& key, const std::string& cell, char separator,
                     console::DecimalCommas& decimal_commas) {
  const bool is_integer = key.kind == ValueKind::integer;
  const bool is_number = key.kind == ValueKind::number || key.kind == ValueKind::number_or_share;
  const auto commas = std::ranges::count(cell, ',');
  // A comma in a list of seeds is never a decimal comma, even if 0 follows it.
  const bool may_be_decimal = separator != ',' && commas == 1 && !key.is_ensemble();
  const auto with_point = [&](const std::string& number) {
    return decimal_commas.with_point(key.name, number, separator);
  };
  if (is_integer && (cell.ends_with(".0") || (may_be_decimal && cell.ends_with(",0"))))
    return with_point(cell).substr(0, cell.size() - 2);
  const std::size_t end = std::min(cell.find_first_not_of("0123456789+-.,eE% "), cell.size());
  const std::string number = console::trimmed(cell.substr(0, end)), unit = cell.substr(end);
  const bool is_one_number =
      unit.find_first_of(",()") == std::string::npos;  // 0,4mm; not lin(1,2,3), 1mm,2mm
  if (number.empty() || !is_one_number || !(is_number || (is_integer && cell.ends_with(",0")))) return cell;
  if (commas == 0) {
    if (separator != ',') with_point(number);
    return cell;
  }
  if (is_integer || separator == ',' || commas > 1 || number.find('.') != std::string::npos)
    throw Error(fmt::format(
        "{}: '{}' may be a list or have a decimal comma; write decimal points, and a line for each value",
        key.name, cell));
  return with_point(number) + unit;
}

/// The values of the keys, unchecked; Settings::set_points() checks them.
/// @param num_columns  number of columns of the first line. @throws Error  if a comma is ambiguous
std::vector<std::string> values_of(const console::TableLine& line, const std::vector<std::string>& keys,
                                   const std::vector<std::size_t>& columns, std::size_t num_columns,
                                   console::DecimalCommas& commas) {
  const std::vector<std::string> cells = console::without_surplus_cells(line.cells, num_columns);
  if (cells.size() != num_columns)
    throw Error(fmt::format("has {}, but the first line names {}",
                            count_text(static_cast<std::int64_t>(cells.size()), "cell"),
                            count_text(static_cast<std::int64_t>(num_columns), "key")));
  std::vector<std::string> values;
  values.reserve(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    values.push_back(value_of(sweep::find_key(keys[i]), cells[columns[i]], line.separator, commas));
  return values;
}

}  // namespace

sweep::Points read_points(const std::string& path) {
  sweep::Points points{.keys = {}, .rows = {}, .file = path};
  std::vector<std::size_t> columns;
  std::size_t num_columns = 0;
  console::DecimalCommas commas;
  console::read_table(path, [&](const console::TableLine& line) {
    if (num_columns == 0) {
      columns = columns_of(line.cells);
      for (const std::size_t column : columns) points.keys.push_back(line.cells[column]);
      num_columns = console::without_surplus_cells(line.cells, 0).size();
    } else {
      points.rows.push_back(values_of(line, points.keys, columns, num_columns, commas));
      points.lines.push_back(line.number);
    }
  });
  commas.check(path);
  if (points.rows.empty())
    throw Error(path +
                " holds no points; its first line names keys, each line that follows has a value for each");
  return points;
}

}  // namespace clog::cli
