#pragma once

#include "clog/core/parameters/parameters.hpp"

namespace clog {

/// Replaces every `auto` (empty optional), and box and angle of a lattice, by the resulting value, then
/// validates. @throws Error naming the field, its value, the reason and a remedy
RunParameters resolve(RunParameters run);

}  // namespace clog
