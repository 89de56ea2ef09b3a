#include "draft.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/store/run_table.hpp"
#include "file_io.hpp"

namespace clog::store {

namespace fs = std::filesystem;

namespace {

std::string draft_name(const std::string& path, int number) {
  return path + ".clogsweep-draft" + std::to_string(number);
}

/// Does it begin with the mark, as far as its maker came?
bool begins_with(int descriptor, std::string_view mark) {
  std::array<char, 64> bytes;
  const ssize_t size = pread(descriptor, bytes.data(), std::min(mark.size(), bytes.size()), 0);
  return size >= 0 && mark.starts_with(std::string_view(bytes.data(), static_cast<std::size_t>(size)));
}

void remove_if_stale(const std::string& name, std::string_view mark) {
  const int descriptor = open(name.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  if (begins_with(descriptor, mark) && flock(descriptor, LOCK_EX | LOCK_NB) == 0 && is_at(descriptor, name))
    unlink(name.c_str());
  close(descriptor);
}

}  // namespace

void remove_stale_drafts(const std::string& path, std::string_view mark) {
  std::error_code none;
  for (int number = 1; fs::exists(draft_name(path, number), none); ++number)
    remove_if_stale(draft_name(path, number), mark);
}

Draft::Draft(const std::string& path, std::string_view mark) : path_(follow_links(path)) {
  for (int number = 1;; ++number) {
    name_ = draft_name(path_, number);
    remove_if_stale(name_, mark);
    descriptor_ = open(name_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    check(descriptor_ >= 0 || errno == EEXIST, "create", path);
    if (descriptor_ < 0) continue;
    // Another process may have taken it for stale before it was locked. Where there are no locks, none does.
    const bool is_taken = flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!is_taken && is_at(descriptor_, name_)) return;
    close(descriptor_);
  }
}

Draft::~Draft() {
  if (!name_.empty()) unlink(name_.c_str());
  if (descriptor_ >= 0) close(descriptor_);
}

void Draft::write(std::span<const std::byte> bytes) {
  write_at(descriptor_, bytes, size_, path_);
  size_ += bytes.size();
}

void Draft::unlock() { flock(descriptor_, LOCK_UN); }

void Draft::publish() {
  check(fsync(descriptor_) == 0 && std::rename(name_.c_str(), path_.c_str()) == 0, "write", path_);
  name_.clear();
  check(sync_folder_of(path_), "write", path_);
}

void Draft::publish_new() {
  check(fsync(descriptor_) == 0, "write", path_);
  bool renamed = renameat2(AT_FDCWD, name_.c_str(), AT_FDCWD, path_.c_str(), RENAME_NOREPLACE) == 0;
  if (!renamed && (errno == EINVAL || errno == ENOSYS)) {  // a file system that cannot promise it
    refuse_existing(path_);
    renamed = std::rename(name_.c_str(), path_.c_str()) == 0;
  }
  if (!renamed && errno == EEXIST) refuse_existing(path_);
  check(renamed, "create", path_);
  name_.clear();
  check(sync_folder_of(path_), "write", path_);
}

int Draft::release() { return std::exchange(descriptor_, -1); }

}  // namespace clog::store
