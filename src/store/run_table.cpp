#include "clog/store/run_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>

#include "attributes.hpp"
#include "check_sum.hpp"
#include "circle_files.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/wording.hpp"
#include "droplets.hpp"
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
constexpr std::size_t rows_per_block = 1024;  // number of rows that are copied at a time

using CheckSums = std::vector<std::uint32_t>;  // checksums of the rows

/// Calls visit() with the first row and the number of rows of each block.
template <class Visit>
void for_each_block(std::size_t num_rows, Visit visit) {
  for (std::size_t first = 0; first < num_rows; first += rows_per_block)
    visit(first, std::min(rows_per_block, num_rows - first));
}

/// Selects rows of the table that are read or written together.
Space select_rows(hid_t table, std::size_t first, std::size_t number) {
  Space space(H5Dget_space(table));
  const hsize_t start = first, count = number;
  H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, nullptr, &count, nullptr);
  return space;
}

/// A list of unlimited length, for programs that append.
Space growing_space(std::size_t num_rows) {
  const hsize_t size = num_rows, unlimited = H5S_UNLIMITED;
  return Space(H5Screate_simple(1, &size, &unlimited));
}

/// Writes the table.
/// @param laboratories  receives the checksums of all laboratories of the rows
/// @param families  receives the families of the rows
CheckSums write_table(hid_t file, const Rows& rows, std::set<std::string>& laboratories,
                      std::vector<StoredFamily>& families) {
  const RowLayout layout = RowLayout::present();
  const Dataset table = write_dataset(file, runs_name, layout.type(), growing_space(rows.number), nullptr,
                                      checked_chunks(rows_per_chunk));
  layout.describe(table);
  CheckSums sums;
  sums.reserve(rows.number);
  std::vector<std::byte> packed(std::min(rows_per_block, rows.number) * layout.size());
  for_each_block(rows.number, [&](std::size_t first, std::size_t number) {
    for (std::size_t i = 0; i < number; ++i) {
      const RunRow row = rows.row(first + i);
      const std::span place(packed.data() + i * layout.size(), layout.size());
      sweep::pack(row, place);
      sums.push_back(check_sum(place));
      if (const std::optional<LaboratoryText>& one = row.parameters.laboratory; one && !one->text().empty())
        laboratories.insert(one->check_sum());
      if (!row.family.empty()) families.push_back({row.task, row.family});
    }
    if (H5Dwrite(table, layout.type(), space_of({number}), select_rows(table, first, number), H5P_DEFAULT,
                 packed.data()) < 0)
      throw LibraryError("write the table of runs");
  });
  return sums;
}

/// Attribute with the number of written columns. Both a damaged table and a table of an older program may
/// lack columns; this number distinguishes them.
constexpr const char* num_columns_name = "num_columns";

/// The entry for all rows together in the list of checksums.
NamedCheckSum joint_check_sum(const CheckSums& sums) {
  return {fmt::format("{} rows", sums.size()), check_sum(std::as_bytes(std::span(sums)))};
}

}  // namespace

void write_runs(hid_t file, const std::string& kind, const Rows& rows, const Provenance& provenance) {
  std::set<std::string> laboratories;
  std::vector<StoredFamily> families;
  const CheckSums sums = write_table(file, rows, laboratories, families);
  const Dataset list = write_dataset(file, sums_name, H5T_NATIVE_UINT32, growing_space(sums.size()),
                                     sums.data(), checked_chunks(rows_per_chunk));
  write_attribute(list, "meaning", "CRC-32, as of zlib, of the bytes of each row of /runs");
  Provenance attributes = {
      {"kind", kind},
      {"format_version", families.empty() ? format_version : format_version_with_droplets},
      {num_columns_name, std::to_string(sweep::columns().size())}};
  attributes.insert(attributes.end(), provenance.begin(), provenance.end());
  write_attributes(file, joint_check_sum(sums), attributes);
  write_laboratories(file, laboratories);
  write_droplets(file, families);
}

