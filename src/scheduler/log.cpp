#include "clog/scheduler/log.hpp"

#include <fmt/core.h>

#include <cstdint>

#include "clog/console/clock.hpp"
#include "clog/console/printable.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/store/journal.hpp"
#include "clog/sweep/row_limits.hpp"

namespace clog::scheduler {
namespace {

std::string who(const sweep::RunRow& row) { return fmt::format("task {} rank {}: ", row.task, row.rank); }

/// Names a run by the parameters that most sweeps vary.
std::string what(const sweep::RunRow& row) {
  const RunParameters& run = row.parameters;
  const bool is_polygon = run.model == Model::dp;
  return fmt::format(" ({}={:.4g}, gap={:.4g}, seed {})", is_polygon ? "Gamma" : "E_w",
                     is_polygon ? run.dp.line_tension : run.wall_stiffness.value(), run.obstacles.gap,
                     run.seed);
}

std::string where(const sweep::RunRow& row) {
  return fmt::format(" at {:.4g} sigma after {:.4g} t0", row.distance, row.time);
}

}  // namespace

void announce(const std::string& output, const sweep::Plan& plan, const results::SweepState& state,
              bool may_grow, int num_ranks) {
  const std::int64_t num_runs = state.num_wanted();
  const auto num_left = static_cast<std::int64_t>(state.tasks_left().size());
  if (!state.caution().empty()) console::say(state.caution());
  const std::int64_t num_waiting = state.num_waiting();
  if (num_left + num_waiting < num_runs)
    console::say(fmt::format("{} has {} of {}{}", output, num_runs - num_left - num_waiting,
                             count_text(num_runs, "run"),
                             num_left == 0 && !may_grow ? "; there is nothing left to do" : ""));
  if (const std::int64_t number = state.num_beyond(); number > 0)
    console::say(fmt::format("{} also has {} outside this command's lists; {} kept", output,
                             count_text(number, "run"), number == 1 ? "it is" : "they are"));
  if (const std::int64_t number = state.num_faulty(); number > 0)
    console::say(fmt::format("{}: {} physically impossible; the sweep recomputes those in its lists", output,
                             number == 1 ? "1 row is" : fmt::format("{} rows are", number)));
  if (const std::int64_t number = state.num_unreadable(); number > 0)
    console::say(fmt::format(
        "{}: {}", store::journal_path(output),
        number == 1 ? "1 record is damaged; its run resumes from an earlier record or restarts"
                    : fmt::format("{} records are damaged; their runs resume from earlier records or restart",
                                  number)));
  if (const std::int64_t number = state.num_resumed(); number > 0)
    console::say(fmt::format("{} {} from the last checkpoint", count_text(number, "run"),
                             number == 1 ? "resumes" : "resume"));
  if (num_left == 0) return;
  for (const std::string& words : sweep::limits_of_results(plan)) console::say(words);
  console::say(fmt::format("{} on {}, results go to {}", count_text(num_left, "run"),
                           count_text(num_ranks, "computing rank"), output));
  if (num_waiting > 0)
    console::say(num_waiting == 1 ? "1 more run is the same in another laboratory and gets its result"
                                  : fmt::format("{} more runs are the same in another laboratory and get "
                                                "these results",
                                                num_waiting));
}

void Log::say(const std::string& text) {
  progress_.say(console::time_of_day() + ' ' + console::printable(text));
}

void Log::started(const sweep::RunRow& row, From from) {
  if (level_ < Level::verbose) return;
  say(who(row) + (from == From::release ? "starts" : "resumes" + where(row)) +
      (row.attempt > 1 ? fmt::format(", attempt {}", row.attempt) : "") + what(row));
}

void Log::restarted(const sweep::RunRow& row) {
  if (level_ < Level::normal) return;
  say(fmt::format("{}restarts at the release (its checkpoint cannot be used: {})", who(row), row.message));
}

void Log::ended(const sweep::RunRow& row) {
  if (row.status == RunStatus::failed) {
    failed(row, Then::over);
    return;
  }
  if (level_ < Level::verbose) return;
  say(who(row) + name(row.status) + where(row) + what(row));
}

void Log::failed(const sweep::RunRow& row, Then then) {
  if (level_ < Level::normal) return;
  say(fmt::format("{}failed, attempt {}{}: {}{}", who(row), row.attempt,
                  then == Then::tried_again ? ", will be tried again" : "", row.message, what(row)));
}

void Log::failure_withdrawn(const sweep::RunRow& row, const std::string& machine) {
  if (level_ < Level::normal) return;
  say(fmt::format("{}{} itself may be at fault; attempt {} does not count{}", who(row), machine, row.attempt,
                  what(row)));
}

void Log::set_aside(const MachineTrust::Suspect& machine) {
  say(fmt::format("{} is set aside: tasks fail there that succeed elsewhere; last message: {}", machine.name,
                  machine.message));
}

void Log::stopping(const std::string& reason) {
  if (level_ >= Level::normal) say("stopping because of " + reason);
}

}  // namespace clog::scheduler
