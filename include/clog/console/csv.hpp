#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clog::console {

/// The text without blanks at its ends.
std::string trimmed(std::string_view text);

std::string in_lower_case(std::string text);

struct ColumnHead {
  std::string name;  ///< in lower case
  std::string unit;  ///< empty if the head has none
};
/// "x [um]", "x (um)", "x/um" and "x_um" all have the name x and the unit um.
ColumnHead column_head(const std::string& cell);
/// Number of metres in one unit of length that a table may use, such as mm; nullopt for any other word.
std::optional<double> metres_of(const std::string& unit);
/// Number of degrees in one unit of angle that a table may use, such as rad; nullopt for any other word.
std::optional<double> degrees_of(const std::string& unit);

/// What a comment such as `# units=um droplet=200um` states.
struct UnitsComment {
  std::optional<std::string> unit, droplet;
};
/// Reads the units in a comment, and skips the rest of the comment.
UnitsComment units_in(std::string comment);

/// Whether a cell is an error of a spreadsheet: `#N/A`, `#DIV/0!`, `#REF!`, `#WERT!`, `Err:502`, and their
/// translations. Most are in upper case, begin with # and end with ! or ?.
bool is_error_word(std::string_view cell);

/// A line of a table.
struct TableLine {
  int number;                      ///< number of the line, from 1
  std::vector<std::string> cells;  ///< without quotes and blanks around them; empty cells are kept
  char separator;                  ///< the separator between cells; ' ' means one or more blanks
};
/// Removes empty cells beyond the last column, which some spreadsheets add.
std::vector<std::string> without_surplus_cells(std::vector<std::string> cells, std::size_t num_columns);

/// Reads a table line by line. Supports files of spreadsheets, pandas, R and ImageJ: the first line shows
/// whether semicolons, tabs, commas or blanks separate the cells, unless `sep=;` precedes it; cells may be
/// quoted. Text that is not UTF-8 is read as Latin-1. Non-breaking blanks count as blanks. Lines that begin
/// with # are ignored. Blank lines are ignored, too, but in a table of one column a blank line between two
/// other lines is an empty cell.
/// @param each  called with each line; if it throws an Error, path and line number are added to the text
/// @param comment  called with lines that begin with #
/// @throws Error as read_text(), for a quote without an end, or for a cell that is an error of a spreadsheet
void read_table(const std::string& path, const std::function<void(const TableLine& line)>& each,
                const std::function<void(const std::string& text)>& comment = {});

}  // namespace clog::console