std::string library_version() {
  prepare_library();
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

std::optional<std::string> publish_sweep(const OutputPath& place, const std::string& stamp, const Rows& rows,
                                         const Provenance& provenance,
                                         const std::vector<CircleFile>& circles) {
  require_memory_of_file("write " + place.path(), rows.number * RowLayout::present().size());
  return write_whole(place, stamp, [&](hid_t file) {
    write_runs(file, sweep_kind, rows, provenance);
    write_circles(file, circles);
  });
}

namespace {

constexpr std::array<std::string_view, 4> readable_versions = {"9", "10", format_version,
                                                               format_version_with_droplets};

/// @throws Error if this program does not read the format version of the open file
void require_readable_version(hid_t file, const std::string& path) {
  const std::string version = text_as_written(file, "format_version", readable_versions);
  if (std::ranges::find(readable_versions, version) == readable_versions.end())
    throw Error(fmt::format(
        "cannot read {} (format version {}, this program reads {} to {}); use the program that wrote it, or "
        "compute the rows anew",
        path, version, readable_versions.front(), readable_versions.back()));
}

/// @throws Error if an open file is not a sweep of clogsweep, or has a version that this program does not
/// read
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

/// The reason why a table is unreadable.
class Damage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::string rows_text(std::size_t number) { return count_text(static_cast<std::int64_t>(number), "row"); }

/// Length of a dataset. @throws Damage if the size is impossible
std::size_t num_rows_of(hid_t dataset, std::size_t bytes_each) {
  const std::optional<hsize_t> number = length_of(dataset);
  if (!number) throw Damage("its table has another shape than it was given");
  if (!can_hold(dataset, *number, bytes_each)) throw Damage("its table cannot hold " + rows_text(*number));
  return *number;
}

CheckSums read_check_sums(hid_t file, std::size_t num_rows) {
  const Dataset dataset(H5Lexists(file, sums_name, H5P_DEFAULT) > 0 ? H5Dopen2(file, sums_name, H5P_DEFAULT)
                                                                    : hid_t{-1});
  if (!dataset.valid()) throw Damage("the rows' checksums are gone");
  const Type type(H5Dget_type(dataset));
  if (H5Tequal(type, H5T_NATIVE_UINT32) <= 0 || num_rows_of(dataset, sizeof(std::uint32_t)) != num_rows)
    throw Damage("the rows' checksums are not those of its " + rows_text(num_rows));
  CheckSums sums(num_rows);
  if (num_rows > 0 &&
      H5Dread(dataset, H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, without_library_check(), sums.data()) < 0)
    throw Damage("the rows' checksums cannot be read");
  return sums;
}

/// Number of columns according to the writer's attribute. Zero if the attribute is damaged or, as in files of
/// format 9, missing.
std::size_t num_columns_written(hid_t file) {
  const std::string text = intact_text(file, num_columns_name);
  std::size_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

/// Separates intact rows from corrupted ones, and returns the checksums that were written.
CheckSums read_rows(hid_t file, Examination& found) {
  const Dataset dataset(H5Dopen2(file, runs_name, H5P_DEFAULT));
  if (!dataset.valid()) throw Damage("its table cannot be opened");
  const std::optional<RowLayout> layout =
      RowLayout::of(Type(H5Dget_type(dataset)), num_columns_written(file));
  if (!layout) throw Damage("its columns are not those that were written");
  const std::size_t num_rows = num_rows_of(dataset, layout->size());
  CheckSums sums = read_check_sums(file, num_rows);
  found.whole.rows.reserve(num_rows);
  std::vector<std::byte> block(std::min(rows_per_block, num_rows) * layout->size());
  const PropertyList unchecked = without_library_check();
  for_each_block(num_rows, [&](std::size_t first, std::size_t number) {
    if (H5Dread(dataset, layout->type(), space_of({number}), select_rows(dataset, first, number), unchecked,
                block.data()) < 0)
      throw Damage(fmt::format("rows from {} on cannot be read", first));
    for (std::size_t i = 0; i < number; ++i) {
      const std::span packed(block.data() + i * layout->size(), layout->size());
      auto [row, fault] = layout->unpack(packed.data());
      const bool is_as_written = check_sum(packed) == sums[first + i];
      if (is_as_written && fault.empty())
        found.whole.rows.push_back(std::move(row));
      else
        found.damage.push_back(fmt::format("row {} (task {}){}", first + i, row.task,
                                           is_as_written ? ": " + fault : " is not as it was written"));
    }
  });
  return sums;
}

/// Whether the library refuses a dataset when it compares its own checksums.
bool is_refused(hid_t file, const char* name) {
  if (H5Lexists(file, name, H5P_DEFAULT) <= 0) return false;
  const Dataset dataset(H5Dopen2(file, name, H5P_DEFAULT));
  const Type type(H5Dget_type(dataset));
  const std::size_t length = length_of(dataset).value_or(0);
  std::vector<std::byte> block(std::min(rows_per_block, length) * H5Tget_size(type));
  bool refused = false;
  for_each_block(length, [&](std::size_t first, std::size_t number) {
    refused = refused || H5Dread(dataset, type, space_of({number}), select_rows(dataset, first, number),
                                 H5P_DEFAULT, block.data()) < 0;
  });
  return refused;
}

/// Adds the attributes of an object that are not in `known`. An entry is, for example, "attribute note of
/// /runs".
void add_attributes(hid_t object, const std::string& name, const std::set<std::string>& known,
                    std::vector<std::string>& foreign) {
  for (const std::string& attribute : attributes_of(object))
    if (!known.contains(attribute)) foreign.push_back(fmt::format("attribute {} of {}", attribute, name));
}

/// Objects and attributes that other programs have added. Excludes objects in the groups of circles and
/// laboratories, which count as damage.
std::vector<std::string> foreign_objects(hid_t file) {
  const std::set<std::string> known = {runs_name,         sums_name,     circles_name,
                                       laboratories_name, droplets_name, droplet_sums_name};
  std::vector<std::string> foreign;
  for (const std::string& name : names_in(file))
    if (!known.contains(name)) foreign.push_back('/' + name);
  for (const std::string& name : unlisted_attributes(file))
    foreign.push_back(fmt::format("attribute {} of /", name));
  const Dataset runs(H5Dopen2(file, runs_name, H5P_DEFAULT)), sums(H5Dopen2(file, sums_name, H5P_DEFAULT));
  const Type row(H5Dget_type(runs));
  std::set<std::string> columns;
  for (int i = 0; i < H5Tget_nmembers(row); ++i) columns.insert(member_name(row, static_cast<unsigned>(i)));
  add_attributes(runs, "/runs", columns, foreign);
  add_attributes(sums, "/row_checksums", {"meaning"}, foreign);
  for (const char* name : {circles_name, laboratories_name})
    if (H5Lexists(file, name, H5P_DEFAULT) > 0)
      add_attributes(Group(H5Gopen2(file, name, H5P_DEFAULT)), std::string("/") + name, {}, foreign);
  return foreign;
}

Examination examine(std::vector<std::byte>& image, Seal seal, const std::string& path) try {
  const File file = open_image(image, path);
  require_sweep(file, path);
  Examination found;
  found.whole.checked = seal == Seal::missing ? Checked::rows_and_settings : Checked::everything;
  const CheckSums sums = read_rows(file, found);
  compare_attributes(file, joint_check_sum(sums), found.whole.provenance, found.damage);
  read_circles(file, found.whole.circles, found.damage);
  read_droplets(file, found.whole.rows, found.damage);
  read_laboratories(file, found.damage);
  if (seal != Seal::whole)
    found.is_refused_by_others =
        std::ranges::any_of(std::array{runs_name, sums_name, droplets_name, droplet_sums_name},
                            [&](const char* name) { return is_refused(file, name); });
  adopt_laboratory_of_all(found.whole);
  if (seal != Seal::whole) found.whole.foreign = foreign_objects(file);
  for (const char* ours : {"kind", "format_version", num_columns_name})
    std::erase_if(found.whole.provenance, [&](const auto& attribute) { return attribute.first == ours; });
  if (seal == Seal::broken && found.damage.empty())
    found.damage.emplace_back(
        "some bytes are not those that were written, though all rows and attributes are");
  return found;
} catch (const Damage& damage) {
  throw Error(fmt::format("cannot read {} (damaged: {}); restore it from a copy, or start a new file", path,
                          damage.what()));
}

/// Returns the seal of the file. If the seal is broken or missing, first tries to read the file in a child
/// process. If the child process succeeds, this process can read the file safely.
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
  // the actual read throws the error again
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

namespace {

/// The text as one word of a shell.
std::string shell_word(const std::string& text) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-";
  if (text.find_first_not_of(plain) == std::string::npos) return text;
  std::string word = "'";
  for (const char letter : text) word += letter == '\'' ? "'\\''" : std::string(1, letter);
  return word + "'";
}

/// The command that copies the first of these objects into another file. Empty if all of them are attributes,
/// because HDF5 has no command that copies attributes.
std::string copying_command(const std::string& path, const std::vector<std::string>& foreign) {
  const auto object = std::ranges::find_if(foreign, [](const auto& name) { return name.starts_with('/'); });
  if (object == foreign.end()) return "";
  return fmt::format("copy each object out by h5copy -i {0} -o MINE.h5 -s {1} -d {1}, ", shell_word(path),
                     shell_word(*object));
}

}  // namespace

void refuse_foreign_objects(const std::string& path, const SweepFile& file) {
  if (file.foreign.empty()) return;
  constexpr std::size_t most_named = 5;
  std::vector<std::string> named = file.foreign;
  const std::size_t num_others = named.size() - std::min(named.size(), most_named);
  named.resize(named.size() - num_others);
  throw Error(fmt::format(
      "cannot resume {0} (it has objects of another program, which would be lost: {1}{2}); "
      "{3}copy the sweep without them by clogsweep salvage {4} --output NEW.h5, and resume NEW.h5",
      path, joined(named), num_others > 0 ? fmt::format(", and {} more", num_others) : "",
      copying_command(path, file.foreign), shell_word(path)));
}

std::string caution(const std::string& path, const SweepFile& file) {
  if (file.checked == Checked::everything) return "";
  return path +
         " was copied or changed by another program; its rows and settings are as clogsweep wrote them";
}

}  // namespace clog::store
