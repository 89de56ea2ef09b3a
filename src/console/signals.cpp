#include "clog/console/signals.hpp"

namespace clog::console {
namespace {

volatile std::sig_atomic_t stop_flag = 0;  // the only thing that a signal handler may write

void raise_stop_flag(int) { stop_flag = 1; }

}  // namespace

void catch_stop_signals() {
  for (const int signal : stop_signals)
    if (signal != SIGHUP || std::signal(SIGHUP, SIG_IGN) != SIG_IGN) std::signal(signal, raise_stop_flag);
}

bool stop_signalled() { return stop_flag != 0; }

}  // namespace clog::console
