#pragma once

#include <string>

namespace clog::console {

/// A duration as text in a suitable unit: `90 s`, `5 min 07 s`, `2.5 h`.
std::string readable_duration(double seconds);

}  // namespace clog::console
