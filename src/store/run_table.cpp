#include "clog/store/run_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>

#include "check_sum.hpp"
#include "circle_files.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/value_list.hpp"
#include "file_io.hpp"
#include "hdf5.hpp"
#include "laboratory_texts.hpp"
#include "row_layout.hpp"
#include "run_rows.hpp"
#include "seal.hpp"
#include "trial_read.hpp"

namespace clog::store {
namespace {

using sweep::RunRow;

constexpr const char* runs_name = "runs";
constexpr const char* sums_name = "row_checksums";
constexpr const char* sweep_kind = "clogsweep sweep";
constexpr hsize_t rows_per_chunk = 64;
constexpr std::size_t rows_per_block = 1024;  // that are copied at once

using CheckSums = std::vector<std::uint32_t>;  // of the rows

std::uint32_t joint_check_sum(const CheckSums& sums) { return check_sum(std::as_bytes(std::span(sums))); }

/// Calls with the number of the first row of each block and how many rows it has.
template <class Visit>
void for_each_block(std::size_t num_rows, Visit visit) {
  for (std::size_t first = 0; first < num_rows; first += rows_per_block)
    visit(first, std::min(rows_per_block, num_rows - first));
}

/// Rows of the table that are to be read or written at once.
Space select_rows(hid_t table, std::size_t first, std::size_t number) {
  Space space(H5Dget_space(table));
  const hsize_t start = first, count = number;
  H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, nullptr, &count, nullptr);
  return space;
}
Space space_of(std::size_t number) {
  const hsize_t count = number;
  return Space(H5Screate_simple(1, &count, nullptr));
}

/// A dataset that may be longer one day, for readers who append. They notice damage by its own checksum, too.
Dataset make_dataset(hid_t file, const char* name, hid_t type, std::size_t num_rows) {
  const hsize_t size = num_rows;
  const hsize_t unlimited = H5S_UNLIMITED;
  const Space space(H5Screate_simple(1, &size, &unlimited));
  const PropertyList properties(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_chunk(properties, 1, &rows_per_chunk);
  H5Pset_fletcher32(properties);
  return Dataset(H5Dcreate2(file, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT));
}

CheckSums write_table(hid_t file, std::span<const RunRow> rows, const std::string& path) {
  const RowLayout layout = RowLayout::present();
  const Dataset table = make_dataset(file, runs_name, layout.type(), rows.size());
  check(table.valid(), "create the table of runs in", path);
  layout.describe(table);
  CheckSums sums;
  std::vector<std::byte> packed(std::min(rows_per_block, rows.size()) * layout.size());
  for_each_block(rows.size(), [&](std::size_t first, std::size_t number) {
    for (std::size_t i = 0; i < number; ++i) {
      const std::span row(packed.data() + i * layout.size(), layout.size());
      sweep::pack(rows[first + i], row);
      sums.push_back(check_sum(row));
    }
    check(H5Dwrite(table, layout.type(), space_of(number), select_rows(table, first, number), H5P_DEFAULT,
                   packed.data()) >= 0,
          "write", path);
  });
  return sums;
}

void write_check_sums(hid_t file, const CheckSums& sums, const std::string& path) {
  const Dataset dataset = make_dataset(file, sums_name, H5T_NATIVE_UINT32, sums.size());
  check(dataset.valid(), "create the rows' checksums in", path);
  write_attribute(dataset, "meaning", "CRC-32, as of zlib, of the bytes of each row of /runs");
  if (!sums.empty())
    check(H5Dwrite(dataset, H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, sums.data()) >= 0, "write",
          path);
}

/// Tells a damaged table, which lacks a column that was written, from one of an older program.
constexpr const char* num_columns_name = "num_columns";

/// The attribute that has a line for every other one, and for the table: checksum and name.
constexpr const char* list_name = "checksums";

std::string line_of(std::uint32_t sum, const std::string& name) {
  return fmt::format("{:08x} {}\n", sum, name);
}

/// An attribute holds less than 64 KiB: what is left of a longer text goes to others, `config.2` and so on.
constexpr std::size_t longest_part = 60'000;

std::string name_of_part(const std::string& name, std::size_t part) {
  return part == 0 ? name : fmt::format("{}.{}", name, part + 1);
}

/// Puts together what name_of_part() has named.
void join_parts(Provenance& provenance) {
  for (std::size_t i = 0; i < provenance.size(); ++i)
    for (std::size_t part = 1;; ++part) {
      const std::string name = name_of_part(provenance[i].first, part);
      const auto next = std::ranges::find(provenance, name, [](const auto& one) { return one.first; });
      if (next == provenance.end()) break;
      provenance[i].second += next->second;
      provenance.erase(next);
    }
}

std::string name_of_rows(std::size_t num_rows) { return fmt::format("{} rows", num_rows); }

}  // namespace

void write_runs(hid_t file, const std::string& kind, std::span<const RunRow> rows,
                const Provenance& provenance, const std::string& path) {
  const CheckSums sums = write_table(file, rows, path);
  write_check_sums(file, sums, path);
  std::string lines = line_of(joint_check_sum(sums), name_of_rows(rows.size()));
  const auto write = [&](const std::string& name, const std::string& text) {
    write_attribute(file, name, text);
    lines += line_of(check_sum(text), name);
  };
  write("kind", kind);
  write("format_version", format_version);
  write(num_columns_name, fmt::format("{}", sweep::columns().size()));
  for (const auto& [name, text] : provenance)
    for (std::size_t part = 0; part == 0 || part * longest_part < text.size(); ++part)
      write(name_of_part(name, part), text.substr(part * longest_part, longest_part));
  write_attribute(file, list_name, lines);
  write_laboratories(file, rows, path);
}

std::string library_version() {
  prepare_library();
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

namespace {

std::function<void(hid_t file)> writer(const OutputPath& place, std::span<const RunRow> rows,
                                       const Provenance& provenance, std::span<const CircleFile> circles) {
  require_memory_of_file("write " + place.path(), rows.size() * RowLayout::present().size());
  return [=, &provenance, path = place.path()](hid_t file) {
    write_runs(file, sweep_kind, rows, provenance, path);
    write_circles(file, circles, path);
  };
}

}  // namespace

bool publish_sweep(const OutputPath& place, std::span<const RunRow> rows, const Provenance& provenance,
                   std::span<const CircleFile> circles) {
  return replace_whole(place, writer(place, rows, provenance, circles));
}

std::optional<std::string> publish_sweep_over(const std::string& stamp, const OutputPath& place,
                                              std::span<const RunRow> rows, const Provenance& provenance,
                                              std::span<const CircleFile> circles) {
  return replace_whole(place, stamp, writer(place, rows, provenance, circles));
}

namespace {

constexpr std::array<std::string_view, 2> readable_versions = {"9", format_version};

/// A line of the attribute with checksums; nothing if it does not look like one.
std::optional<std::pair<std::string, std::uint32_t>> check_sum_line(const std::string& line) {
  constexpr std::size_t num_digits = 8;
  if (line.size() <= num_digits + 1) return std::nullopt;
  std::uint32_t sum = 0;
  const char* end = line.data() + num_digits;
  if (std::from_chars(line.data(), end, sum, 16).ptr != end) return std::nullopt;
  return std::pair(line.substr(num_digits + 1), sum);
}

/// What the list of checksums has for an attribute.
std::optional<std::uint32_t> listed_check_sum(hid_t file, const std::string& name) {
  std::istringstream lines(read_attribute(file, list_name));
  for (std::string line; std::getline(lines, line);)
    if (const auto listed = check_sum_line(line); listed && listed->first == name) return listed->second;
  return std::nullopt;
}

/// An attribute's text: of these the one that was written, as its checksum says, if it is damaged now.
template <class Texts>
std::string text_as_written(hid_t file, const std::string& name, const Texts& candidates) {
  std::string text = read_attribute(file, name);
  if (std::ranges::find(candidates, text) != candidates.end()) return text;
  const std::optional<std::uint32_t> listed = listed_check_sum(file, name);
  for (const std::string_view candidate : candidates)
    if (listed == check_sum(candidate)) return std::string(candidate);
  return text;
}

/// @throws Error if the open file has a format version that this program does not read
void require_readable_version(hid_t file, const std::string& path) {
  const std::string version = text_as_written(file, "format_version", readable_versions);
  if (std::ranges::find(readable_versions, version) == readable_versions.end())
    throw Error(fmt::format(
        "cannot read {} (format version {}, this program reads {} and {}); use the program that wrote it, or "
        "compute the rows anew",
        path, version, readable_versions.front(), format_version));
}

/// @throws Error if an open file is not one of our sweeps, or of a version that is not read
void require_sweep(hid_t file, const std::string& path) {
  const std::array<std::string_view, 1> kinds = {sweep_kind};
  const std::string kind = text_as_written(file, "kind", kinds);
  if (kind == trajectory_kind)
    throw Error("cannot read " + path +
                " (one run of clogrun, not a sweep); give a file written by clogsweep --output");
  if (kind != sweep_kind || H5Lexists(file, runs_name, H5P_DEFAULT) <= 0)
    throw Error("cannot read " + path +
                " (an HDF5 file, but not one of clogsweep's tables of runs); give a file written "
                "by clogsweep --output");
  require_readable_version(file, path);
}

[[noreturn]] void refuse_table(const std::string& path, const std::string& what) {
  throw Error(
      fmt::format("cannot read {} (damaged: {}); restore it from a copy, or start a new file", path, what));
}

/// How long a dataset is; a size that cannot be is not believed.
std::size_t size_of(hid_t dataset, std::size_t bytes_each, const std::string& path) {
  const Space space(H5Dget_space(dataset));
  hsize_t size = 0;
  if (H5Sget_simple_extent_ndims(space) != 1 || H5Sget_simple_extent_dims(space, &size, nullptr) != 1)
    refuse_table(path, "its table has another shape than it was given");
  constexpr hsize_t most_compressed = 1100;  // h5repack's zlib does not exceed 1032
  if (size / most_compressed > H5Dget_storage_size(dataset) / bytes_each)
    refuse_table(path, "its table cannot hold " + sweep::counted(static_cast<std::int64_t>(size), "row"));
  return size;
}

/// Checksums of ours say which rows are damaged, so the library is to give all it has.
PropertyList without_library_check() {
  PropertyList properties(H5Pcreate(H5P_DATASET_XFER));
  H5Pset_edc_check(properties, H5Z_DISABLE_EDC);
  return properties;
}

/// Rows as they lie in the file.
std::vector<std::byte> packed_rows(hid_t table, const RowLayout& layout, std::size_t num_rows,
                                   const std::string& path) {
  const PropertyList unchecked = without_library_check();
  std::vector<std::byte> packed(num_rows * layout.size());
  for_each_block(num_rows, [&](std::size_t first, std::size_t number) {
    if (H5Dread(table, layout.type(), space_of(number), select_rows(table, first, number), unchecked,
                packed.data() + first * layout.size()) < 0)
      refuse_table(path, fmt::format("rows from {} on cannot be read", first));
  });
  return packed;
}

CheckSums read_check_sums(hid_t file, std::size_t num_rows, const std::string& path) {
  const Dataset dataset(H5Lexists(file, sums_name, H5P_DEFAULT) > 0 ? H5Dopen2(file, sums_name, H5P_DEFAULT)
                                                                    : hid_t{-1});
  if (!dataset.valid()) refuse_table(path, "the rows' checksums are gone");
  const Type type(H5Dget_type(dataset));
  if (H5Tequal(type, H5T_NATIVE_UINT32) <= 0 || size_of(dataset, sizeof(std::uint32_t), path) != num_rows)
    refuse_table(path, "the rows' checksums are not those of its " +
                           sweep::counted(static_cast<std::int64_t>(num_rows), "row"));
  CheckSums sums(num_rows);
  if (num_rows > 0 &&
      H5Dread(dataset, H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, without_library_check(), sums.data()) < 0)
    refuse_table(path, "the rows' checksums cannot be read");
  return sums;
}

/// Rows of an open file, as they lie there.
struct PackedTable {
  RowLayout layout;
  std::vector<std::byte> bytes;
  std::size_t num_rows;

  std::span<const std::byte> row(std::size_t i) const {
    return std::span(bytes).subspan(i * layout.size(), layout.size());
  }
};

/// Zero if the attribute is missing, as in files of format 9, or damaged.
std::size_t num_columns_written(hid_t file) {
  const std::string text = read_attribute(file, num_columns_name);
  std::size_t number = 0;
  if (listed_check_sum(file, num_columns_name) == check_sum(text))
    std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

PackedTable read_table(hid_t file, const std::string& path) {
  const Dataset table(H5Dopen2(file, runs_name, H5P_DEFAULT));
  if (!table.valid()) refuse_table(path, "its table cannot be opened");
  std::optional<RowLayout> layout = RowLayout::of(Type(H5Dget_type(table)), num_columns_written(file));
  if (!layout) refuse_table(path, "its columns are not those that were written");
  const std::size_t num_rows = size_of(table, layout->size(), path);
  std::vector<std::byte> bytes = packed_rows(table, *layout, num_rows, path);
  return {std::move(*layout), std::move(bytes), num_rows};
}

/// Does the library refuse a dataset when it compares its own checksums, too?
bool is_refused(hid_t file, const char* name) {
  const Dataset dataset(H5Dopen2(file, name, H5P_DEFAULT));
  const Type type(H5Dget_type(dataset));
  std::vector<std::byte> bytes(
      static_cast<std::size_t>(H5Sget_simple_extent_npoints(Space(H5Dget_space(dataset)))) *
      H5Tget_size(type));
  return !bytes.empty() && H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0;
}

/// Separates intact rows from corrupted ones.
void compare_rows(const PackedTable& table, const CheckSums& sums, Examination& found) {
  for (std::size_t i = 0; i < table.num_rows; ++i) {
    const auto [row, fault] = table.layout.unpack(table.row(i).data());
    const bool is_as_written = check_sum(table.row(i)) == sums[i];
    if (is_as_written && fault.empty())
      found.whole.rows.push_back(row);
    else
      found.damage.push_back(fmt::format("row {} (task {}){}", i, row.task,
                                         is_as_written ? ": " + fault : " is not as it was written"));
  }
}

/// The rest of an attribute of which a part is damaged says nothing.
void drop_attribute(const std::string& part, Provenance& provenance) {
  const std::string name = part.substr(0, part.find('.'));
  std::erase_if(provenance,
                [&](const auto& one) { return one.first.substr(0, one.first.find('.')) == name; });
}

/// The same for attributes, and for the rows' checksums as a whole.
void compare_attributes(hid_t file, const CheckSums& sums, Examination& found) {
  const std::pair rows_line(name_of_rows(sums.size()), joint_check_sum(sums));
  bool has_rows_line = false;
  std::vector<std::string> damaged;
  std::istringstream lines(read_attribute(file, list_name));
  for (std::string line; std::getline(lines, line);) {
    const auto listed = check_sum_line(line);
    if (!listed) {
      found.damage.emplace_back("a line of its attribute checksums is not as it was written");
    } else if (*listed == rows_line) {
      has_rows_line = true;
    } else if (std::string text = read_attribute(file, listed->first); check_sum(text) == listed->second) {
      found.whole.provenance.emplace_back(listed->first, std::move(text));
    } else {
      found.damage.push_back("its attribute " + listed->first + " is not as it was written");
      damaged.push_back(listed->first);
    }
  }
  for (const std::string& name : damaged) drop_attribute(name, found.whole.provenance);
  if (!has_rows_line)
    found.damage.emplace_back("its table is not the one that was written: rows are missing, or exchanged");
}

Examination examine(std::vector<std::byte>& image, Seal seal, const std::string& path) {
  const File file = open_image(image, path);
  require_sweep(file, path);
  const PackedTable table = read_table(file, path);
  const CheckSums sums = read_check_sums(file, table.num_rows, path);
  Examination found;
  found.whole.checked = seal == Seal::missing ? Checked::rows_and_settings : Checked::everything;
  compare_rows(table, sums, found);
  compare_attributes(file, sums, found);
  read_circles(file, found.whole.circles, found.damage);
  read_laboratories(file, found.damage);
  if (seal != Seal::whole)
    found.is_refused_by_others = is_refused(file, runs_name) || is_refused(file, sums_name);
  join_parts(found.whole.provenance);
  adopt_laboratory_of_all(found.whole);
  for (const char* ours : {"kind", "format_version", num_columns_name})
    std::erase_if(found.whole.provenance, [&](const auto& attribute) { return attribute.first == ours; });
  if (seal == Seal::broken && found.damage.empty())
    found.damage.emplace_back(
        "some bytes are not those that were written, though all rows and attributes are");
  return found;
}

/// Returns the seal of the file, which can be read in this process then.
Seal try_unless_whole(std::vector<std::byte>& image, const std::string& path) {
  const Seal seal = look_at_seal(image);
  if (seal != Seal::whole) try_in_child(image, path, [&] { examine(image, seal, path); });
  return seal;
}

}  // namespace

Examination examine_sweep(const std::string& path) {
  std::vector<std::byte> image = read_file(path);
  const Seal seal = try_unless_whole(image, path);
  return examine(image, seal, path);
}

void try_before_mpi(const std::string& path) try {
  if (!std::filesystem::is_regular_file(path)) return;
  std::vector<std::byte> image = read_file(path);
  try_unless_whole(image, path);
} catch (const std::exception&) {
  // the reading itself throws it again
}

SweepFile read_sweep(const std::string& path) {
  Examination found = examine_sweep(path);
  if (found.damage.empty()) return std::move(found.whole);
  const std::size_t num_others = found.damage.size() - 1;
  throw Error(fmt::format(
      "cannot trust {} (damaged: {}{}); `clogsweep verify` names all, `clogsweep salvage` copies "
      "undamaged rows",
      path, found.damage.front(), num_others > 0 ? fmt::format(", and {} more", num_others) : ""));
}

std::string caution(const std::string& path, const SweepFile& file) {
  if (file.checked == Checked::everything) return "";
  return path +
         " was copied or changed by another program; its rows and settings are as clogsweep wrote them";
}

}  // namespace clog::store
