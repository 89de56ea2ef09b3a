#include "clog/store/output_path.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "clog/core/tools/error.hpp"
#include "file_io.hpp"
#include "seal.hpp"

namespace clog::store {

namespace fs = std::filesystem;

namespace {

std::string folder_of(const fs::path& path) {
  const fs::path folder = path.parent_path();
  return folder.empty() ? "." : folder.string();
}

/// As the kernel's fs.protected_symlinks: in a world-writable sticky folder only links of this user, or of
/// the folder's owner, are followed.
void refuse_link_of_others(const fs::path& link) {
  struct stat folder {
  }, there{};
  constexpr mode_t open_to_all = S_ISVTX | S_IWOTH;
  if (stat(folder_of(link).c_str(), &folder) != 0 || lstat(link.c_str(), &there) != 0) return;
  if ((folder.st_mode & open_to_all) != open_to_all) return;
  if (there.st_uid != geteuid() && there.st_uid != folder.st_uid)
    throw Error(
        "cannot follow the link " + link.string() +
        " (it belongs to another user, in a folder that everybody can write to); give the path itself");
}

/// The seal of a file of this size; empty if it has none or cannot be read. Closes the file.
std::string seal_at_end(int descriptor, off_t size) {
  if (descriptor < 0) return "";
  std::string end(std::min<std::size_t>(seal_size, static_cast<std::size_t>(size)), '\0');
  const ssize_t got = pread(descriptor, end.data(), end.size(), size - static_cast<off_t>(end.size()));
  close(descriptor);
  return got == static_cast<ssize_t>(seal_size) && has_seal_mark(end) ? end : "";
}

constexpr const char* access_list = "system.posix_acl_access";

/// Empty if it has none. Closes the file.
std::vector<char> access_list_of(int descriptor) {
  if (descriptor < 0) return {};
  std::vector<char> list(65536);  // the kernel has none that is longer
  const ssize_t size = fgetxattr(descriptor, access_list, list.data(), list.size());
  close(descriptor);
  list.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  return list;
}

std::string follow_links(const std::string& path) {
  constexpr int longest_chain = 40;  // as in the kernel
  fs::path target = path;
  std::error_code none;
  for (int links = 0; fs::is_symlink(target, none); ++links) {
    errno = ELOOP;
    check(links < longest_chain, "follow the link", path);
    refuse_link_of_others(target);
    target = target.parent_path() / fs::read_symlink(target, none);
  }
  return target.string();
}

}  // namespace

class OutputPath::Folder {
 public:
  explicit Folder(int descriptor) : descriptor_(descriptor) {}
  Folder(Folder&&) = delete;
  ~Folder() { close(descriptor_); }
  int descriptor() const { return descriptor_; }
  mutable std::string sync_fault;  // why it could not be synchronised

