#pragma once

namespace clog::campaign {

/// Probability that an interval shown to the user contains the true value.
constexpr double default_confidence = 0.95;

}  // namespace clog::campaign
