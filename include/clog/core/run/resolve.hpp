#pragma once

#include "clog/core/parameters/parameters.hpp"

namespace clog {

/// Replaces automatic values (each an empty `std::optional`), and the box and angle of a lattice, by the
/// values that the run uses, and checks the result. @throws Error naming the field, its value, the reason and
/// a remedy
RunParameters resolve(RunParameters run);

}  // namespace clog