 private:
  int descriptor_;
};

OutputPath::OutputPath(const std::string& path) : path_(follow_links(path)) {
  name_ = fs::path(path_).filename().string();
  if (name_.empty() || name_ == "." || name_ == "..")
    throw Error("cannot use '" + path + "' (it names no file); give a name such as sweep.h5");
  const int descriptor = ::open(folder_of(path_).c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  check(descriptor >= 0, "create", path_);
  folder_ = std::make_shared<const Folder>(descriptor);
}

OutputPath OutputPath::beside(const std::string& ending) const {
  OutputPath other = *this;
  other.name_ += ending;
  other.path_ += ending;
  return other;
}

int OutputPath::open(int flags, mode_t mode) const {
  return openat(folder_->descriptor(), name_.c_str(), flags | O_NOFOLLOW | O_CLOEXEC, mode);
}

bool OutputPath::is_link() const {
  struct stat there {};
  return fstatat(folder_->descriptor(), name_.c_str(), &there, AT_SYMLINK_NOFOLLOW) == 0 &&
         S_ISLNK(there.st_mode);
}

bool OutputPath::exists() const {
  struct stat there {};
  return fstatat(folder_->descriptor(), name_.c_str(), &there, AT_SYMLINK_NOFOLLOW) == 0;
}

bool OutputPath::holds(int descriptor) const {
  struct stat ours {
  }, there{};
  return fstat(descriptor, &ours) == 0 &&
         fstatat(folder_->descriptor(), name_.c_str(), &there, AT_SYMLINK_NOFOLLOW) == 0 &&
         ours.st_ino == there.st_ino && ours.st_dev == there.st_dev;
}

bool OutputPath::remove() const {
  return unlinkat(folder_->descriptor(), name_.c_str(), 0) == 0 || errno == ENOENT;
}

bool OutputPath::take_from(const OutputPath& other) const {
  return renameat(other.folder_->descriptor(), other.name_.c_str(), folder_->descriptor(), name_.c_str()) ==
         0;
}

bool OutputPath::take_as_new_from(const OutputPath& other) const {
  const int folder = folder_->descriptor();
  if (renameat2(other.folder_->descriptor(), other.name_.c_str(), folder, name_.c_str(), RENAME_NOREPLACE) ==
      0)
    return true;
  if (errno != EINVAL && errno != ENOSYS) return false;  // a file system that cannot promise it
  if (exists()) {
    errno = EEXIST;
    return false;
  }
  return take_from(other);
}

bool OutputPath::exchange_with(const OutputPath& other) const {
  return renameat2(other.folder_->descriptor(), other.name_.c_str(), folder_->descriptor(), name_.c_str(),
                   RENAME_EXCHANGE) == 0;
}

bool OutputPath::replace(const std::string& stamp, const OutputPath& other) const {
  if (!exists()) return take_as_new_from(other);
  if (exchange_with(other)) {
    if (other.stamp() == stamp) {
      other.remove();
      return true;
    }
    exchange_with(other);
    errno = EEXIST;
    return false;
  }
  if (errno == ENOENT) return take_as_new_from(other);   // it was removed in this moment
  if (errno != EINVAL && errno != ENOSYS) return false;  // a file system that cannot exchange names
  if (this->stamp() == stamp) return take_from(other);
  errno = EEXIST;
  return false;
}

bool OutputPath::sync_folder() const {
  const int descriptor = openat(folder_->descriptor(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return errno == EACCES;                  // a folder that is writable but not readable
  const bool is_synced = sync(descriptor) || errno == EINVAL;  // some file systems cannot
  if (!is_synced) folder_->sync_fault = std::strerror(errno);
  close(descriptor);
  return is_synced;
}

const std::string& OutputPath::sync_fault() const { return folder_->sync_fault; }

bool OutputPath::lend_access_to(int descriptor) const {
  struct stat status {};
  if (fstatat(folder_->descriptor(), name_.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0 ||
      !S_ISREG(status.st_mode))
    return false;
  constexpr uid_t nobody = static_cast<uid_t>(-1);
  // A process that may not change the owner may still change the group to one of its own.
  const bool has_group =
      fchown(descriptor, status.st_uid, status.st_gid) == 0 || fchown(descriptor, nobody, status.st_gid) == 0;
  const std::vector<char> list = access_list_of(open(O_RDONLY | O_NONBLOCK));
  constexpr mode_t permissions = 0777;
  mode_t mode = status.st_mode & permissions;
  // A new group gets only the rights of others.
  if (!has_group) mode &= ~static_cast<mode_t>(S_IRWXG) | ((mode & S_IRWXO) << 3);
  fremovexattr(descriptor, access_list);  // the folder may have given it one
  fchmod(descriptor, mode);
  if (has_group && !list.empty()) fsetxattr(descriptor, access_list, list.data(), list.size(), 0);
  return true;
}

std::string OutputPath::stamp() const {
  struct stat there {};
  if (fstatat(folder_->descriptor(), name_.c_str(), &there, AT_SYMLINK_NOFOLLOW) != 0) return "";
  if (const std::string seal = seal_at_end(open(O_RDONLY | O_NONBLOCK), there.st_size); !seal.empty())
    return fmt::format("{} {}", there.st_size, seal);
  return fmt::format("{} {} {}", there.st_dev, there.st_ino, there.st_size);
}

}  // namespace clog::store
