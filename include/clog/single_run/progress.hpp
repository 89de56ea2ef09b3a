#pragma once

#include <chrono>
#include <string>

#include "clog/console/status_line.hpp"
#include "clog/core/run/droplet_run.hpp"

namespace clog::single_run {

/// Reports on the standard error the progress of one run. On a terminal the line disappears when the run is
/// over.
class RunProgress {
 public:
  RunProgress();
  void tick(const DropletRun& run);
  void finish() { status_.wipe(); }

 private:
  using Clock = std::chrono::steady_clock;

  console::StatusLine status_;
  Clock::time_point begin_ = Clock::now();

  std::string line(const DropletRun& run) const;
};

}  // namespace clog::single_run
