#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>

namespace clog {

/// A point of r(t).
struct TravelSample {
  double time;          ///< [t0]
  double displacement;  ///< displacement along the flow [sigma]
};

/// Mean speed of one run after its transient; NaN if unknown.
struct TravelSpeed {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  double mean = unknown;   ///< [sqrt(sigma g)]
  double error = unknown;  ///< standard error of the mean, from the variation of the speed within this run
  double transient = unknown;  ///< time at which the transient ends [t0]
  double time = unknown;       ///< time over which the mean is taken [t0]
};

/// Mean of the speed after its transient, (r(t_e) - r(t_b))/(t_e - t_b), with t_b the end of the transient
/// and t_e the last sample's time. All members are NaN for fewer than 50 intervals, or if the transient takes
/// more than half of the time.
/// @param samples  at evenly spaced times
TravelSpeed travel_speed(std::span<const TravelSample> samples);

/// Number of values at the beginning to exclude from a mean (MSER-5: White, Simulation 69, 323 (1997)). It is
/// the multiple of 5 after which the mean of the remaining values has the smallest standard error. The
/// standard error assumes that means of 5 successive values are independent. The search covers only the first
/// half of the values. Returns nullopt for fewer than 50 values. Also returns nullopt if the best number is
/// at the end of the first half, because the transient may then be longer.
std::optional<std::size_t> transient_length(std::span<const double> values);

/// Standard error of the mean of correlated values (Flyvbjerg and Petersen, J. Chem. Phys. 91, 461 (1989)).
/// The values are divided into blocks of 1, 2, 4, ... values. For each block length B, the scatter of the
/// blocks' means gives an estimate e_B. The estimates grow with B until the blocks are independent. The
/// result is the estimate for the shortest B with B^3 > 2 n (e_B/e_1)^4, at which the remaining correlation
/// is as small as the scatter of the estimate (Lee et al., Phys. Rev. E 83, 066706 (2011)). NaN if no such B
/// is shorter than n/2. Also NaN for fewer than 200 values, because the error would be too small if
/// neighbours are correlated.
double blocked_error(std::span<const double> values);

}  // namespace clog
