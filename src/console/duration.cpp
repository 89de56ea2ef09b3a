#include "clog/console/duration.hpp"

#include <fmt/core.h>

#include <cmath>

namespace clog::console {

std::string readable_duration(double seconds) {
  // Times of a few minutes also show seconds. With whole minutes only, the displayed time would seem to jump.
  constexpr double long_in_seconds = 120, long_in_minutes = 600;
  if (seconds < long_in_seconds - 0.5) return fmt::format("{:.0f} s", seconds);
  if (seconds < long_in_minutes - 0.5) {
    const auto whole = static_cast<long>(std::lround(seconds));
    return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  }
  if (seconds < 90 * 60) return fmt::format("{:.0f} min", seconds / 60);
  if (seconds < 48 * 3600) return fmt::format("{:.1f} h", seconds / 3600);
  return fmt::format("{:.1f} days", seconds / 86400);
}

}  // namespace clog::console
