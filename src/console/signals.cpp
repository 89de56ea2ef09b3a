#include "clog/console/signals.hpp"

#include <csignal>

namespace clog::console {
namespace {

volatile std::sig_atomic_t stop_flag = 0;  // the one thing a signal handler may write to

void raise_stop_flag(int) { stop_flag = 1; }

}  // namespace

void catch_stop_signals() {
  std::signal(SIGINT, raise_stop_flag);
  std::signal(SIGTERM, raise_stop_flag);
  std::signal(SIGUSR1, raise_stop_flag);
}

bool stop_signalled() { return stop_flag != 0; }

}  // namespace clog::console
