#include "clog/watch/progress.hpp"

#include <cstdio>
#include <iostream>

#include "clog/console/duration.hpp"
#include "clog/console/status_line.hpp"

namespace clog::watch {

RunProgress::RunProgress() : status_(std::cerr, console::StatusLine::standard_error()) {}

void RunProgress::tick(const DropletRun& run) {
  if (status_.is_due()) status_.renew(line(run));
}

std::string RunProgress::line(const DropletRun& run) const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  const double max_time = run.parameters().max_time;
  char place[96];
  std::snprintf(place, sizeof place, "r = %.3g sigma, t = %.4g of at most %.4g t0, ", run.displacement()[0],
                run.time(), max_time);
  std::string text = place + console::readable_duration(elapsed) + " so far";
  if (run.time() > 0)
    text += ", at most " + console::readable_duration(elapsed * (max_time / run.time() - 1)) + " left";
  return text;
}

}  // namespace clog::watch
