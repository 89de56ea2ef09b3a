#include "clog/fit/calibration.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <nlopt.hpp>
#include <optional>
#include <stdexcept>

namespace clog::fit {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr double never_reached = 10;

/// The simulated droplet at h, if it came there.
std::optional<Frame> at(const Profile& simulated, double h) {
  for (std::size_t i = 1; i < simulated.size(); ++i) {
    const Frame& before = simulated[i - 1];
    const Frame& after = simulated[i];
    if (!(before.h <= h && h <= after.h)) continue;
    const double share = after.h > before.h ? (h - before.h) / (after.h - before.h) : 0;
    return Frame{h, before.speed + share * (after.speed - before.speed),
                 before.shape + share * (after.shape - before.shape)};
  }
  return std::nullopt;
}

/// (v_measured - v_simulated)/v_simulated of every frame.
struct SpeedResiduals {
  Eigen::VectorXd values;
  int num_never_reached = 0;
};
SpeedResiduals speed_residuals(const Profile& measured, const Profile& simulated) {
  SpeedResiduals residuals{Eigen::VectorXd(static_cast<Eigen::Index>(measured.size()))};
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const std::optional<Frame> frame = at(simulated, measured[i].h);
    residuals.num_never_reached += !frame;
    const double relative = frame ? measured[i].speed / frame->speed - 1 : never_reached;
    residuals.values[static_cast<Eigen::Index>(i)] = frame && frame->speed > 0 && std::isfinite(relative)
                                                         ? std::clamp(relative, -never_reached, never_reached)
                                                         : never_reached;
  }
  return residuals;
}

double root_mean_square(const Eigen::VectorXd& residuals) {
  return residuals.norm() / std::sqrt(static_cast<double>(residuals.size()));
}

/// The search's coordinates are log Gamma and b_0/b_inf.
struct Search {
  const Profile& measured;
  const Simulation& simulate;
  int num_simulations = 0;
  std::exception_ptr fault = nullptr;  // of a simulation; NLopt would swallow its message

  SpeedResiduals residuals(double log_tension, double drag) {
    ++num_simulations;
    return speed_residuals(measured, simulate(std::exp(log_tension), drag));
  }
  double delta(double log_tension, double drag) {
    return root_mean_square(residuals(log_tension, drag).values);
  }
};

std::vector<double> best_of_grid(Search& search, const CalibrationRange& range) {
  constexpr int num_tensions = 7;
  constexpr double drags[] = {0, 0.01, 0.03, 0.1, 0.3};  // in units of the largest
  std::vector<double> best;
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < num_tensions; ++i) {
    const double share = (i + 0.5) / num_tensions;
    const double log_tension =
        (1 - share) * std::log(range.least_tension) + share * std::log(range.most_tension);
    for (const double drag : drags) {
      const double delta = search.delta(log_tension, drag * range.most_drag);
      if (delta >= smallest) continue;
      smallest = delta;
      best = {log_tension, drag * range.most_drag};
    }
  }
  return best;
}

std::vector<double> minimise(Search& search, std::vector<double> place, const CalibrationRange& range) {
  nlopt::opt optimiser(nlopt::LN_SBPLX, 2);
  optimiser.set_lower_bounds({std::log(range.least_tension), 0});
  optimiser.set_upper_bounds({std::log(range.most_tension), range.most_drag});
  optimiser.set_initial_step({0.4, 0.03});
  optimiser.set_xtol_abs({1e-3, 1e-4});
  optimiser.set_maxeval(200);
  const nlopt::vfunc delta = [](const std::vector<double>& x, std::vector<double>&, void* data) {
    auto& now = *static_cast<Search*>(data);
    try {
      return now.delta(x[0], x[1]);
    } catch (...) {
      now.fault = std::current_exception();
      throw nlopt::forced_stop();
    }
  };
  optimiser.set_min_objective(delta, &search);
  double smallest = 0;
  try {
    optimiser.optimize(place, smallest);
  } catch (const nlopt::forced_stop&) {
    std::rethrow_exception(search.fault);
  } catch (const nlopt::roundoff_limited&) {  // as near as it gets; `place` is the best so far
  }
  return place;
}

