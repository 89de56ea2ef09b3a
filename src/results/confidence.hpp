#pragma once

namespace clog::results {

/// Probability that an interval shown to the user contains the true value.
constexpr double default_confidence = 0.95;

}  // namespace clog::results
