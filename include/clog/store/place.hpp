#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

namespace clog::store {

/// Where a file is, or is to be: its folder, held open, and its name in there. Links are followed once, when
/// the place is named; whoever re-points them later, or moves the folder, does not move what is written to
/// it.
class Place {
 public:
  /// @throws Error if the path has no name of a file, its folder cannot be opened, or a link on the way to it
  /// was made by somebody else in a folder in which everybody may make some
  Place(const std::string& path);  // NOLINT(google-explicit-constructor): a path names a place
  /// The same folder, and the name with this ending. A link there is not followed.
  Place beside(const std::string& ending) const;
  bool is_link() const;

  /// For messages and readers: links followed.
  const std::string& path() const { return path_; }
  /// The file there, never through a link. Below 0: see errno.
  int open(int flags, mode_t mode = 0666) const;
  bool exists() const;
  /// Is this open file still the one here? Somebody may have replaced or removed it meanwhile.
  bool holds(int descriptor) const;
  void remove() const;
  /// Gives a file of the same folder this name. Returns whether that succeeded; otherwise see errno.
  bool take_from(const Place& other) const;
  /// The same, but never onto a file that is there.
  bool take_as_new_from(const Place& other) const;
  /// Brings to the disk what the folder's files are called. Returns whether that succeeded.
  bool sync_folder() const;
  /// An open file gets mode, owner, group and access list of the one here, as far as its maker may. Returns
  /// whether there is one.
  bool lend_access_to(int descriptor) const;
  /// What tells the file here from any other that is moved to its place, whatever happens to its mode and
  /// times; empty if there is none.
  std::string stamp() const;

 private:
  class Folder;
  std::shared_ptr<const Folder> folder_;
  std::string name_;
  std::string path_;
};

}  // namespace clog::store
