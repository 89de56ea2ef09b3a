#include "draft.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "file_io.hpp"

namespace clog::store {

namespace {

OutputPath draft_place(const OutputPath& place, int number) {
  return place.beside(".clogsweep-draft" + std::to_string(number));
}

/// Whether the file begins with the mark. A file that is shorter than the mark must be a beginning of the
/// mark.
bool begins_with(int descriptor, std::string_view mark) {
  std::array<char, 64> bytes;
  const ssize_t size = pread(descriptor, bytes.data(), std::min(mark.size(), bytes.size()), 0);
  return size >= 0 && mark.starts_with(std::string_view(bytes.data(), static_cast<std::size_t>(size)));
}

void remove_if_stale(const OutputPath& place, std::string_view mark) {
  const Descriptor file = place.open(O_RDWR | O_NONBLOCK);
  if (file.is_open() && begins_with(file, mark) && flock(file, LOCK_EX | LOCK_NB) == 0 && place.holds(file))
    place.remove();
}

}  // namespace

void remove_stale_drafts(const OutputPath& place, std::string_view mark) {
  for (int number = 1; draft_place(place, number).exists(); ++number)
    remove_if_stale(draft_place(place, number), mark);
}

Draft::Draft(OutputPath place, std::string_view mark) : place_(std::move(place)), draft_(place_) {
  const mode_t mode = place_.exists()
                          ? 0600
                          : 0666;  // nobody may read the draft before it has the access rights of the target
  for (int number = 1;; ++number) {
    draft_ = draft_place(place_, number);
    remove_if_stale(draft_, mark);
    file_ = draft_.create(mode);
    if (!file_.is_open()) continue;
    // Before the draft was locked, another process may have taken it for a stale draft and removed it. If the
    // file system has no locks, no process removes drafts.
    const bool is_taken = flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!is_taken && draft_.holds(file_)) return;
  }
}

Draft::~Draft() {
  if (!is_published_) draft_.remove();
}

void Draft::write(std::span<const std::byte> bytes) {
  write_at(file_, bytes, size_, place_.path());
  size_ += bytes.size();
}

void Draft::unlock() { flock(file_, LOCK_UN); }

std::optional<std::string> Draft::publish(const std::string& stamp) {
  place_.lend_access_to(file_);
  check(sync(file_), FileAction::write, place_.path());
  std::string published = draft_.stamp();
  const std::error_code reason = place_.replace(stamp, draft_);
  if (reason == std::errc::file_exists) return std::nullopt;
  check(reason, FileAction::write, place_.path());
  is_published_ = true;
  place_.sync_folder();
  return published;
}

}  // namespace clog::store
