#include "draft.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/store/run_table.hpp"
#include "file_io.hpp"

namespace clog::store {

namespace {

OutputPath draft_place(const OutputPath& place, int number) {
  return place.beside(".clogsweep-draft" + std::to_string(number));
}

/// Does it begin with the mark, as far as its maker came?
bool begins_with(int descriptor, std::string_view mark) {
  std::array<char, 64> bytes;
  const ssize_t size = pread(descriptor, bytes.data(), std::min(mark.size(), bytes.size()), 0);
  return size >= 0 && mark.starts_with(std::string_view(bytes.data(), static_cast<std::size_t>(size)));
}

void remove_if_stale(const OutputPath& place, std::string_view mark) {
  const int descriptor = place.open(O_RDWR | O_NONBLOCK);
  if (descriptor < 0) return;
  if (begins_with(descriptor, mark) && flock(descriptor, LOCK_EX | LOCK_NB) == 0 && place.holds(descriptor))
    place.remove();
  close(descriptor);
}

}  // namespace

void remove_stale_drafts(const OutputPath& place, std::string_view mark) {
  for (int number = 1; draft_place(place, number).exists(); ++number)
    remove_if_stale(draft_place(place, number), mark);
}

Draft::Draft(OutputPath place, std::string_view mark) : place_(std::move(place)), draft_(place_) {
  const mode_t mode = place_.exists() ? 0600 : 0666;  // nobody reads it before it has its place's access
  for (int number = 1;; ++number) {
    draft_ = draft_place(place_, number);
    remove_if_stale(draft_, mark);
    descriptor_ = draft_.open(O_RDWR | O_CREAT | O_EXCL, mode);
    check(descriptor_ >= 0 || errno == EEXIST, "create", place_.path());
    if (descriptor_ < 0) continue;
    // Another process may have taken it for stale before it was locked. Where there are no locks, none does.
    const bool is_taken = flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!is_taken && draft_.holds(descriptor_)) return;
    close(descriptor_);
  }
}

Draft::~Draft() {
  if (!is_published_) draft_.remove();
  if (descriptor_ >= 0) close(descriptor_);
}

void Draft::write(std::span<const std::byte> bytes) {
  write_at(descriptor_, bytes, size_, place_.path());
  size_ += bytes.size();
}

void Draft::unlock() { flock(descriptor_, LOCK_UN); }

bool Draft::publish() {
  place_.lend_access_to(descriptor_);
  check(sync(descriptor_) && place_.take_from(draft_), "write", place_.path());
  is_published_ = true;
  return place_.sync_folder();
}

std::optional<std::string> Draft::publish_over(const std::string& stamp) {
  place_.lend_access_to(descriptor_);
  check(sync(descriptor_), "write", place_.path());
  std::string published = draft_.stamp();
  is_published_ = place_.replace(stamp, draft_);
  if (!is_published_ && errno == EEXIST) return std::nullopt;
  check(is_published_, "write", place_.path());
  place_.sync_folder();
  return published;
}

void Draft::publish_new() {
  check(sync(descriptor_), "write", place_.path());
  const bool is_renamed = place_.take_as_new_from(draft_);
  if (!is_renamed && errno == EEXIST) refuse_existing(place_.path());
  check(is_renamed, "create", place_.path());
  is_published_ = true;
  place_.sync_folder();
}

int Draft::release() { return std::exchange(descriptor_, -1); }

}  // namespace clog::store
