#include "trial_process.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <system_error>

#include "clog/console/signals.hpp"

namespace clog::campaign {
namespace {

using Clock = std::chrono::steady_clock;

std::system_error fault(const char* what) { return {errno, std::generic_category(), what}; }

/// The end of a pipe.
class PipeEnd {
 public:
  explicit PipeEnd(int descriptor) : descriptor_(descriptor) {}
  PipeEnd(PipeEnd&&) = delete;
  ~PipeEnd() { close(); }
  int descriptor() const { return descriptor_; }
  void close() {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
  }

 private:
  int descriptor_;
};

/// Waits for so long. Returns whether there is something to read, or the other end is gone.
bool is_readable(int descriptor, std::chrono::milliseconds time) {
  pollfd asked{.fd = descriptor, .events = POLLIN, .revents = 0};
  return ::poll(&asked, 1, static_cast<int>(time.count())) > 0;
}

void write_all(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return;  // nobody waits for it any more
    if (written > 0) bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

/// Reads until the other end is closed, or the time is over.
std::vector<std::byte> read_until(Clock::time_point end, int descriptor) {
  constexpr std::chrono::milliseconds between_looks{50};
  std::vector<std::byte> bytes;
  std::array<std::byte, 65536> piece;
  while (Clock::now() < end && !console::stop_signalled()) {
    if (!is_readable(descriptor, between_looks)) continue;
    const ssize_t size = ::read(descriptor, piece.data(), piece.size());
    if (size == 0) break;
    if (size > 0) bytes.insert(bytes.end(), piece.begin(), piece.begin() + size);
    if (size < 0 && errno != EINTR) break;
  }
  return bytes;
}

}  // namespace

std::vector<Record> told_within(double seconds, std::size_t record_size,
                                const std::function<void(const Tell&)>& work) {
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  int ends[2];
  if (::pipe(ends) != 0) throw fault("cannot make a pipe");
  PipeEnd from(ends[0]), to(ends[1]);
  const pid_t child = ::fork();
  if (child < 0) throw fault("cannot start a process");
  if (child == 0) {
    std::signal(SIGPIPE, SIG_IGN);
    try {
      work([&](std::span<const std::byte> record) { write_all(to.descriptor(), record); });
    } catch (const std::exception&) {
      _exit(EXIT_FAILURE);  // what it has told stands
    }
    _exit(EXIT_SUCCESS);  // without what the other process has to do at its own end
  }
  to.close();
  const std::vector<std::byte> bytes = read_until(end, from.descriptor());
  ::kill(child, SIGKILL);
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  std::vector<Record> records;
  for (std::size_t begin = 0; begin + record_size <= bytes.size(); begin += record_size) {
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(begin);
    records.emplace_back(first, first + static_cast<std::ptrdiff_t>(record_size));
  }
  return records;
}

}  // namespace clog::campaign
