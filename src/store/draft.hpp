#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "clog/store/output_path.hpp"

/// Files that come to be as a whole: made under a name of their own, brought to the disk, then renamed.
namespace clog::store {

/// Removes the drafts of this place that killed processes left behind.
/// @param mark  with which the content of every draft of this kind begins
void remove_stale_drafts(const OutputPath& place, std::string_view mark);

/// A file that is not yet complete, beside the place that it is for, under a name that nobody
/// has. It is locked as long as it is open, or until unlock(); one that is not, and begins as ours do, was
/// left behind by a process that was killed, and is removed by the next that makes one. Other files of such a
/// name stay.
class Draft {
 public:
  /// @param mark  see remove_stale_drafts(); to be written first
  /// @throws Error if no file can be made there
  Draft(OutputPath place, std::string_view mark);
  Draft(Draft&&) = delete;
  /// Removes it, unless it has been published.
  ~Draft();

  int descriptor() const { return file_; }
  std::uint64_t size() const { return size_; }

  /// Appends to what it holds. @throws Error
  void write(std::span<const std::byte> bytes);

  /// To be called before it is published, if others are to read it from then on: HDF5 locks the files that it
  /// reads, and fails where somebody else has.
  void unlock();
  /// Saves it to disk and gives it the place's name, where it replaces the file with this
  /// OutputPath::stamp(), if that is still there: the file hands on its mode, owner, group and access list.
  /// Returns the stamp of what was published, which somebody may have replaced meanwhile; nothing if a
  /// different file is there, which stays. @throws Error
  std::optional<std::string> publish(const std::string& stamp);
  /// The open file, which is the caller's from now on.
  Descriptor take_descriptor() { return std::move(file_); }

 private:
  OutputPath place_;
  OutputPath draft_;
  bool is_published_ = false;
  Descriptor file_;
  std::uint64_t size_ = 0;
};

}  // namespace clog::store
