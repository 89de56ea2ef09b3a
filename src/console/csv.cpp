#include "clog/console/csv.hpp"

#include <fmt/core.h>

#include <cctype>
#include <cstdint>
#include <map>
#include <sstream>

#include "clog/console/text_file.hpp"
#include "clog/core/tools/error.hpp"

namespace clog::console {
namespace {

constexpr std::string_view blanks = " \t\r";

/// U+00A0, U+202F and U+2007, which keep numbers and units on one line, and U+FEFF of files that were joined.
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

/// Calls `call`, and adds file and line to an Error that it throws. @param number  of the line
void name_place(const std::string& path, int number, const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    throw Error(fmt::format("{} line {}: {}", path, number, error.what()));
  }
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

void read_table(const std::string& path, const std::function<void(const TableLine& line)>& each,
                const std::function<void(const std::string& text)>& comment) {
  std::istringstream file(read_table_text(path));
  TableLine row{.number = 0, .cells = {}, .separator = '\0'};
  for (std::string line; std::getline(file, line);) {
    ++row.number;
    const std::string text = trimmed(line);
    if (text.empty()) continue;
    const bool is_first = row.separator == '\0';
    if (is_first && line.starts_with("sep=") && line.size() > 4) {
      row.separator = line[4];
      continue;
    }
    name_place(path, row.number, [&] {
      if (text.starts_with('#') || text.starts_with("\"#")) {
        if (comment) comment(text);
        return;
      }
      if (is_first) row.separator = separator_of(line);
      row.cells = Splitter(line, row.separator).cells();
      each(row);
    });
  }
}

}  // namespace clog::console
