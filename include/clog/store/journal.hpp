#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "clog/sweep/run_row.hpp"

namespace clog::store {

/// What must not be lost between two publications of a sweep's table: rows, and snapshots of runs that go on,
/// one after the other in a file beside the table. What add() returned from survives the death of the
/// process, what flush() returned from that of the machine; a torn record at the end is dropped when the file
/// is opened again. While a journal is open nobody else can open it; the lock dies with its process.
class Journal {
 public:
  struct Entry {
    sweep::RunRow row;
    std::vector<std::byte> snapshot;
  };

  /// Opens or makes the file. @throws Error if it is open elsewhere, of another version, or cannot be written
  explicit Journal(std::string path);
  Journal(Journal&&) = delete;
  ~Journal();

  /// Is a sweep writing to this one?
  static bool is_open(const std::string& path);

  /// What the file held when it was opened, oldest first.
  std::vector<Entry> take_entries() { return std::move(entries_); }
  /// @throws Error if the disk is full
  void add(const sweep::RunRow& row, std::span<const std::byte> snapshot);
  void flush();
  std::uint64_t num_bytes() const { return num_bytes_; }
  /// Replaces the file by one that holds these entries only.
  void rewrite(std::span<const Entry* const> entries);
  /// Removes the file; nothing may be added afterwards.
  void remove();

 private:
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t num_bytes_ = 0;
  std::vector<Entry> entries_;

  void read_entries();
};

}  // namespace clog::store
