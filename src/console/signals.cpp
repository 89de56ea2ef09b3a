#include "clog/console/signals.hpp"

namespace clog::console {
namespace {

volatile std::sig_atomic_t stop_flag = 0;  // a signal handler may write only variables of this type

void raise_stop_flag(int) { stop_flag = 1; }

bool hangup_was_ignored = false;  // as under nohup

void look_at_hangup() {
  struct sigaction action {};
  hangup_was_ignored = sigaction(SIGHUP, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

/// Runs before shared libraries are initialised, because UCX, a library of Open MPI, then takes over SIGHUP.
[[gnu::section(".preinit_array"), gnu::used]] void (*const look_first)() = look_at_hangup;

}  // namespace

void catch_stop_signals() {
  for (const int signal : stop_signals)
    std::signal(signal, signal == SIGHUP && hangup_was_ignored ? SIG_IGN : raise_stop_flag);
}

bool stop_signalled() { return stop_flag != 0; }

}  // namespace clog::console
