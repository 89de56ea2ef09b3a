#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "clog/store/output_path.hpp"

/// Files that become visible only when they are complete. They are written under a temporary name, saved to
/// disk, then renamed.
namespace clog::store {

/// Removes the drafts of this path that killed processes left behind.
/// @param mark  beginning of every draft of this kind
void remove_stale_drafts(const OutputPath& place, std::string_view mark);

/// An incomplete file beside its target, under an unused name. It is locked until it is closed or unlock() is
/// called. An unlocked draft with the mark of clogsweep is left over from a killed process; the next process
/// that makes a draft removes it. Other files with the name of a draft stay.
class Draft {
 public:
  /// @param mark  see remove_stale_drafts(); written first @throws Error if no file can be made in the folder
  Draft(OutputPath place, std::string_view mark);
  Draft(Draft&&) = delete;
  /// Removes the draft, unless it has been published.
  ~Draft();

  int descriptor() const { return file_; }
  std::uint64_t size() const { return size_; }

  /// Appends to the draft. @throws Error
  void write(std::span<const std::byte> bytes);

  /// Call this before publishing a draft that others will read. HDF5 locks the files that it reads, and fails
  /// if another process has locked them.
  void unlock();
  /// Saves the draft to disk and renames it to the target. It replaces the file with this
  /// OutputPath::stamp(), and gets the mode, owner, group and access list of that file. Returns the stamp of
  /// the published file, even if somebody has replaced the file since. Returns nullopt if a file with another
  /// stamp is at the target; that file stays. @throws Error
  std::optional<std::string> publish(const std::string& stamp);
  /// The open file. The caller owns it after this call.
  Descriptor take_descriptor() { return std::move(file_); }

 private:
  OutputPath place_;
  OutputPath draft_;
  bool is_published_ = false;
  Descriptor file_;
  std::uint64_t size_ = 0;
};

}  // namespace clog::store
