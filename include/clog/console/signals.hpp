#pragma once

#include <array>
#include <csignal>
#include <stdexcept>

namespace clog::console {

/// Thrown when a signal interrupts a wait; the program then ends with exit_incomplete.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Signals that stop a program. A closed terminal sends HUP; batch systems warn by USR1, USR2 and XCPU.
inline constexpr std::array stop_signals{SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU};

/// After this call, these signals only set the flag that stop_signalled() returns. Under nohup, SIGHUP is
/// still ignored.
void catch_stop_signals();
bool stop_signalled();

}  // namespace clog::console