/// Standard errors of log Gamma and b_0/b_inf, by finite differences wide enough for the runs' own noise. NaN
/// beside a line tension at which the droplet clogs on its way: there the residuals jump, and have no slope.
Eigen::Vector2d errors(Search& search, const std::vector<double>& place) {
  constexpr double tension_step = 0.05;
  const double drag_step = 0.01;
  const double drag_below = std::max(0.0, place[1] - drag_step);
  const SpeedResiduals here = search.residuals(place[0], place[1]);
  const SpeedResiduals stiffer = search.residuals(place[0] + tension_step, place[1]);
  const SpeedResiduals softer = search.residuals(place[0] - tension_step, place[1]);
  const SpeedResiduals slower = search.residuals(place[0], place[1] + drag_step);
  const SpeedResiduals faster = search.residuals(place[0], drag_below);
  for (const SpeedResiduals* beside : {&stiffer, &softer, &slower, &faster})
    if (beside->num_never_reached != here.num_never_reached) return {undefined, undefined};
  Eigen::MatrixX2d slopes(here.values.size(), 2);
  slopes.col(0) = (stiffer.values - softer.values) / (2 * tension_step);
  slopes.col(1) = (slower.values - faster.values) / (place[1] + drag_step - drag_below);
  const double variance = here.values.squaredNorm() / static_cast<double>(here.values.size() - 2);
  const Eigen::Matrix2d information = slopes.transpose() * slopes;
  if (!(information.determinant() > 1e-12 * information.diagonal().prod())) return {undefined, undefined};
  return (variance * information.inverse()).diagonal().cwiseSqrt();
}

/// Zero drag is no bound that hides something better.
bool is_at_bound(const std::vector<double>& place, const CalibrationRange& range) {
  constexpr double margin = 0.01;
  return place[0] < std::log(range.least_tension) + margin ||
         place[0] > std::log(range.most_tension) - margin || place[1] > range.most_drag * (1 - margin);
}

}  // namespace

Deviation deviation(const Profile& measured, const Profile& simulated) {
  if (measured.empty()) throw std::invalid_argument("a profile needs frames");
  double squares = 0;
  int num_shapes = 0;
  for (const Frame& frame : measured) {
    const std::optional<Frame> simulation = at(simulated, frame.h);
    if (std::isnan(frame.shape) || (simulation && std::isnan(simulation->shape))) continue;
    const double relative =
        simulation ? (frame.shape - simulation->shape) / simulation->shape : never_reached;
    squares += relative * relative;
    ++num_shapes;
  }
  return {root_mean_square(speed_residuals(measured, simulated).values),
          num_shapes > 0 ? std::sqrt(squares / num_shapes) : undefined};
}

Calibration calibrate(const Profile& measured, const Simulation& simulate, const CalibrationRange& range) {
  if (measured.size() < 3) throw std::invalid_argument("a calibration needs three frames or more");
  Search search{measured, simulate};
  const std::vector<double> place = minimise(search, best_of_grid(search, range), range);
  const Eigen::Vector2d error = errors(search, place);
  const double tension = std::exp(place[0]);
  const Profile best = simulate(tension, place[1]);
  return {.line_tension = tension,
          .near_wall_drag = place[1],
          .line_tension_error = tension * error[0],
          .near_wall_drag_error = error[1],
          .deviation = deviation(measured, best),
          .num_simulations = search.num_simulations + 1,
          .is_at_bound = is_at_bound(place, range),
          .num_never_reached = speed_residuals(measured, best).num_never_reached};
}

Trials combine(std::span<const Calibration> trials) {
  Eigen::ArrayX2d found(static_cast<Eigen::Index>(trials.size()), 2);
  for (std::size_t i = 0; i < trials.size(); ++i)
    found.row(static_cast<Eigen::Index>(i)) << trials[i].line_tension, trials[i].near_wall_drag;
  const Eigen::Array2d mean = found.colwise().mean().transpose();
  Eigen::Array2d deviations(undefined, undefined);
  if (trials.size() > 1)
    deviations = ((found.rowwise() - mean.transpose()).square().colwise().sum().transpose() /
                  static_cast<double>(trials.size() - 1))
                     .sqrt();
  return {mean[0], deviations[0], mean[1], deviations[1]};
}

}  // namespace clog::fit
