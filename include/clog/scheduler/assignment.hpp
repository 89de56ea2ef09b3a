#pragma once

#include <chrono>
#include <string>

#include "clog/sweep/job.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::scheduler {

/// Rank 0's message to the other ranks before a sweep: the descriptions of the tasks, and options.
struct Assignment {
  std::chrono::milliseconds report_interval{10'000};
  std::string instruction_set = "auto";
  bool is_isolated = true;  ///< whether tasks run in separate processes
  std::string settings;     ///< see sweep::Settings::packed()

  /// Serialised form, for messages.
  std::string text() const;
  static Assignment from(const std::string& text);
};

/// The jobs of an assignment. Any process may call this. @param text  see Assignment::text()
sweep::JobFactory assigned_jobs(const std::string& text);

}  // namespace clog::scheduler
