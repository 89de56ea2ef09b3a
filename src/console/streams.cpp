#include "clog/console/streams.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <iostream>

#include "clog/console/exit_codes.hpp"
#include "clog/console/printable.hpp"

namespace clog::console {

void prepare_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) < 0 && open("/dev/null", O_RDWR) != descriptor)
      std::_Exit(exit_user_fault);  // no message, because standard error may be closed, too
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond ulimit -f then fails instead of ending the program
  std::cout.exceptions(std::ios_base::badbit);
  std::cerr.tie(nullptr);  // errors are printed even if the output cannot be written
}

void say(const std::string& line) { std::cerr << printable(line) << std::endl; }

void flush_output() { std::cout.flush(); }

bool is_reader_gone() {
  pollfd state{STDOUT_FILENO, POLLOUT, 0};
  return poll(&state, 1, 0) == 1 && (state.revents & (POLLERR | POLLHUP)) != 0;
}

}  // namespace clog::console
