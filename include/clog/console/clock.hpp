#pragma once

#include <string>

namespace clog::console {

/// The present time in UTC, by ISO 8601: `2026-11-25T00:45:15Z`.
std::string utc_now();
/// The present local time of day: `00:45:15`.
std::string time_of_day();

}  // namespace clog::console
