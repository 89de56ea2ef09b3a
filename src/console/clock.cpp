#include "clog/console/clock.hpp"

#include <fmt/chrono.h>

#include <ctime>

namespace clog::console {

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", *std::gmtime(&now));
}

std::string time_of_day() {
  const std::time_t now = std::time(nullptr);
  return fmt::format("{:%H:%M:%S}", *std::localtime(&now));
}

}  // namespace clog::console
