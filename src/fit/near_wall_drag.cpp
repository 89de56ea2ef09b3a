#include "clog/fit/near_wall_drag.hpp"

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace clog::fit {

NearWallDrag fit_near_wall_drag(std::span<const NearWallSpeed> speeds) {
  const auto n = static_cast<Eigen::Index>(speeds.size());
  Eigen::ArrayXd x(n), y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto [distance, speed] = speeds[static_cast<std::size_t>(i)];
    if (!(distance > 0)) throw std::invalid_argument("a distance from the wall is not positive");
    if (!(speed > 0 && speed < 1)) throw std::invalid_argument("a speed does not lie between 0 and v_t");
    x[i] = std::log(distance);
    y[i] = std::log(speed / (1 - speed));
  }
  if (n < 2 || x.maxCoeff() == x.minCoeff())
    throw std::invalid_argument("needs speeds at two different distances at least");
  const double x_mean = x.mean();
  const double spread = (x - x_mean).square().sum();
  NearWallDrag fit;
  fit.exponent = ((x - x_mean) * y).sum() / spread;
  const double intercept = y.mean() - fit.exponent * x_mean;
  fit.drag = std::exp(-intercept);
  const double residuals = (y - intercept - fit.exponent * x).square().sum();
  const double variance =
      n > 2 ? residuals / static_cast<double>(n - 2) : std::numeric_limits<double>::quiet_NaN();
  fit.exponent_error = std::sqrt(variance / spread);
  fit.drag_error = fit.drag * std::sqrt(variance * (1 / static_cast<double>(n) + x_mean * x_mean / spread));
  return fit;
}

}  // namespace clog::fit
