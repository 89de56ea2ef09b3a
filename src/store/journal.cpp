#include "clog/store/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

#include "check_sum.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/columns.hpp"
#include "draft.hpp"
#include "file_io.hpp"

namespace clog::store {
namespace {

/// Checksum of the names and sizes of all columns, in their order.
std::uint32_t check_sum_of_columns() {
  std::string list;
  for (const sweep::Column& column : sweep::columns())
    list += column.name + ' ' + std::to_string(column.size) + '\n';
  return check_sum(list);
}

/// The header of the file. If the columns differ, the journal is of another version.
struct FileHeader {
  char kind[16] = "clogsweep jrnl2";
  std::uint64_t columns = check_sum_of_columns();
  bool operator==(const FileHeader&) const = default;
};
struct RecordHeader {
  std::uint64_t size;  ///< size of the row and the snapshot
  std::uint32_t check;
  std::uint32_t magic;
};
constexpr std::string_view journal_mark = "clogsweep jrnl";  // the beginning of a journal of any version
constexpr std::uint32_t record_magic = 0x636c6f67;

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

std::vector<std::byte> record_of(const sweep::RunRow& row, std::span<const std::byte> snapshot) {
  const std::vector<std::byte> report = sweep::to_bytes({row, {snapshot.begin(), snapshot.end()}});
  std::vector<std::byte> record(sizeof(RecordHeader) + report.size());
  const RecordHeader header{report.size(), check_sum(report), record_magic};
  std::ranges::copy(report, record.begin() + sizeof header);
  std::ranges::copy(bytes_of(header), record.begin());
  return record;
}

/// Whether the header is complete. The header is missing or incomplete if the writer died when it began the
/// journal.
bool has_header(std::span<const std::byte> bytes, const std::string& path) {
  const FileHeader header;
  const std::size_t size = std::min(bytes.size(), sizeof header);
  if (!std::ranges::equal(bytes.first(size), bytes_of(header).first(size)))
    throw Error("cannot read " + path +
                " (not a journal of this version of clogsweep); give another --output, finish with the "
                "version that started the sweep, or move it away together with any finished runs in it");
  return size == sizeof header;
}

/// Header of the record at this place; nullopt if there is no valid header.
std::optional<RecordHeader> header_at(std::span<const std::byte> bytes, std::size_t place) {
  RecordHeader header;
  if (bytes.size() - place < sizeof header) return std::nullopt;
  std::memcpy(&header, bytes.data() + place, sizeof header);
  if (header.magic != record_magic || header.size < sweep::packed_size()) return std::nullopt;
  return header;
}

Journal::Contents parse(std::span<const std::byte> bytes) {
  Journal::Contents contents;
  std::size_t end = std::min(sizeof(FileHeader), bytes.size());  // end of the last readable record
  std::int64_t num_passed = 0;  // number of headers of damaged records after `end`
  for (std::size_t place = end; place < bytes.size();) {
    const std::optional<RecordHeader> header = header_at(bytes, place);
    const std::size_t begin = place + sizeof(RecordHeader);
    const bool is_whole = header && header->size <= bytes.size() - begin &&
                          check_sum(bytes.subspan(begin, header->size)) == header->check;
    if (!is_whole) {
      if (header) ++num_passed;
      ++place;  // the search continues byte by byte, because the size in the header may be damaged
      continue;
    }
    if (place > end) contents.num_unreadable += std::max<std::int64_t>(1, num_passed);
    try {
      contents.entries.push_back(sweep::report_from(bytes.subspan(begin, header->size)));
    } catch (const Error&) {
      ++contents.num_unreadable;
    }
    place = end = begin + header->size;
    num_passed = 0;
  }
  contents.num_bytes = end;
  contents.has_torn_end = end < bytes.size();
  return contents;
}

}  // namespace

std::string journal_path(const std::string& table) {
  return journal_place(OutputPath::resolve(table)).path();
}

OutputPath journal_place(const OutputPath& table) {
  OutputPath journal = table.beside(".journal");
  return journal.is_link() ? OutputPath::resolve(journal.path()) : journal;
}

std::optional<Journal::Contents> Journal::look(const std::string& path) {
  const Descriptor file(open(require_regular(path).c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open() && errno == ENOENT) return std::nullopt;
  if (!file.is_open()) throw FileError(FileAction::read, path, last_error());
  const std::vector<std::byte> bytes = read_all(file, path);
  has_header(bytes, path);
  return parse(bytes);
}

Journal::Journal(OutputPath place, const OutputPath* table) : place_(std::move(place)) {
  require_regular(place_.path());
  try {
    open_and_lock(table);
    remove_stale_drafts(place_, journal_mark);
    const std::vector<std::byte> bytes = read_all(file_, place_.path());
    if (has_header(bytes, place_.path())) contents_ = parse(bytes);
    if (bytes.empty()) begin();  // so that a full disk is reported before hours of work
  } catch (...) {
    remove_if_empty();
    throw;
  }
}

Journal::~Journal() { remove_if_empty(); }

void Journal::open_and_lock(const OutputPath* table) {
  // Locking is tried several times, because another process may hold the lock briefly in is_open(), and the
  // file may be removed before we lock it.
  constexpr int most_attempts = 10;
  bool is_busy = false;
  std::error_code reason;
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    if (attempt > 0) usleep(20'000);
    // A user who may not read the table must not be able to read its journal.
    file_ = place_.create(table && table->exists() ? 0600 : 0666);
    if (file_.is_open() && table) table->lend_access_to(file_);
    if (!file_.is_open()) file_ = place_.open(O_RDWR);
    if (!file_.is_open() && errno == ENOENT) continue;
    if (!file_.is_open()) throw FileError(FileAction::write, place_.path(), last_error());
    is_busy = !try_lock(file_, place_.path());
    if (!is_busy && place_.holds(file_, &reason)) return;
    close();
  }
  if (is_busy)
    throw Error("cannot use " + place_.path() +
                " (another sweep is writing to it); wait for it to end, or give another --output");
  throw Error("cannot use " + place_.path() + " (" +
              (reason ? "its state cannot be read: " + reason.message()
                      : "it is removed or replaced again and again") +
              "); check the file system, or give another --output");
}

/// Prepares the file for writing: writes a missing header, and cuts off an incomplete record at the end. A
/// file with records is prepared only at the first write, so that a sweep that refuses the records leaves the
/// file unchanged.
void Journal::begin() {
  if (has_begun_) return;
  if (contents_.num_bytes < sizeof(FileHeader)) {
    write_at(file_, bytes_of(FileHeader()), 0, place_.path());
    contents_.num_bytes = sizeof(FileHeader);
    check(sync(file_), FileAction::write, place_.path());
    place_.sync_folder();  // the next publication of the table in this folder reports a failure
  }
  if (ftruncate(file_, static_cast<off_t>(contents_.num_bytes)) != 0)
    throw FileError(FileAction::write, place_.path(), last_error());
  has_begun_ = true;
}

bool Journal::is_open(const std::string& path) {
  const Descriptor file(open(require_regular(path).c_str(), O_RDONLY | O_CLOEXEC));
  return file.is_open() && flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

void Journal::check_place() const {
  if (!is_there()) refuse_replaced();
}

void Journal::refuse_replaced() const {
  throw Error("cannot continue with " + place_.path() +
              " (it was removed or replaced while the sweep was running, and another may have begun there); "
              "when no other sweep is writing to it, the same command resumes the sweep");
}

bool Journal::recreate(const OutputPath& table) {
  close();
  file_ = place_.create(table.exists() ? 0600 : 0666);
  if (!file_.is_open()) return false;
  table.lend_access_to(file_);
  if (!try_lock(file_, place_.path()) || !is_there()) {
    close();
    return false;
  }
  contents_.num_bytes = num_rewritten_bytes_ = 0;
  num_whole_ = 0;
  has_begun_ = false;
  return true;
}

void Journal::add(const sweep::RunRow& row, std::span<const std::byte> snapshot) {
  check_place();
  begin();
  const std::vector<std::byte> record = record_of(row, snapshot);
  write_at(file_, record, contents_.num_bytes, place_.path());
  contents_.num_bytes += record.size();
  num_whole_ = contents_.num_bytes;
}

void Journal::flush() {
  check_place();
  begin();
  check(sync(file_), FileAction::write, place_.path());
}

bool Journal::is_to_be_rewritten() const {
  constexpr std::uint64_t small = 64'000'000;
  return contents_.num_bytes > std::max(small, 2 * num_rewritten_bytes_);
}

void Journal::rewrite(std::span<const Entry* const> entries) {
  prepare(entries, contents_.num_bytes);
  replace();
}

void Journal::prepare(std::span<const Entry* const> entries, std::uint64_t begin) {
  check_place();
  next_ = std::make_unique<Draft>(place_, journal_mark);
  // This draft becomes the journal when it is renamed, so it must be locked before that.
  if (!try_lock(next_->descriptor(), place_.path())) refuse_replaced();
  next_->write(bytes_of(FileHeader()));
  for (const Entry* entry : entries) next_->write(record_of(entry->row, entry->snapshot));
  num_copied_ = begin;
  constexpr std::size_t little = 4'000'000;  // replace() copies so few bytes in negligible time
  do check(sync(next_->descriptor()), FileAction::write, place_.path());
  while (copy_additions() > little);
}

/// Returns the number of copied bytes. Does not copy a record that is still being written, because the writer
/// removes it again if the disk is full.
std::uint64_t Journal::copy_additions() {
  constexpr std::uint64_t block = 1'000'000;
  const std::uint64_t before = num_copied_;
  const std::uint64_t end = std::max(before, num_whole_.load());
  while (num_copied_ < end) {
    const std::vector<std::byte> bytes =
        read_at(file_, num_copied_, std::min(block, end - num_copied_), place_.path());
    if (bytes.empty()) break;
    next_->write(bytes);
    num_copied_ += bytes.size();
  }
  return num_copied_ - before;
}

void Journal::replace() {
  check_place();
  copy_additions();
  // A failure to synchronise the folder is reported when the table in this folder is published.
  if (!next_->publish(place_.stamp())) refuse_replaced();
  file_ = next_->take_descriptor();
  contents_.num_bytes = num_rewritten_bytes_ = next_->size();
  num_whole_ = contents_.num_bytes;
  has_begun_ = true;
  next_.reset();
}

std::error_code Journal::remove() {
  const std::error_code reason = is_there() ? place_.remove() : std::error_code();
  place_.sync_folder();  // a power cut may restore the removed file; this is harmless, because the table
                         // contains all results
  close();
  return reason;
}

void Journal::remove_if_empty() {
  if (!file_.is_open()) return;
  const off_t size = lseek(file_, 0, SEEK_END);
  const bool is_empty = size >= 0 && contents_.num_bytes <= sizeof(FileHeader) &&
                        static_cast<std::uint64_t>(size) <= contents_.num_bytes;
  if (is_empty) remove();
}

}  // namespace clog::store
