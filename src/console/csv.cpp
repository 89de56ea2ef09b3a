#include "clog/console/csv.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <iterator>
#include <map>
#include <numbers>
#include <sstream>
#include <utility>

#include "clog/console/text_file.hpp"
#include "clog/core/tools/error.hpp"

namespace clog::console {
namespace {

constexpr std::string_view blanks = " \t\r";

/// U+00A0, U+202F and U+2007 keep numbers and units on one line. U+FEFF occurs within files that were joined
/// from several files.
constexpr std::string_view other_blanks[] = {"\xc2\xa0", "\xe2\x80\xaf", "\xe2\x80\x87", "\xef\xbb\xbf"};

/// Whether each byte above ASCII belongs to a character of UTF-8.
bool is_utf8(std::string_view text) {
  std::size_t following = 0;
  for (const char letter : text) {
    const auto byte = static_cast<std::uint8_t>(letter);
    if ((byte & 0xc0U) == 0x80U ? following == 0 : following != 0) return false;
    following = following != 0  ? following - 1
                : byte >= 0xf0U ? 3
                : byte >= 0xe0U ? 2
                : byte >= 0xc0U ? 1
                                : 0;
  }
  return following == 0;
}

std::string from_latin1(std::string_view text) {
  std::string converted;
  for (const char letter : text) {
    const auto byte = static_cast<std::uint8_t>(letter);
    if (byte < 0x80U) {
      converted += letter;
    } else {
      converted += static_cast<char>(0xc0U | byte >> 6U);
      converted += static_cast<char>(0x80U | (byte & 0x3fU));
    }
  }
  return converted;
}

void replace_other_blanks(std::string& text) {
  for (const std::string_view blank : other_blanks)
    for (auto at = text.find(blank); at != std::string::npos; at = text.find(blank, at + 1)) {
      text.erase(at, blank.size() - 1);
      text[at] = ' ';
    }
}

char separator_of(std::string_view line) {
  for (const char separator : {';', '\t', ','})
    if (line.find(separator) != std::string_view::npos) return separator;
  return ' ';
}

bool is_blank(char letter) { return blanks.find(letter) != std::string_view::npos; }

/// Splits one line into cells.
class Splitter {
 public:
  Splitter(const std::string& line, char separator) : rest_(line), separator_(separator) {}

  std::vector<std::string> cells() {
    std::vector<std::string> found;
    skip_blanks();
    do found.push_back(next());
    while (has_more_);
    return found;
  }

 private:
  std::string_view rest_;
  char separator_;
  bool has_more_ = false;

