#include "clog/single_run/progress.hpp"

#include <fmt/core.h>

#include <iostream>

#include "clog/console/duration.hpp"
#include "clog/console/status_line.hpp"

namespace clog::single_run {

RunProgress::RunProgress() : status_(std::cerr, console::StatusLine::standard_error()) {}

void RunProgress::tick(const DropletRun& run) {
  if (status_.is_due()) status_.redraw(line(run));
}

std::string RunProgress::line(const DropletRun& run) const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  const double max_time = run.parameters().max_time;
  std::string text =
      fmt::format("r = {:.3g} sigma, t = {:.4g} of at most {:.4g} t0, {} so far", run.displacement()[0],
                  run.time(), max_time, console::readable_duration(elapsed));
  if (run.time() == 0) return text;
  const double most_left = elapsed * (max_time / run.time() - 1);
  return fmt::format("{}, at most {} left", text, console::readable_duration(most_left));
}

}  // namespace clog::single_run
