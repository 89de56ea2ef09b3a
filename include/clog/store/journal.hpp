#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "clog/store/place.hpp"
#include "clog/sweep/messages.hpp"

namespace clog::store {

/// The journal of the table at this path lies beside it (if the path is a link, beside what it leads to).
std::string journal_path(const std::string& table);
Place journal_place(const Place& table);

/// What must not be lost between two publications of a sweep's table: rows, and snapshots of runs that go on,
/// one after the other in a file beside the table. What add() returned from survives the death of the
/// process, what flush() returned from that of the machine. When the file is opened again, a torn record at
/// the end is dropped, and one that is damaged costs no other. While a journal is open nobody else can open
/// it; the lock dies with its process. A file that somebody has removed or replaced meanwhile locks nobody
/// out any more: then nothing is written, neither here nor over what another has made. A journal without
/// records is removed when it is closed.
class Journal {
 public:
  using Entry = sweep::Report;
  struct Contents {
    std::vector<Entry> entries;       ///< oldest first
    std::int64_t num_unreadable = 0;  ///< damaged records between readable ones
    bool has_torn_end = false;        ///< its writer died within a record; or is still at it
    std::uint64_t num_bytes = 0;      ///< without a torn end
  };

  /// Opens or makes the file. @throws Error if it is open elsewhere, of another version, something else, or
  /// cannot be written. @param table  whose mode, owner, group and access list a new one gets
  explicit Journal(Place place, const Place* table = nullptr);
  Journal(Journal&&) = delete;
  ~Journal();

  /// Is a sweep writing to this one?
  static bool is_open(const std::string& path);
  /// What is in the file, which stays as it is; nothing if there is none. @throws Error if it cannot be read
  static std::optional<Contents> look(const std::string& path);

  const std::string& path() const { return place_.path(); }
  /// Is the open file still the one at its place?
  bool is_there() const { return place_.holds(descriptor_); }
  /// Makes and locks an empty one in the place of one that was removed. Returns whether that could be done:
  /// another sweep may have begun there. @throws Error if it cannot be written
  bool make_anew(const Place& table);

  /// What the file held when it was opened, oldest first.
  std::vector<Entry> take_entries() { return std::move(contents_.entries); }
  std::int64_t num_unreadable() const { return contents_.num_unreadable; }
  /// @throws Error if the disk is full, or the file is no longer the one at the path; so do flush() and
  /// rewrite()
  void add(const sweep::RunRow& row, std::span<const std::byte> snapshot);
  void flush();
  std::uint64_t num_bytes() const { return contents_.num_bytes; }
  /// Is it large, and twice as long as it was after it was rewritten last?
  bool is_to_be_rewritten() const;
  /// Replaces the file by one that holds these entries only.
  void rewrite(std::span<const Entry* const> entries);
  /// Removes the file, unless it is no longer the one at the path; nothing may be added afterwards.
  void remove();

 private:
  Place place_;
  int descriptor_ = -1;
  Contents contents_;  ///< when it was opened, but its size is that of now
  std::uint64_t num_rewritten_bytes_ = 0;
  bool has_begun_ = false;

  void open_and_lock(const Place* table);
  void begin();
  void check_place() const;
  void close_file();
};

}  // namespace clog::store
