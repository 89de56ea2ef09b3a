#include "clog/conduct/log.hpp"

#include <fmt/core.h>

#include <ctime>

#include "clog/console/printable.hpp"

namespace clog::conduct {
namespace {

std::string time_of_day() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  char text[16];
  return {text, std::strftime(text, sizeof text, "%H:%M:%S", &parts)};
}

std::string who(const sweep::RunRow& row) { return fmt::format("task {} rank {}: ", row.task, row.rank); }

/// The parameters that most sweeps vary.
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

void Log::say(const std::string& text) { progress_.say(time_of_day() + ' ' + console::printable(text)); }

void Log::started(const sweep::RunRow& row, From from) {
  if (level_ < Level::verbose) return;
  say(who(row) + (from == From::release ? "starts" : "resumes" + where(row)) +
      (row.attempt > 1 ? fmt::format(", attempt {}", row.attempt) : "") + what(row));
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

void Log::failure_withdrawn(const sweep::RunRow& row) {
  if (level_ < Level::normal) return;
  say(fmt::format("{}the rank itself may be at fault; attempt {} does not count{}", who(row), row.attempt,
                  what(row)));
}

void Log::set_aside(const sweep::RunRow& failed) {
  say(fmt::format("rank {} on {} is set aside: tasks fail there that succeed elsewhere; last message: {}",
                  failed.rank, failed.host, failed.message));
}

void Log::stopping(const std::string& reason) {
  if (level_ >= Level::normal) say("stopping because of " + reason);
}

}  // namespace clog::conduct
