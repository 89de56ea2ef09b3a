#pragma once

#include <sys/stat.h>

#include <memory>
#include <optional>
#include <string>
#include <system_error>

#include "clog/core/tools/descriptor.hpp"

namespace clog::store {

/// Checks that a path leads to a regular file, or to no file yet, and returns the path. Links are followed.
/// Tables, trajectories and journals must be regular files: opening a pipe would wait, and only regular files
/// can be locked, read at any place and replaced in one step.
/// @throws Error if the path leads to something else
std::string require_regular(std::string path);

/// The location of a file, which may not exist yet. The object keeps the file's folder open, and stores the
/// file's name in that folder. Symbolic links are followed once, by resolve(). So a later change of the
/// links, or a move of the folder, does not redirect writes.
class OutputPath {
 public:
  /// Follows links and opens the folder.
  /// @throws Error if the path names no file, its folder cannot be opened, or a link on the path is in a
  /// world-writable sticky folder and belongs neither to this user nor to the folder's owner
  static OutputPath resolve(const std::string& path);
  /// The file in the same folder whose name is the name of this file plus an ending. Does not follow a link
  /// with this name.
  OutputPath beside(const std::string& ending) const;
  bool is_link() const;

  /// The path with links followed, for messages and readers.
  const std::string& path() const { return path_; }
  /// Opens the file, but never through a link. If this fails, the descriptor is not open, and errno has the
  /// reason.
  Descriptor open(int flags) const;
  /// Creates a file for reading and writing. The descriptor is not open if something with this name exists
  /// already. @throws Error
  Descriptor create(mode_t mode) const;
  bool exists() const { return status().has_value(); }
  /// Whether this open file is still the file at this path; somebody may have replaced or removed the file at
  /// the path.
  /// @param failure  if given, receives the reason if the answer is unknown
  bool holds(int descriptor, std::error_code* failure = nullptr) const;
  /// Removes the file, if there is one. Returns the reason if the removal failed.
  std::error_code remove() const;
  /// Renames the file at `other`, in the same folder, to this name. Replaces a file of this name only if the
  /// file has this stamp(); an empty stamp means that there must be no file. Returns the reason if the
  /// renaming failed: `file_exists` if a file with a different stamp has this name; then both files stay. If
  /// the file system can exchange two names in one step, even a file that appears at the last moment stays.
  std::error_code replace(const std::string& stamp, const OutputPath& other) const;
  /// Synchronises the folder to disk, so that renames survive a power cut.
  void sync_folder() const;
  /// The reason of the last failure of sync_folder(), for this object, its copies, or the results of
  /// beside(); empty if it has not failed.
  const std::string& sync_fault() const { return folder_->sync_fault; }
  /// Gives an open file the mode, owner, group and access list of the file at this path, as far as permitted.
  /// Does nothing if there is no file at this path.
  void lend_access_to(int descriptor) const;
  /// Identifies the file by its size and seal or, without a seal, by device, inode and size. The stamp
  /// changes if another file is moved here. It does not depend on mode and times. On some network file
  /// systems the inode of a file may change; this changes the stamp of a file without a seal. Empty if there
  /// is no file.
  std::string stamp() const;

 private:
  struct Folder {
    Descriptor descriptor;
    std::string sync_fault;
  };
  std::shared_ptr<Folder> folder_;
  std::string name_;
  std::string path_;

  OutputPath(std::shared_ptr<Folder> folder, std::string name, std::string path);
  /// Empty, with errno set, if the status cannot be read.
  std::optional<struct stat> status() const;
  std::error_code rename_to(const OutputPath& other, unsigned flags) const;
};

}  // namespace clog::store
