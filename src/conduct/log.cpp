#include "clog/conduct/log.hpp"

#include <cstdio>
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

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string who(const sweep::RunRow& row) {
  return "task " + std::to_string(row.task) + " rank " + std::to_string(row.rank) + ": ";
}

/// The parameters that most sweeps go along.
std::string what(const sweep::RunRow& row) {
  const RunParameters& run = row.parameters;
  return (run.model == Model::dp ? " (Gamma=" + short_number(run.dp.line_tension)
                                 : " (E_w=" + short_number(run.wall_stiffness.value())) +
         ", gap=" + short_number(run.obstacles.gap) + ", seed " + std::to_string(run.seed) + ')';
}

std::string where(const sweep::RunRow& row) {
  return " at " + short_number(row.distance) + " sigma after " + short_number(row.time) + " t0";
}

}  // namespace

void Log::say(const std::string& text) { progress_.say(time_of_day() + ' ' + console::printable(text)); }

void Log::started(const sweep::RunRow& row, From from) {
  if (level_ < Level::verbose) return;
  say(who(row) + (from == From::release ? "starts" : "goes on" + where(row)) +
      (row.attempt > 1 ? ", attempt " + std::to_string(row.attempt) : "") + what(row));
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
  say(who(row) + "failed, attempt " + std::to_string(row.attempt) +
      (then == Then::tried_again ? ", will be tried again: " : ": ") + row.message + what(row));
}

void Log::failure_withdrawn(const sweep::RunRow& row) {
  if (level_ < Level::normal) return;
  say(who(row) + "the rank itself may be at fault; attempt " + std::to_string(row.attempt) +
      " does not count" + what(row));
}

void Log::set_aside(const sweep::RunRow& failed) {
  say("rank " + std::to_string(failed.rank) + " on " + failed.host +
      " is set aside: task after task fails there, and not elsewhere; the last one said: " + failed.message);
}

void Log::stopping(const std::string& reason) {
  if (level_ >= Level::normal) say("stops, by " + reason);
}

}  // namespace clog::conduct
