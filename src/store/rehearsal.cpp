#include "rehearsal.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <filesystem>

#include "clog/core/tools/error.hpp"
#include "file_io.hpp"

namespace clog::store {
namespace {

/// Far more than reading takes [s of CPU time]; a loop never ends.
rlim_t patience(const std::string& path) {
  constexpr std::uintmax_t least = 10, bytes_per_second = 50'000'000;
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(path, none);
  return least + (none ? 0 : size / bytes_per_second);
}

[[noreturn]] void read_and_leave(const std::string& path, const std::function<void()>& read) {
  const rlimit no_core{0, 0};
  const rlim_t seconds = patience(path);
  const rlimit time{seconds, seconds};
  setrlimit(RLIMIT_CORE, &no_core);
  setrlimit(RLIMIT_CPU, &time);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL, SIGXCPU}) std::signal(signal, SIG_DFL);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDERR_FILENO);  // what a library says of its end
  try {
    read();
  } catch (const std::exception&) {
    // it is thrown again where it can be told
  }
  _exit(0);
}

}  // namespace

void rehearse(const std::string& path, const std::function<void()>& read) {
  const pid_t process = fork();
  check(process >= 0, "start a process to read", path);
  if (process == 0) read_and_leave(path, read);
  int status = 0;
  while (waitpid(process, &status, 0) < 0) check(errno == EINTR, "wait for the process that reads", path);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const std::string reason =
      WIFSIGNALED(status) ? std::string("ends with ") + strsignal(WTERMSIG(status)) : "fails";
  throw Error("cannot read " + path + " (damaged: reading it " + reason +
              "); restore it from a copy, or start a new file");
}

}  // namespace clog::store
