#include "clog/store/output_path.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>
#include <vector>

#include "clog/core/tools/error.hpp"
#include "file_io.hpp"
#include "seal.hpp"

namespace clog::store {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const fs::path& path) {
  const fs::path folder = path.parent_path();
  return folder.empty() ? "." : folder.string();
}

/// Refuses links as the kernel does with fs.protected_symlinks. In a world-writable sticky folder, the kernel
/// follows only links of this user and of the folder's owner.
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

/// The seal of a file of this size; empty if the file has no seal or cannot be read.
std::string seal_at_end(const Descriptor& file, off_t size) {
  std::string end(std::min<std::size_t>(seal_size, static_cast<std::size_t>(size)), '\0');
  const ssize_t got = pread(file, end.data(), end.size(), size - static_cast<off_t>(end.size()));
  return got == static_cast<ssize_t>(seal_size) && has_seal_mark(end) ? end : "";
}

constexpr const char* access_list = "system.posix_acl_access";

/// Empty if the file has no access list.
std::vector<char> access_list_of(const Descriptor& file) {
  std::vector<char> list(65536);  // the kernel's limit
  const ssize_t size = fgetxattr(file, access_list, list.data(), list.size());
  list.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  return list;
}

std::string follow_links(const std::string& path) {
  constexpr int longest_chain = 40;  // as in the kernel
  fs::path target = path;
  std::error_code none;
  for (int links = 0; fs::is_symlink(target, none); ++links) {
    if (links == longest_chain)
      throw Error("cannot follow the link " + path + " (too many links, or a circle); give the path itself");
    refuse_link_of_others(target);
    target = target.parent_path() / fs::read_symlink(target, none);
  }
  return target.string();
}

/// Whether the file system does not support this method of renaming.
bool is_unsupported(std::error_code reason) {
  return reason == std::errc::invalid_argument || reason == std::errc::function_not_supported;
}

}  // namespace

std::string require_regular(std::string path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw Error(
        "cannot use " + path +
        " (not a regular file: a folder, pipe, device or socket); give another name, or move it away");
  return path;
}

OutputPath::OutputPath(std::shared_ptr<Folder> folder, std::string name, std::string path)
    : folder_(std::move(folder)), name_(std::move(name)), path_(std::move(path)) {}

OutputPath OutputPath::resolve(const std::string& path) {
  const std::string target = follow_links(path);
  const std::string name = fs::path(target).filename().string();
  if (name.empty() || name == "." || name == "..")
    throw Error("cannot use '" + path + "' (it names no file); give a name such as sweep.h5");
  Descriptor folder(::open(folder_of(target).c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!folder.is_open()) throw FileError(FileAction::create, target, last_error());
  return {std::make_shared<Folder>(Folder{std::move(folder), ""}), name, target};
}

OutputPath OutputPath::beside(const std::string& ending) const {
  return {folder_, name_ + ending, path_ + ending};
}

Descriptor OutputPath::open(int flags) const {
  return Descriptor(openat(folder_->descriptor, name_.c_str(), flags | O_NOFOLLOW | O_CLOEXEC));
}

Descriptor OutputPath::create(mode_t mode) const {
  constexpr int flags = O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  Descriptor file(openat(folder_->descriptor, name_.c_str(), flags, mode));
  if (!file.is_open())
    if (const std::error_code reason = last_error(); reason != std::errc::file_exists)
      throw FileError(FileAction::create, path_, reason);
  return file;
}

std::optional<struct stat> OutputPath::status() const {
  struct stat there {};
  if (fstatat(folder_->descriptor, name_.c_str(), &there, AT_SYMLINK_NOFOLLOW) != 0) return std::nullopt;
  return there;
}

bool OutputPath::is_link() const {
  const auto there = status();
  return there && S_ISLNK(there->st_mode);
}

bool OutputPath::holds(int descriptor, std::error_code* failure) const {
  struct stat ours {};
  const auto there = fstat(descriptor, &ours) == 0 ? status() : std::nullopt;
  if (!there && failure && errno != ENOENT) *failure = last_error();
  return there && ours.st_ino == there->st_ino && ours.st_dev == there->st_dev;
}

std::error_code OutputPath::remove() const {
  const bool is_gone = unlinkat(folder_->descriptor, name_.c_str(), 0) == 0 || errno == ENOENT;
  return is_gone ? std::error_code() : last_error();
}

std::error_code OutputPath::rename_to(const OutputPath& other, unsigned flags) const {
  const int result =
      renameat2(folder_->descriptor, name_.c_str(), other.folder_->descriptor, other.name_.c_str(), flags);
  return result == 0 ? std::error_code() : last_error();
}

std::error_code OutputPath::replace(const std::string& stamp, const OutputPath& other) const {
  const std::error_code occupied = make_error_code(std::errc::file_exists);
  if (!stamp.empty() && exists()) {
    const std::error_code reason = other.rename_to(*this, RENAME_EXCHANGE);
    if (!reason) {
      if (other.stamp() == stamp) {
        other.remove();
        return {};
      }
      other.rename_to(*this, RENAME_EXCHANGE);
      return occupied;
    }
    if (is_unsupported(reason)) return this->stamp() == stamp ? other.rename_to(*this, 0) : occupied;
    if (reason != std::errc::no_such_file_or_directory)
      return reason;  // if the file is missing, somebody has removed it; this is not an error
  }
  const std::error_code reason = other.rename_to(*this, RENAME_NOREPLACE);
  if (!is_unsupported(reason)) return reason;
  return exists() ? occupied : other.rename_to(*this, 0);
}

void OutputPath::sync_folder() const {
  const Descriptor folder(openat(folder_->descriptor, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  const std::error_code reason = folder.is_open() ? sync(folder) : last_error();
  // Folders may be writable but not readable. Some file systems cannot synchronise them.
  const std::errc harmless = folder.is_open() ? std::errc::invalid_argument : std::errc::permission_denied;
  if (reason && reason != harmless) folder_->sync_fault = reason.message();
}

void OutputPath::lend_access_to(int descriptor) const {
  const auto there = status();
  if (!there || !S_ISREG(there->st_mode)) return;
  constexpr uid_t nobody = static_cast<uid_t>(-1);
  // A process that may not change the owner may still change the group to another group of its user.
  const bool has_group =
      fchown(descriptor, there->st_uid, there->st_gid) == 0 || fchown(descriptor, nobody, there->st_gid) == 0;
  const std::vector<char> list = access_list_of(open(O_RDONLY | O_NONBLOCK));
  constexpr mode_t permissions = 0777;
  mode_t mode = there->st_mode & permissions;
  // If the group could not be changed, the present group gets only the rights of others.
  if (!has_group) mode &= ~static_cast<mode_t>(S_IRWXG) | ((mode & S_IRWXO) << 3);
  fremovexattr(descriptor, access_list);  // the folder may have set one
  fchmod(descriptor, mode);
  if (has_group && !list.empty()) fsetxattr(descriptor, access_list, list.data(), list.size(), 0);
}

std::string OutputPath::stamp() const {
  const auto there = status();
  if (!there) return "";
  if (const std::string seal = seal_at_end(open(O_RDONLY | O_NONBLOCK), there->st_size); !seal.empty())
    return fmt::format("{} {}", there->st_size, seal);
  return fmt::format("{} {} {}", there->st_dev, there->st_ino, there->st_size);
}

}  // namespace clog::store
