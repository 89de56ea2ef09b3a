#pragma once

#include <stdexcept>

namespace clog::console {

/// A signal ended what the program was waiting for; it leaves with exit_incomplete.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Makes SIGINT, SIGTERM and SIGUSR1 raise a flag, and nothing else.
void catch_stop_signals();
bool stop_signalled();

}  // namespace clog::console
