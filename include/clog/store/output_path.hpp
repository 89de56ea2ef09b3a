#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

namespace clog::store {

/// The location of a file, which may not exist yet: its folder, held open, and its name in that folder.
/// Symbolic links are followed once, by the constructor; changing them or moving the folder later does not
/// redirect writes.
class OutputPath {
 public:
  /// @throws Error if the path names no file, its folder cannot be opened, or a link on the path is in a
  /// world-writable sticky folder and belongs neither to this user nor to the folder's owner
  OutputPath(const std::string& path);  // NOLINT(google-explicit-constructor): a path names a place
  /// The same folder, and the name with this ending. A link there is not followed.
  OutputPath beside(const std::string& ending) const;
  bool is_link() const;

  /// For messages and readers: links followed.
  const std::string& path() const { return path_; }
  /// The file there, never through a link. Below 0: see errno.
  int open(int flags, mode_t mode = 0666) const;
  bool exists() const;
  /// Is this open file still the one here? Somebody may have replaced or removed it meanwhile.
  bool holds(int descriptor) const;
  /// Returns whether nothing is there now; otherwise see errno.
  bool remove() const;
  /// Renames a file of the same folder to this name. Returns whether it succeeded; otherwise see errno.
  bool take_from(const OutputPath& other) const;
  /// The same, but never onto a file that is there.
  bool take_as_new_from(const OutputPath& other) const;
  /// The file of another name takes the place of the one with this stamp(), or of none if that was removed.
  /// Returns whether it did; if a different file is here, both stay as they are, and errno is EEXIST. Where
  /// the file system can exchange two names at once, a file that comes here in the last moment is kept, too.
  bool replace(const std::string& stamp, const OutputPath& other) const;
  /// Synchronises the folder to disk, so that renames survive a power cut. Returns whether it succeeded.
  bool sync_folder() const;
  /// Why the last failed sync_folder() of this place, its copies and those beside() it failed; empty: none
  /// has.
  const std::string& sync_fault() const;
  /// Copies mode, owner, group and access list of the file here to an open file, as far as permitted. Returns
  /// whether there is a file here.
  bool lend_access_to(int descriptor) const;
  /// The file's identity: size and seal, or, of a file without a seal, device, inode and size. It differs
  /// from that of any other file moved here and does not depend on mode and times; some network file systems
  /// change the inode. Empty if there is no file.
  std::string stamp() const;

 private:
  bool exchange_with(const OutputPath& other) const;
  class Folder;
  std::shared_ptr<const Folder> folder_;
  std::string name_;
  std::string path_;
};

}  // namespace clog::store
