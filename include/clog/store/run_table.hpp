#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "clog/sweep/run_row.hpp"

namespace clog::store {

/// Version of the file format; see src/store/README.md.
inline constexpr const char* format_version = "1";

/// Name and text of the attributes at the file's root: where its numbers come from.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// Version of the HDF5 library, e.g. "1.10.8".
std::string library_version();

/// @throws Error if the path exists: results are never overwritten
void refuse_existing(const std::string& path);
/// To be asked before hours of work. @throws Error if the path exists or no file can be made there
void refuse_unwritable(const std::string& path);

/// The table of runs of a sweep file. The file is only open while something is written: readers can come at
/// any moment, and a kill between two writes loses nothing.
class RunTable {
 public:
  /// Creates the file with an empty table. @throws Error if it exists or cannot be created
  static RunTable create(const std::string& path, const Provenance& provenance);

  /// Appends rows; they are on the disk when this returns. @throws Error
  void append(std::span<const sweep::RunRow> rows);
  void append(const sweep::RunRow& row) { append(std::span(&row, 1)); }

 private:
  explicit RunTable(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

struct SweepFile {
  std::vector<sweep::RunRow> rows;
  Provenance provenance;
};
/// @throws Error if the file is missing, not HDF5, or not ours
SweepFile read_sweep(const std::string& path);

}  // namespace clog::store
