#include "file_io.hpp"

#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "clog/core/tools/descriptor.hpp"

namespace clog::store {
namespace {

namespace fs = std::filesystem;

std::string file_fault(FileAction action, const std::string& path, std::error_code reason) {
  constexpr std::array words = {"create", "write", "read"};
  const std::string what = std::string("cannot ") + words[static_cast<std::size_t>(action)] + " " + path;
  const fs::path folder = fs::path(path).parent_path();
  std::error_code none;
  const bool is_written = action == FileAction::create || action == FileAction::write;
  if (is_written && reason == std::errc::no_such_file_or_directory && !folder.empty() &&
      !fs::exists(folder, none))
    return what + " (no folder " + folder.string() + "); make it first";
  if (reason == std::errc::filename_too_long)
    return what + " (" + reason.message() +
           "; while it is written, other files have its name with up to 20 more letters); give a shorter "
           "name";
  return what + " (" + reason.message() + "); check the disk and the permissions";
}

}  // namespace

FileError::FileError(FileAction action, const std::string& path, std::error_code reason)
    : Error(file_fault(action, path, reason)) {}

std::error_code sync(int descriptor) {
  return retried([&] { return fsync(descriptor); }) == 0 ? std::error_code() : last_error();
}

bool try_lock(int descriptor, const std::string& path) {
  if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return true;
  const std::error_code reason = last_error();
  if (reason == std::errc::operation_would_block) return false;
  const char* const use = std::getenv("HDF5_USE_FILE_LOCKING");
  if (use && std::string_view(use) == "FALSE") return true;
  throw Error("cannot lock " + path + " (" + reason.message() +
              "); use a folder whose file system has locks (flock), or, if no other sweep writes to this "
              "file, set HDF5_USE_FILE_LOCKING=FALSE");
}

std::size_t size_of(int descriptor, const std::string& path) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0) throw FileError(FileAction::read, path, last_error());
  return static_cast<std::size_t>(status.st_size);
}

std::vector<std::byte> read_all(int descriptor, const std::string& path) {
  return read_at(descriptor, 0, size_of(descriptor, path), path);
}

std::vector<std::byte> read_at(int descriptor, std::uint64_t place, std::size_t size,
                               const std::string& path) {
  std::vector<std::byte> bytes(size);
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = retried([&] {
      return pread(descriptor, bytes.data() + done, bytes.size() - done, static_cast<off_t>(place + done));
    });
    if (got < 0) throw FileError(FileAction::read, path, last_error());
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

void write_at(int descriptor, std::span<const std::byte> bytes, std::uint64_t place,
              const std::string& path) {
  for (std::uint64_t next = place; !bytes.empty();) {
    const ssize_t written =
        retried([&] { return pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(next)); });
    if (written <= 0) {
      const std::error_code reason =
          written < 0 ? last_error() : make_error_code(std::errc::no_space_on_device);
      const bool is_cut = ftruncate(descriptor, static_cast<off_t>(place)) == 0;
      throw FileError(FileAction::write, path, is_cut ? reason : last_error());
    }
    next += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

}  // namespace clog::store