  bool is_separator(char letter) const { return separator_ == ' ' ? is_blank(letter) : letter == separator_; }
  /// Skips blanks before a cell, unless blanks separate the cells.
  void skip_blanks() {
    while (!rest_.empty() && is_blank(rest_[0]) && (separator_ == ' ' || rest_[0] != separator_))
      rest_.remove_prefix(1);
  }
  std::string next() {
    skip_blanks();
    const bool is_quoted = rest_.starts_with('"');
    std::string cell = is_quoted ? quoted() : "";
    std::size_t length = 0;
    while (length < rest_.size() && !is_separator(rest_[length])) ++length;
    cell += rest_.substr(0, length);
    has_more_ = length < rest_.size();
    rest_.remove_prefix(length + (has_more_ ? 1 : 0));
    if (separator_ == ' ') has_more_ = rest_.find_first_not_of(blanks) != std::string_view::npos;
    return trimmed(cell);
  }
  /// Takes a cell in quotes. In such a cell, two quotes stand for one quote.
  std::string quoted() {
    std::string cell;
    for (;;) {
      const auto end = rest_.find('"', 1);
      if (end == std::string_view::npos)
        throw Error("has a quote that does not end; write each row in one line");
      cell += rest_.substr(1, end - 1);
      rest_.remove_prefix(end + 1);
      if (!rest_.starts_with('"')) return cell;
      cell += '"';
    }
  }
};

/// Error words of spreadsheets that end neither with ! nor with ?, in lower case. Most of them mean "not
/// available" in a language of Excel or LibreOffice.
constexpr std::string_view other_error_words[] = {"#n/a", "#na",  "#nv",  "#n/d",      "#n/b",
                                                  "#i/t", "#Н/Д", "#yok", "#hiÁnyzik", "#getting_data"};

/// Whether the cell consists of # only. Excel shows ### for values that are wider than their column.
bool is_row_of_hashes(std::string_view cell) {
  constexpr std::size_t fewest = 2;
  return cell.size() >= fewest && cell.find_first_not_of('#') == std::string_view::npos;
}

/// The first cell of a line that begins with #, without quotes around the cell.
/// @param separator  of the table; '\0' if no line of the table precedes this line
std::string_view first_cell(std::string_view comment, char separator) {
  const bool is_quoted = comment.starts_with('"');
  if (is_quoted) comment.remove_prefix(1);
  const std::string_view ends = is_quoted           ? "\""
                                : separator == '\0' ? ",;\t"
                                : separator == ' '  ? blanks
                                                    : "";
  return comment.substr(0, ends.empty() ? comment.find(separator) : comment.find_first_of(ends));
}

/// @param place  of the cell in its line, from 0. @throws Error
[[noreturn]] void refuse_error_word(std::string_view cell, std::size_t place) {
  throw Error(fmt::format(
      "column {} is '{}', an error of a spreadsheet; correct this cell, or begin comments with '# '",
      place + 1, cell));
}

/// @throws Error  if a cell is an error of a spreadsheet
void refuse_error_words(const std::vector<std::string>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (is_error_word(cells[i]) || is_row_of_hashes(cells[i])) refuse_error_word(cells[i], i);
}

/// @throws Error  if a line that begins with # is no comment, but a line of the table with a spreadsheet
/// error in its first cell
void refuse_lost_line(std::string_view comment, char separator) {
  const std::string cell = trimmed(first_cell(comment, separator));
  const bool may_be_separated_by_blanks = separator == ' ' || separator == '\0';
  for (const std::string& word :
       {cell, may_be_separated_by_blanks ? cell.substr(0, cell.find_first_of(blanks)) : ""})
    if (is_error_word(word)) refuse_error_word(word, 0);
  if (separator != ' ' && is_row_of_hashes(cell) && cell.size() < comment.size()) refuse_error_word(cell, 0);
}

/// Calls `call`, and adds file and line to an Error that it throws. @param number  of the line
void name_place(const std::string& path, int number, const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    throw Error(fmt::format("{} line {}: {}", path, number, error.what()));
  }
}

/// Calls each() for the blank lines of a table with one column, in which a blank line is an empty cell.
void give_empty_cells(const std::vector<int>& numbers,
                      const std::function<void(const TableLine& line)>& each) {
  for (const int number : numbers) each({.number = number, .cells = {""}, .separator = ' '});
}

/// Replaces `units = um` by `units=um` in a comment.
std::string without_blanks_around_equals(std::string comment) {
  for (auto at = comment.find('='); at != std::string::npos; at = comment.find('=', at + 1)) {
    while (at + 1 < comment.size() && comment[at + 1] == ' ') comment.erase(at + 1, 1);
    while (at > 0 && comment[at - 1] == ' ') comment.erase(--at, 1);
  }
  return comment;
}

std::string read_table_text(const std::string& path) {
  std::string text = read_text(path);
  if (text.find('\0') != std::string::npos)
    throw Error("cannot read " + path + " (it holds zero bytes); save it as text in UTF-8");
  if (!is_utf8(text)) text = from_latin1(text);
  replace_other_blanks(text);
  return text;
}

}  // namespace

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(blanks) - first + 1));
}

std::string in_lower_case(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return text;
}

