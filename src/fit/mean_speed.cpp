#include "clog/fit/mean_speed.hpp"

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <vector>

namespace clog::fit {

MeanSpeed fit_mean_speed(std::span<const double> speeds) {
  std::vector<double> valid;
  for (const double speed : speeds)
    if (!std::isnan(speed)) valid.push_back(speed);
  constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
  MeanSpeed fit{.num_runs = static_cast<int>(valid.size()), .mean = undefined, .standard_error = undefined};
  if (valid.empty()) return fit;
  const Eigen::Map<const Eigen::ArrayXd> values(valid.data(), static_cast<Eigen::Index>(valid.size()));
  fit.mean = values.mean();
  const double n = static_cast<double>(valid.size());
  if (valid.size() > 1) fit.standard_error = std::sqrt((values - fit.mean).square().sum() / (n * (n - 1)));
  return fit;
}

MeanSpeed fit_pooled_speed(std::span<const Travel> runs) {
  std::vector<Travel> valid;
  double distance = 0, time = 0;
  for (const Travel& run : runs) {
    if (std::isnan(run.distance) || std::isnan(run.time)) continue;
    valid.push_back(run);
    distance += run.distance;
    time += run.time;
  }
  constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
  MeanSpeed fit{.num_runs = static_cast<int>(valid.size()), .mean = undefined, .standard_error = undefined};
  if (valid.empty() || !std::isfinite(distance) || !std::isfinite(time)) return fit;
  fit.mean = distance / time;
  if (valid.size() == 1) return fit;
  Eigen::ArrayXd without(static_cast<Eigen::Index>(valid.size()));
  for (Eigen::Index i = 0; i < without.size(); ++i)
    without[i] = (distance - valid[i].distance) / (time - valid[i].time);
  const double n = static_cast<double>(valid.size());
  fit.standard_error = std::sqrt((n - 1) / n * (without - without.mean()).square().sum());
  return fit;
}

}  // namespace clog::fit
