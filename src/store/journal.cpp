#include "clog/store/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/crc.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "clog/core/error.hpp"

namespace clog::store {
namespace {

/// The beginning of the file: another layout of rows is another version.
struct FileHeader {
  char kind[16] = "clogsweep jrnl1";
  std::uint64_t row_size = sizeof(sweep::RunRow);
  bool operator==(const FileHeader&) const = default;
};
struct RecordHeader {
  std::uint64_t size;  ///< of the row and the snapshot
  std::uint32_t check;
  std::uint32_t magic;
};
constexpr std::uint32_t record_magic = 0x636c6f67;

std::uint32_t check_sum(std::span<const std::byte> row, std::span<const std::byte> snapshot) {
  boost::crc_32_type crc;
  crc.process_bytes(row.data(), row.size());
  crc.process_bytes(snapshot.data(), snapshot.size());
  return crc.checksum();
}

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

[[noreturn]] void fail(const char* what, const std::string& path) {
  throw Error(std::string("cannot ") + what + ' ' + path + " (" + std::strerror(errno) +
              "); check the disk and the permissions");
}

/// Whole or not at all.
void write_all(int descriptor, std::span<const std::byte> bytes, std::uint64_t place,
               const std::string& path) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t written =
        pwrite(descriptor, bytes.data() + done, bytes.size() - done, static_cast<off_t>(place + done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int reason = written < 0 ? errno : ENOSPC;
      if (ftruncate(descriptor, static_cast<off_t>(place)) != 0) errno = reason;
      errno = reason;
      fail("write", path);
    }
    done += static_cast<std::size_t>(written);
  }
}

/// Writes a record at a place of the file; returns where the next one goes.
std::uint64_t write_record(int descriptor, const sweep::RunRow& row, std::span<const std::byte> snapshot,
                           std::uint64_t place, const std::string& path) {
  struct {
    RecordHeader header;
    sweep::RunRow row;
  } record{{sizeof row + snapshot.size(), check_sum(bytes_of(row), snapshot), record_magic}, row};
  write_all(descriptor, bytes_of(record), place, path);
  write_all(descriptor, snapshot, place + sizeof record, path);
  return place + sizeof record + snapshot.size();
}

int open_file(const std::string& path, int flags) {
  const int descriptor = open(path.c_str(), flags | O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) fail("write", path);
  return descriptor;
}

/// Is this still the file that the path leads to? Somebody may have finished and removed it meanwhile.
bool is_at(int descriptor, const std::string& path) {
  struct stat ours {
  }, there{};
  return fstat(descriptor, &ours) == 0 && stat(path.c_str(), &there) == 0 && ours.st_ino == there.st_ino &&
         ours.st_dev == there.st_dev;
}

}  // namespace

Journal::Journal(std::string path) : path_(std::move(path)) {
  while (true) {
    descriptor_ = open_file(path_, 0);
    // Who asks whether it is open holds it for a moment.
    int locked = -1;
    for (int attempt = 0; attempt < 10; ++attempt) {
      locked = flock(descriptor_, LOCK_EX | LOCK_NB);
      if (locked == 0 || errno != EWOULDBLOCK) break;
      usleep(20'000);
    }
    if (locked != 0) {
      const bool taken = errno == EWOULDBLOCK;
      const int reason = errno;
      close(descriptor_);
      errno = reason;
      if (!taken) fail("lock", path_);
      throw Error("cannot continue with " + path_ +
                  " (another sweep is writing to it); wait for it to end, or give another --output");
    }
    if (is_at(descriptor_, path_)) break;
    close(descriptor_);
  }
  try {
    read_entries();
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

Journal::~Journal() {
  if (descriptor_ >= 0) close(descriptor_);
}

bool Journal::is_open(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool is_taken = flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return is_taken;
}

void Journal::read_entries() {
  struct stat status {};
  if (fstat(descriptor_, &status) != 0) fail("read", path_);
  std::vector<std::byte> bytes(static_cast<std::size_t>(status.st_size));
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got =
        pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (got <= 0) fail("read", path_);
    done += static_cast<std::size_t>(got);
  }
  std::size_t place = sizeof(FileHeader);
  if (bytes.size() < place) {  // new, or its maker died at once
    const FileHeader header;
    write_all(descriptor_, bytes_of(header), 0, path_);
  } else {
    FileHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    if (!(header == FileHeader()))
      throw Error(
          "cannot continue with " + path_ +
          " (not a journal of this version of clogsweep); finish with the version that began, or remove it "
          "and lose the runs under way");
  }
  RecordHeader header{};
  while (place + sizeof header <= bytes.size()) {
    std::memcpy(&header, bytes.data() + place, sizeof header);
    const std::size_t begin = place + sizeof header;
    if (header.magic != record_magic || header.size < sizeof(sweep::RunRow) ||
        header.size > bytes.size() - begin)
      break;
    const std::span payload(bytes.data() + begin, static_cast<std::size_t>(header.size));
    if (check_sum(payload, {}) != header.check) break;
    Entry entry;
    std::memcpy(&entry.row, payload.data(), sizeof entry.row);
    entry.snapshot.assign(payload.begin() + sizeof entry.row, payload.end());
    entries_.push_back(std::move(entry));
    place = begin + payload.size();
  }
  num_bytes_ = place;
  if (place < bytes.size() && ftruncate(descriptor_, static_cast<off_t>(place)) != 0) fail("write", path_);
}

void Journal::add(const sweep::RunRow& row, std::span<const std::byte> snapshot) {
  num_bytes_ = write_record(descriptor_, row, snapshot, num_bytes_, path_);
}

void Journal::flush() {
  if (fdatasync(descriptor_) != 0) fail("write", path_);
}

void Journal::rewrite(std::span<const Entry* const> entries) {
  const std::string draft = path_ + ".new";
  const int descriptor = open_file(draft, O_TRUNC);
  try {
    // Before it has its name, so that nobody can come between.
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) fail("lock", draft);
    const FileHeader header;
    std::uint64_t size = sizeof header;
    write_all(descriptor, bytes_of(header), 0, draft);
    for (const Entry* entry : entries)
      size = write_record(descriptor, entry->row, entry->snapshot, size, draft);
    if (fdatasync(descriptor) != 0 || std::rename(draft.c_str(), path_.c_str()) != 0) fail("write", draft);
    num_bytes_ = size;
  } catch (...) {
    close(descriptor);
    std::remove(draft.c_str());
    throw;
  }
  close(descriptor_);
  descriptor_ = descriptor;
}

void Journal::remove() {
  std::remove(path_.c_str());
  close(descriptor_);
  descriptor_ = -1;
}

}  // namespace clog::store