bool is_error_word(std::string_view cell) {
  const std::string word = in_lower_case(std::string(cell));
  if (std::ranges::find(other_error_words, word) != std::end(other_error_words)) return true;
  for (const std::string_view error :
       {"err:", "fehler:", "erreur:"})  // errors of LibreOffice have numbers: Err:502
    if (word.starts_with(error) && word.size() > error.size() &&
        word.find_first_not_of("0123456789", error.size()) == std::string::npos)
      return true;
  constexpr std::size_t shortest = 4;  // #AD?
  const bool has_lower_case =
      std::ranges::any_of(cell, [](char letter) { return letter >= 'a' && letter <= 'z'; });
  if (has_lower_case || cell.size() < shortest || !cell.starts_with('#') || is_blank(cell[1])) return false;
  if (!cell.ends_with('!') && !cell.ends_with('?')) return false;
  const std::string without_mark = trimmed(cell.substr(0, cell.size() - 1));  // French: #NOM ?
  return without_mark.find_first_of(blanks) == std::string::npos;
}

ColumnHead column_head(const std::string& cell) {
  constexpr const char* around_unit = " [(/_,";
  const auto end = cell.find_first_of(around_unit);
  const std::string name = in_lower_case(cell.substr(0, end));
  const auto begin_of_unit = end == std::string::npos ? end : cell.find_first_not_of(around_unit, end);
  if (begin_of_unit == std::string::npos) return {name, ""};
  const std::string rest = cell.substr(begin_of_unit);
  return {name, rest.substr(0, rest.find_last_not_of(" ])") + 1)};
}

std::optional<double> metres_of(const std::string& unit) {
  static const std::map<std::string, double> units = {{"nm", 1e-9}, {"um", 1e-6},     {"µm", 1e-6},
                                                      {"μm", 1e-6}, {"micron", 1e-6}, {"microns", 1e-6},
                                                      {"mm", 1e-3}, {"cm", 1e-2},     {"m", 1}};
  const auto found = units.find(unit);
  return found == units.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> degrees_of(const std::string& unit) {
  static const std::map<std::string, double> units = {
      {"deg", 1}, {"degree", 1}, {"degrees", 1}, {"°", 1}, {"rad", 180 / std::numbers::pi}};
  const auto found = units.find(unit);
  return found == units.end() ? std::nullopt : std::optional(found->second);
}

UnitsComment units_in(std::string comment) {
  std::istringstream words(without_blanks_around_equals(std::move(comment)));
  UnitsComment found;
  for (std::string word; words >> word;) {
    word.erase(word.find_last_not_of(";,\"") + 1);  // drops empty cells that a spreadsheet adds
    word.erase(0, word.find_first_not_of("#\""));
    const std::string name = in_lower_case(word.substr(0, word.find('=') + 1));
    if (name == "units=" || name == "unit=") found.unit = word.substr(name.size());
    if (name == "droplet=") found.droplet = word.substr(name.size());
  }
  return found;
}

std::vector<std::string> without_surplus_cells(std::vector<std::string> cells, std::size_t num_columns) {
  while (cells.size() > num_columns && cells.back().empty()) cells.pop_back();
  return cells;
}

void read_table(const std::string& path, const std::function<void(const TableLine& line)>& each,
                const std::function<void(const std::string& text)>& comment) {
  std::istringstream file(read_table_text(path));
  TableLine row{.number = 0, .cells = {}, .separator = '\0'};
  bool has_one_column = false;
  std::vector<int> blank_lines;  // numbers of the blank lines since the last line of the table
  for (std::string line; std::getline(file, line);) {
    ++row.number;
    const std::string text = trimmed(line);
    if (text.empty()) {
      blank_lines.push_back(row.number);
      continue;
    }
    const bool is_first = row.separator == '\0';
    if (is_first && line.starts_with("sep=") && line.size() > 4) {
      row.separator = line[4];
      continue;
    }
    name_place(path, row.number, [&] {
      if (text.starts_with('#') || text.starts_with("\"#")) {
        refuse_lost_line(text, row.separator);
        if (comment) comment(text);
        return;
      }
      if (is_first) row.separator = separator_of(line);
      row.cells = Splitter(line, row.separator).cells();
      refuse_error_words(row.cells);
      if (is_first) has_one_column = row.cells.size() == 1;
      if (has_one_column && !is_first) give_empty_cells(blank_lines, each);
      blank_lines.clear();
      each(row);
    });
  }
}

}  // namespace clog::console
