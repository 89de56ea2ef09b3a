#include "droplets.hpp"

#include <fmt/core.h>

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

std::uint32_t check_sum_of(const Line& line) { return check_sum(std::as_bytes(std::span(&line, 1))); }

/// All values of a dataset of this type, without a comparison of HDF5's checksums; nullopt if the dataset
/// cannot be read.
template <class T>
std::optional<std::vector<T>> read_all(hid_t file, const char* name, hid_t type) {
  const Dataset dataset(H5Lexists(file, name, H5P_DEFAULT) > 0 ? H5Dopen2(file, name, H5P_DEFAULT)
                                                               : hid_t{-1});
  if (!dataset.valid() || H5Tequal(Type(H5Dget_type(dataset)), type) <= 0) return std::nullopt;
  const hsize_t size = length_of(dataset).value_or(0);
  if (!can_hold(dataset, size, sizeof(T))) return std::nullopt;
  std::vector<T> values(size);
  if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, without_library_check(), values.data()) < 0)
    return std::nullopt;
  return values;
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
  std::vector<std::uint32_t> sums;
  for (const Line& line : lines) sums.push_back(check_sum_of(line));
  const Dataset list =
      write_dataset(file, droplet_sums_name, H5T_NATIVE_UINT32, space_of({sums.size()}), sums.data(),
                    checked_chunks(std::min<hsize_t>(lines_per_chunk, sums.size())));
  write_attribute(list, "meaning", "CRC-32, as of zlib, of the bytes of each row of /droplets");
}

void read_droplets(hid_t file, std::vector<sweep::RunRow>& rows, std::vector<std::string>& damage) {
  if (H5Lexists(file, droplets_name, H5P_DEFAULT) <= 0) return;
  const auto lines = read_all<Line>(file, droplets_name, line_type());
  const auto sums = read_all<std::uint32_t>(file, droplet_sums_name, H5T_NATIVE_UINT32);
  if (!lines || !sums || lines->size() != sums->size()) {
    damage.emplace_back("its droplets are not as they were written");
    return;
  }
  std::unordered_map<std::int64_t, sweep::RunRow*> by_task;
  for (sweep::RunRow& row : rows) by_task.emplace(row.task, &row);
  for (std::size_t i = 0; i < lines->size(); ++i) {
    const Line& line = (*lines)[i];
    if (check_sum_of(line) != (*sums)[i]) {
      damage.push_back(fmt::format("droplet {} (task {}) is not as it was written", i, line.task));
      continue;
    }
    const auto row = by_task.find(line.task);
    const std::optional<Member> member = member_of(line);
    if (row != by_task.end() && member) row->second->family.push_back(*member);
  }
}

}  // namespace clog::store
