#include "file_io.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "clog/core/tools/error.hpp"

namespace clog::store {

namespace fs = std::filesystem;

namespace {

/// The folder that a file is to be made in; empty if it is there.
std::string missing_folder(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  std::error_code none;
  return folder.empty() || fs::exists(folder, none) ? "" : folder.string();
}

}  // namespace

void check(bool succeeded, const std::string& what, const std::string& path) {
  if (succeeded) return;
  if (errno == ENOENT && (what == "create" || what == "write"))
    if (const std::string folder = missing_folder(path); !folder.empty())
      throw Error("cannot " + what + " " + path + " (no folder " + folder + "); make it first");
  const std::string reason = errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : "";
  throw Error("cannot " + what + " " + path + reason + "; check the disk and the permissions");
}

bool sync(int descriptor) {
  while (fsync(descriptor) != 0)
    if (errno != EINTR) return false;  // a signal is no fault of the disk
  return true;
}

/// As the user has set the variable: prepare_library() changes it.
static const bool are_locks_optional = [] {
  const char* use = std::getenv("HDF5_USE_FILE_LOCKING");
  return use && std::string_view(use) == "FALSE";
}();

bool try_lock(int descriptor, const std::string& path) {
  if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return true;
  if (errno == EWOULDBLOCK) return false;
  if (are_locks_optional) return true;
  throw Error("cannot lock " + path + " (" + std::strerror(errno) +
              "); use a folder whose file system has locks (flock), or, if no other sweep writes to this "
              "file, set HDF5_USE_FILE_LOCKING=FALSE");
}

void read_at(int descriptor, std::span<std::byte> bytes, std::uint64_t place, const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t got = pread(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (got < 0 && errno == EINTR) continue;
    if (got == 0) errno = EIO;  // somebody has shortened it meanwhile
    check(got > 0, "read", path);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    place += static_cast<std::uint64_t>(got);
  }
}

void write_at(int descriptor, std::span<const std::byte> bytes, std::uint64_t place,
              const std::string& path) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t written =
        pwrite(descriptor, bytes.data() + done, bytes.size() - done, static_cast<off_t>(place + done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int reason = written < 0 ? errno : ENOSPC;
      const bool is_cut = ftruncate(descriptor, static_cast<off_t>(place)) == 0;
      errno = is_cut ? reason : errno;
      check(false, "write", path);
    }
    done += static_cast<std::size_t>(written);
  }
}

}  // namespace clog::store
