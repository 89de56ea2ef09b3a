#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "clog/store/output_path.hpp"
#include "clog/sweep/run_row.hpp"

namespace clog::store {

/// Version of the file format; see docs/reference/files.md.
inline constexpr const char* format_version = "11";
/// Version of files that also have a table of droplets. The version differs, so that older programs refuse
/// these files instead of ignoring the table.
inline constexpr const char* format_version_with_droplets = "12";

/// Names and texts of the attributes at the file's root, which describe the origin of the file's numbers.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// Version of the HDF5 library, e.g. "1.10.8".
std::string library_version();

/// @throws Error if the path exists: results are never overwritten
void refuse_existing(const std::string& path);
[[noreturn]] void refuse_to_overwrite(const std::string& path);
/// Call this before hours of work. @throws Error if the path exists or no file can be made there
void refuse_unwritable(const std::string& path);

/// User-supplied circles, and the name of the file of circles. The name is empty if the sweep's last command
/// does not name the file.
struct CircleFile {
  std::string name;
  OwnCircles circles;
};

/// The part of a file that has been compared with checksums.
enum class Checked {
  everything,         ///< every bit of the file
  rows_and_settings,  ///< each row and each attribute, because another program has copied or changed the file
};

struct SweepFile {
  std::vector<sweep::RunRow> rows;
  Provenance provenance;
  std::vector<CircleFile> circles;  ///< the circles that the rows refer to
  Checked checked = Checked::everything;
  /// Objects and attributes that other programs have added. A file that replaces this one will not contain
  /// them.
  std::vector<std::string> foreign = {};
};

/// The rows of a file to be written. The writer requests each row once, in the order of `i`, so the rows need
/// not be in one array.
struct Rows {
  std::size_t number;
  std::function<sweep::RunRow(std::size_t i)> row;

  /// Rows in one array, which must outlive this object.
  static Rows of(std::span<const sweep::RunRow> rows) {
    return {rows.size(), [rows](std::size_t i) { return rows[i]; }};
  }
};

/// Writes a sweep's file in place of the file with this OutputPath::stamp(). At every moment the path names a
/// complete table, either the old or the new one, so readers may read it at any time. When this function
/// returns, the new table is on the disk. Returns the stamp of the written file, even if somebody has
/// replaced the file since. Returns nullopt if a file with another stamp is at the path; that file stays.
/// @throws Error if the file cannot be written; then the old file stays
std::optional<std::string> publish_sweep(const OutputPath& place, const std::string& stamp, const Rows& rows,
                                         const Provenance& provenance,
                                         const std::vector<CircleFile>& circles);
inline std::optional<std::string> publish_sweep(const OutputPath& place, const std::string& stamp,
                                                const SweepFile& content) {
  return publish_sweep(place, stamp, Rows::of(content.rows), content.provenance, content.circles);
}

/// Reads a file of format version 9 to 12. Missing columns get the value Parameter::before, or are unknown.
/// @throws Error if the file is missing, damaged, not HDF5, not written by clogsweep, or of another format
/// version
SweepFile read_sweep(const std::string& path);
/// If a file has no valid seal, tries to read it in a child process. A later read_sweep() of the same bytes
/// then need not fork. This matters because a process that has called MPI_Init must not fork. Throws nothing:
/// read_sweep() will report any error.
void try_before_mpi(const std::string& path);
/// A warning for readers of this file; empty if the whole file was verified.
std::string caution(const std::string& path, const SweepFile& file);

/// Call this before the file is replaced. @throws Error if it has foreign objects, which would be lost
void refuse_foreign_objects(const std::string& path, const SweepFile& file);

/// A file that may be damaged: the intact rows and attributes, and a list of the damage.
struct Examination {
  SweepFile whole;
  std::vector<std::string> damage;  ///< a sentence about each damaged part
  /// Whether one of HDF5's own checksums does not match. Then h5py and other readers refuse the file.
  bool is_refused_by_others = false;
};
/// @throws Error if the file is missing, not written by clogsweep, or completely unreadable
Examination examine_sweep(const std::string& path);

}  // namespace clog::store
