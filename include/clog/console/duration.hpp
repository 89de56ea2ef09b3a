#pragma once

#include <string>

namespace clog::console {

/// A duration in a suitable unit.
std::string readable_duration(double seconds);

}  // namespace clog::console
