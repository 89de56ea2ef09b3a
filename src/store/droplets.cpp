#include "droplets.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <optional>
#include <unordered_map>

#include "check_sum.hpp"
#include "hdf5.hpp"

namespace clog::store {
namespace {

constexpr const char* sum_name = "checksum";

/// One line of the table.
struct Line {
  std::int64_t task;
  char path[longest_path];
  double diameter;
  double birth[3], end[3];
  char status[8], mechanism[8];
};
static_assert(sizeof(Line) == 8 + longest_path + 7 * sizeof(double) + 16,
              "the line has gaps, whose bytes are not defined");

struct LineColumn {
  const char* name;
  std::size_t offset;
  std::size_t text_size;  // 0: a number
  const char* meaning;
};
constexpr std::array columns = {
    LineColumn{
        "path", offsetof(Line, path), longest_path,
        "empty: the ancestor, whose row in /runs has this task; otherwise the mother's path, and 0 or 1"},
    LineColumn{"diameter", offsetof(Line, diameter), 0, "sqrt(area / area of the ancestor)"},
    LineColumn{"birth_distance", offsetof(Line, birth), 0, "from the release of the ancestor [sigma]"},
    LineColumn{"birth_lateral", offsetof(Line, birth) + 8, 0, "from the release of the ancestor [sigma]"},
    LineColumn{"birth_time", offsetof(Line, birth) + 16, 0, "from the release of the ancestor [t0]"},
    LineColumn{"end_distance", offsetof(Line, end), 0, "from the release of the ancestor [sigma]"},
    LineColumn{"end_lateral", offsetof(Line, end) + 8, 0, "from the release of the ancestor [sigma]"},
    LineColumn{"end_time", offsetof(Line, end) + 16, 0, "from the release of the ancestor [t0]"},
    LineColumn{"status", offsetof(Line, status), sizeof Line::status,
               "as in /runs; small: smaller than smallest_daughter, and not followed"},
    LineColumn{"mechanism", offsetof(Line, mechanism), sizeof Line::mechanism, "as in /runs"}};

Type line_type() {
  Type type(H5Tcreate(H5T_COMPOUND, sizeof(Line)));
  H5Tinsert(type, "task", offsetof(Line, task), H5T_NATIVE_INT64);
  for (const LineColumn& column : columns)
    if (column.text_size > 0)
      H5Tinsert(type, column.name, column.offset, text_type(column.text_size));
    else
      H5Tinsert(type, column.name, column.offset, H5T_NATIVE_DOUBLE);
  return type;
}

template <std::size_t size>
void copy_text(const std::string& text, char (&to)[size]) {
  std::ranges::copy(text.substr(0, size), to);
}

Line line_of(std::int64_t task, const Member& member) {
  Line line{};
  line.task = task;
  copy_text(member.path, line.path);
  line.diameter = member.diameter;
  const auto set = [](const FamilyPoint& point, double(&to)[3]) {
    to[0] = point.distance, to[1] = point.lateral, to[2] = point.time;
  };
  set(member.birth, line.birth);
  set(member.end, line.end);
  copy_text(name(member.status), line.status);
  copy_text(member.mechanism ? name(*member.mechanism) : "", line.mechanism);
  return line;
}

template <std::size_t size>
std::string text_of(const char (&from)[size]) {
  return {from, std::find(from, from + size, '\0')};
}

/// Nullopt if a word is unknown.
std::optional<Member> member_of(const Line& line) {
  const auto status = meant_by<MemberEnd>(text_of(line.status));
  const auto mechanism = meant_by<ClogMechanism>(text_of(line.mechanism));
  if (!status || !mechanism) return std::nullopt;
  const auto point = [](const double(&from)[3]) { return FamilyPoint{from[0], from[1], from[2]}; };
  return Member{.path = text_of(line.path),
                .diameter = line.diameter,
                .birth = point(line.birth),
                .end = point(line.end),
                .status = *status,
                .mechanism = *mechanism};
}

std::string check_sum_of(std::span<const Line> lines) {
  return std::to_string(check_sum(std::as_bytes(lines)));
}

/// The lines of the table; nullopt if they are not as they were written.
std::optional<std::vector<Line>> read_lines(hid_t file) {
  const Dataset table(H5Dopen2(file, droplets_name, H5P_DEFAULT));
  if (!table.valid()) return std::nullopt;
  const Type type = line_type();
  const hsize_t size = length_of(table).value_or(0);
  if (H5Tequal(Type(H5Dget_type(table)), type) <= 0 || !can_hold(table, size, sizeof(Line)))
    return std::nullopt;
  std::vector<Line> lines(size);
  if (H5Dread(table, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, lines.data()) < 0) return std::nullopt;
  if (read_attribute(table, sum_name) != check_sum_of(lines)) return std::nullopt;
  return lines;
}

}  // namespace

void write_droplets(hid_t file, std::span<const StoredFamily> families) {
  std::vector<Line> lines;
  for (const StoredFamily& family : families)
    for (const Member& member : family.members) lines.push_back(line_of(family.task, member));
  if (lines.empty()) return;
  constexpr hsize_t lines_per_chunk = 64;
  const Dataset table =
      write_dataset(file, droplets_name, line_type(), space_of({lines.size()}), lines.data(),
                    checked_chunks(std::min<hsize_t>(lines_per_chunk, lines.size())));
  write_attribute(table, "task", "task of the ancestor in /runs");
  for (const LineColumn& column : columns) write_attribute(table, column.name, column.meaning);
  write_attribute(table, sum_name, check_sum_of(lines));
}

void read_droplets(hid_t file, std::vector<sweep::RunRow>& rows, std::vector<std::string>& damage) {
  if (H5Lexists(file, droplets_name, H5P_DEFAULT) <= 0) return;
  const std::optional<std::vector<Line>> lines = read_lines(file);
  if (!lines) {
    damage.emplace_back("its droplets are not as they were written");
    return;
  }
  std::unordered_map<std::int64_t, sweep::RunRow*> by_task;
  for (sweep::RunRow& row : rows) by_task.emplace(row.task, &row);
  for (const Line& line : *lines) {
    const auto row = by_task.find(line.task);
    const std::optional<Member> member = member_of(line);
    if (row != by_task.end() && member) row->second->family.push_back(*member);
  }
}

}  // namespace clog::store
