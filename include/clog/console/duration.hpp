#pragma once

#include <string>

namespace clog::console {

/// A duration in the unit that suits it.
std::string readable_duration(double seconds);

}  // namespace clog::console
