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

}  // namespace clog::fit
