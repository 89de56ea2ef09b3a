#include "clog/core/run/travel_speed.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace clog {
namespace {

constexpr std::size_t batch_size = 5;
constexpr std::size_t fewest_batches = 10;
constexpr std::size_t fewest_for_error = 200;
/// If the relative standard error of a mean is below this value, the transient counts as over, because the
/// remaining variation may be round-off.
constexpr double negligible_error = 1e-6;

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Means of successive blocks of equal length; a shorter block at the end is excluded.
std::vector<double> means_of_pieces(std::span<const double> values, std::size_t length) {
  std::vector<double> means;
  for (std::size_t begin = 0; begin + length <= values.size(); begin += length)
    means.push_back(mean_of(values.subspan(begin, length)));
  return means;
}

/// Squared standard error of the mean of independent values; exactly zero if they are equal.
double squared_error_of_mean(std::span<const double> values) {
  double mean = 0, sum = 0;  // relative to the first value
  for (const double value : values) mean += (value - values.front()) / static_cast<double>(values.size());
  for (const double value : values) {
    const double deviation = value - values.front() - mean;
    sum += deviation * deviation;
  }
  const double n = static_cast<double>(values.size());
  return sum / (n * (n - 1));
}

}  // namespace

std::optional<std::size_t> transient_length(std::span<const double> values) {
  const std::vector<double> batches = means_of_pieces(values, batch_size);
  if (batches.size() < fewest_batches) return std::nullopt;
  // White's statistic (see the header) is the sum of squared deviations from the mean, divided by n^2. The
  // time of the loops is quadratic in the number of batches, which is at most 200.
  const std::size_t last = batches.size() / 2;
  const double negligible = negligible_error * mean_of(std::span(batches).subspan(last));
  std::size_t best = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t begin = 0; begin <= last; ++begin) {
    const std::span rest = std::span(batches).subspan(begin);
    const double n = static_cast<double>(rest.size());
    const double statistic = std::max(squared_error_of_mean(rest) * (n - 1) / n, negligible * negligible);
    if (statistic >= smallest) continue;
    smallest = statistic;
    best = begin;
  }
  if (best == last) return std::nullopt;
  return best * batch_size;
}

double blocked_error(std::span<const double> values) {
  if (values.size() < fewest_for_error) return TravelSpeed::unknown;
  const double n = static_cast<double>(values.size());
  const double unblocked = squared_error_of_mean(values);
  if (unblocked == 0) return 0;
  for (std::size_t block = 1; 2 * block <= values.size(); block *= 2) {
    const double squared_error = squared_error_of_mean(means_of_pieces(values, block));
    const double growth = squared_error / unblocked;
    const auto length = static_cast<double>(block);
    if (length * length * length > 2 * n * growth * growth) return std::sqrt(squared_error);
  }
  return TravelSpeed::unknown;
}

TravelSpeed travel_speed(std::span<const TravelSample> samples) {
  std::vector<double> speeds;
  for (std::size_t i = 1; i < samples.size(); ++i)
    speeds.push_back((samples[i].displacement - samples[i - 1].displacement) /
                     (samples[i].time - samples[i - 1].time));
  const std::optional<std::size_t> begin = transient_length(speeds);
  if (!begin) return {};
  const TravelSample& first = samples[*begin];
  const double time = samples.back().time - first.time;
  return {.mean = (samples.back().displacement - first.displacement) / time,
          .error = blocked_error(std::span(speeds).subspan(*begin)),
          .transient = first.time,
          .time = time};
}

}  // namespace clog
