#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "clog/store/output_path.hpp"
#include "clog/sweep/messages.hpp"

namespace clog::store {

class Draft;

/// Path of a table's journal, which is beside the table (for a link, beside the link's target).
std::string journal_path(const std::string& table);
OutputPath journal_place(const OutputPath& table);

/// The records of a sweep since its table was last published, appended to a file beside the table. A record
/// is a finished row, or the row of a running task with its snapshot. After add() has returned, the record
/// survives the death of the process. After flush() has returned, it also survives a crash of the machine. An
/// incomplete record at the end of the file is ignored. The records after a damaged record are still
/// readable.
///
/// An open journal is locked; the lock disappears when the process ends. If somebody removes or replaces the
/// file, the lock no longer protects the path. The journal then writes neither to the removed file nor to the
/// new file at the path. Closing a journal without records removes its file.
class Journal {
 public:
  using Entry = sweep::Report;
  struct Contents {
    std::vector<Entry> entries;       ///< records, the oldest first
    std::int64_t num_unreadable = 0;  ///< damaged records between readable ones
    /// Whether the last record is incomplete, because its writer died, or is still writing the record.
    bool has_torn_end = false;
    std::uint64_t num_bytes = 0;  ///< size of the file without an incomplete record at the end
  };

  /// Opens or makes the file. @throws Error if the file is open elsewhere, has another version, is another
  /// kind of file, or cannot be written.
  /// @param table  a new file gets the mode, owner, group and access list of this table
  explicit Journal(OutputPath place, const OutputPath* table = nullptr);
  Journal(Journal&&) = delete;
  ~Journal();

  /// Whether a sweep has the journal open.
  static bool is_open(const std::string& path);
  /// Reads the records without changing the file; nullopt if there is no file. @throws Error if the file
  /// cannot be read
  static std::optional<Contents> look(const std::string& path);

  const std::string& path() const { return place_.path(); }
  /// Whether the open file is still the file at its path.
  bool is_there() const { return place_.holds(file_); }
  /// Creates and locks an empty journal at the path of the removed journal. Returns false if another sweep
  /// has started there. @throws Error if the file cannot be written
  bool recreate(const OutputPath& table);

  /// The records that the file had when it was opened, oldest first.
  std::vector<Entry> take_entries() { return std::move(contents_.entries); }
  std::int64_t num_unreadable() const { return contents_.num_unreadable; }
  /// Appends a record. @throws Error if the disk is full, or if another file is at the path; flush() and
  /// rewrite() throw the same errors
  void add(const sweep::RunRow& row, std::span<const std::byte> snapshot);
  /// Saves the records to disk. Once begin() has returned, another thread may call this while the thread that
  /// owns the journal adds records.
  void flush();
  /// Prepares the file for writing: writes a missing header, and removes an incomplete record at the end. The
  /// first add() calls this, too.
  void begin();
  std::uint64_t num_bytes() const { return contents_.num_bytes; }
  /// Whether the file is larger than 64 MB, and more than twice as large as after its last rewrite.
  bool is_to_be_rewritten() const;
  /// Replaces the file by a file with only these entries.
  void rewrite(std::span<const Entry* const> entries);
  /// Prepares a file with these entries and with the records behind the first `begin` bytes. replace() then
  /// moves this file to the path. Another thread may call prepare(), under the same condition as flush().
  void prepare(std::span<const Entry* const> entries, std::uint64_t begin);
  bool is_prepared() const { return next_ != nullptr; }
  void replace();
  /// Removes the file, unless another file has taken its place at the path. Nothing may be added afterwards.
  /// Returns the reason if the removal failed.
  std::error_code remove();

 private:
  OutputPath place_;
  Descriptor file_;
  Contents contents_;  ///< contents at opening; num_bytes is kept up to date
  std::uint64_t num_rewritten_bytes_ = 0;
  bool has_begun_ = false;
  std::unique_ptr<Draft> next_;   ///< the file that will replace this file
  std::uint64_t num_copied_ = 0;  ///< bytes of this file that next_ already has or does not need
  std::atomic<std::uint64_t> num_whole_ =
      0;  ///< number of bytes of complete records; the thread that calls prepare() reads it

  std::uint64_t copy_additions();
  void open_and_lock(const OutputPath* table);
  void check_place() const;
  [[noreturn]] void refuse_replaced() const;
  void close() { file_ = Descriptor(); }
  /// Removes an empty file.
  void remove_if_empty();
};

}  // namespace clog::store
