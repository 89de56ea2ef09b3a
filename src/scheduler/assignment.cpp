#include "clog/scheduler/assignment.hpp"

#include <fmt/core.h>

#include <cstddef>
#include <memory>
#include <span>
#include <sstream>

#include "clog/core/tools/instruction_set.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_job.hpp"

namespace clog::scheduler {

std::string Assignment::text() const {
  return fmt::format("{} {} {:d}\n{}", report_interval.count(), instruction_set, is_isolated, settings);
}

Assignment Assignment::from(const std::string& text) {
  Assignment assignment;
  std::chrono::milliseconds::rep interval = 0;
  std::istringstream words(text);
  words >> interval >> assignment.instruction_set >> assignment.is_isolated;
  assignment.report_interval = std::chrono::milliseconds(interval);
  assignment.settings = text.substr(text.find('\n') + 1);
  return assignment;
}

sweep::JobFactory assigned_jobs(const std::string& text) {
  const Assignment assignment = Assignment::from(text);
  use_instruction_set(assignment.instruction_set);
  const auto plan = std::make_shared<sweep::Plan>(sweep::Settings::from_packed(assignment.settings));
  return [plan, make_job = sweep::run_jobs(*plan)](std::int64_t task, std::span<const std::byte> snapshot) {
    return make_job(task, snapshot);
  };
}

}  // namespace clog::scheduler
