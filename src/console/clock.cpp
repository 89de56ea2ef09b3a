#include "clog/console/clock.hpp"

#include <ctime>

namespace clog::console {
namespace {

std::string text_of(const std::tm& parts, const char* format) {
  char text[32];
  return {text, std::strftime(text, sizeof text, format, &parts)};
}

}  // namespace

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  return text_of(parts, "%Y-%m-%dT%H:%M:%SZ");
}

std::string time_of_day() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  return text_of(parts, "%H:%M:%S");
}

}  // namespace clog::console
