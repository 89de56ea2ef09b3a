#include "trial_read.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>
#include <optional>

#include "check_sum.hpp"
#include "clog/core/tools/descriptor.hpp"
#include "clog/core/tools/error.hpp"

namespace clog::store {
namespace {

/// Limit of CPU time [s]. The limit is far above the time of a read, so only an endless loop exceeds it.
rlim_t time_limit(std::size_t num_bytes) {
  constexpr std::size_t least = 10, bytes_per_second = 50'000'000;
  return least + num_bytes / bytes_per_second;
}

[[noreturn]] void read_and_leave(std::size_t num_bytes, const std::function<void()>& read) {
  const rlimit no_core{0, 0};
  const rlim_t seconds = time_limit(num_bytes);
  const rlimit time{seconds, seconds};
  setrlimit(RLIMIT_CORE, &no_core);
  setrlimit(RLIMIT_CPU, &time);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL, SIGXCPU}) std::signal(signal, SIG_DFL);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDERR_FILENO);  // discards the last message of the library if it crashes
  try {
    read();
  } catch (const std::exception&) {
    // the actual read throws the error again
  }
  _exit(0);
}

/// Reads the file in a child process. Returns how that process crashed; empty if it did not crash.
std::string death_of_child(std::size_t num_bytes, const std::string& path,
                           const std::function<void()>& read) {
  const pid_t process = fork();
  if (process == 0) read_and_leave(num_bytes, read);
  int status = 0;
  if (process < 0 || retried([&] { return waitpid(process, &status, 0); }) < 0)
    throw Error("cannot read " + path + " (no process could be started for it: " + std::strerror(errno) +
                "); end other programs, or raise the limit on processes (ulimit -u)");
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  return WIFSIGNALED(status) ? std::string("ends with ") + strsignal(WTERMSIG(status)) : "fails";
}

struct Trial {
  std::uint32_t check_sum;
  std::size_t num_bytes;
  std::string death;
};

}  // namespace

void try_in_child(std::span<const std::byte> image, const std::string& path,
                  const std::function<void()>& read) {
  static std::optional<Trial> last;
  const std::uint32_t sum = check_sum(image);
  if (!last || last->check_sum != sum || last->num_bytes != image.size())
    last = Trial{sum, image.size(), death_of_child(image.size(), path, read)};
  if (!last->death.empty())
    throw Error("cannot read " + path + " (damaged: reading it " + last->death +
                "); restore it from a copy, or start a new file");
}

}  // namespace clog::store
