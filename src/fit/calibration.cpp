#include "clog/fit/calibration.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <functional>
#include <future>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <vector>

#include "nelder_mead.hpp"

namespace clog::fit {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr double never_reached = 10;

/// The largest h that the simulated droplet came to.
double farthest_place(const Profile& simulated) {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const Frame& frame : simulated) farthest = std::max(farthest, frame.h);
  return farthest;
}

/// Deviation of a frame that the simulated droplet never came to. It grows with what is missing, so that a
/// search among droplets that clog sees which way is better.
double shortfall(double h, double farthest) {
  return std::isfinite(farthest) ? never_reached * (1 + std::max(0.0, h - farthest)) : never_reached;
}

/// Within bounds, also where the simulated droplet stands still or is pushed back.
double relative_difference(double measured, double simulated) {
  const double relative = measured / simulated - 1;
  if (!(simulated > 0) || !std::isfinite(relative)) return never_reached;
  return std::clamp(relative, -never_reached, never_reached);
}

/// (v_measured - v_simulated)/v_simulated of every frame.
struct SpeedResiduals {
  Eigen::VectorXd values;
  int num_never_reached = 0;
};
SpeedResiduals speed_residuals(const Profile& measured, const Profile& simulated) {
  SpeedResiduals residuals{Eigen::VectorXd(static_cast<Eigen::Index>(measured.size()))};
  const double farthest = farthest_place(simulated);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const std::optional<Frame> frame = frame_at(simulated, measured[i].h);
    residuals.num_never_reached += !frame;
    residuals.values[static_cast<Eigen::Index>(i)] =
        frame ? relative_difference(measured[i].speed, frame->speed) : shortfall(measured[i].h, farthest);
  }
  return residuals;
}

double root_mean_square(const Eigen::VectorXd& residuals) {
  return residuals.norm() / std::sqrt(static_cast<double>(residuals.size()));
}

/// A_measured/A_simulated - 1 of every frame that has a shape.
std::vector<double> shape_residuals(const Profile& measured, const Profile& simulated) {
  std::vector<double> residuals;
  for (const Frame& frame : measured) {
    const std::optional<Frame> simulation = frame_at(simulated, frame.h);
    if (std::isnan(frame.shape) || (simulation && std::isnan(simulation->shape))) continue;
    residuals.push_back(simulation ? frame.shape / simulation->shape - 1 : never_reached);
  }
  return residuals;
}

/// Correlation of successive values about zero.
double serial_correlation(std::span<const double> values) {
  constexpr std::size_t fewest = 8;
  if (values.size() < fewest) return undefined;
  const double squares = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  const double products = std::inner_product(values.begin() + 1, values.end(), values.begin(), 0.0);
  return squares > 0 ? products / squares : undefined;
}

/// The search's coordinates.
struct Place {
  double log_tension = 0;
  double drag = 0;  ///< b_0/b_inf
};

struct Trial {
  Place place;
  double delta = 0;  ///< Delta_v
  int num_never_reached = 0;
};

bool is_nearer(const Trial& a, const Trial& b) { return a.delta < b.delta; }

/// Runs simulations and keeps count of them; from several threads.
class Trier {
 public:
  Trier(const Profile& measured, const Simulation& simulate, const CalibrationProgress& progress)
      : measured_(measured), simulate_(simulate), progress_(progress) {}

  Profile profile(const Place& place) const { return simulate_(std::exp(place.log_tension), place.drag); }
  SpeedResiduals residuals(const Place& place) {
    SpeedResiduals found = speed_residuals(measured_, profile(place));
    ++num_simulations_;
    if (progress_) progress_({std::exp(place.log_tension), place.drag, root_mean_square(found.values)});
    return found;
  }
  Trial operator()(const Place& place) {
    const SpeedResiduals found = residuals(place);
    return {place, root_mean_square(found.values), found.num_never_reached};
  }
  int num_simulations() const { return num_simulations_; }

 private:
  const Profile& measured_;
  const Simulation& simulate_;
  const CalibrationProgress& progress_;
  std::atomic<int> num_simulations_ = 0;
};

/// The function's results at all places, computed in parallel. @throws the first failure
template <class Function>
auto for_all(const std::vector<Place>& places, Function function) {
  using Result = std::invoke_result_t<Function&, Place>;
  std::vector<std::future<Result>> running;
  running.reserve(places.size());
  for (const Place& place : places)
    running.push_back(std::async(std::launch::async, [&function, place] { return function(place); }));
  std::vector<Result> found;
  found.reserve(places.size());
  for (std::future<Result>& result : running) found.push_back(result.get());
  return found;
}

/// How a local search begins and ends, in the search's coordinates.
struct Scale {
  Place first_step;
  Place tolerance;
  int most_simulations;
};

struct LocalMinimum {
  Trial best;
  bool is_converged = false;  ///< it ended by its tolerance
};

/// Nelder and Mead's simplex.
LocalMinimum minimise(Trier& trier, const Place& from, const Scale& scale, const CalibrationRange& range) {
  Trial best{from, std::numeric_limits<double>::infinity()};
  const auto delta = [&](double log_tension, double drag) {
    const Trial trial = trier({log_tension, drag});
    best = std::min(best, trial, is_nearer);
    return trial.delta;
  };
  const bool is_converged = nelder_mead({.from = {from.log_tension, from.drag},
                                         .lower = {std::log(range.least_tension), 0},
                                         .upper = {std::log(range.most_tension), range.most_drag},
                                         .first_step = {scale.first_step.log_tension, scale.first_step.drag},
                                         .tolerance = {scale.tolerance.log_tension, scale.tolerance.drag},
                                         .most_evaluations = scale.most_simulations},
                                        delta);
  return {best, is_converged};
}

constexpr int num_grid_tensions = 7;
constexpr double grid_drags[] = {0, 0.01, 0.03, 0.1, 0.3};  // in units of the largest

/// Line tensions run slowest.
std::vector<Place> grid(const CalibrationRange& range) {
  std::vector<Place> places;
  for (int i = 0; i < num_grid_tensions; ++i) {
    const double share = (i + 0.5) / num_grid_tensions;
    for (const double drag : grid_drags)
      places.push_back({std::lerp(std::log(range.least_tension), std::log(range.most_tension), share),
                        drag * range.most_drag});
  }
  return places;
}

/// log Gamma of two droplets beside each other, of which the softer one comes to all frames.
struct ClogBracket {
  double passing;
  double clogging;
};

/// Where droplets of this drag begin to clog, if they do: between the stiffest of the tried that came to all
/// frames and the next.
std::optional<ClogBracket> bracket_clog(Trier& trier, const std::vector<Trial>& tried, double drag) {
  std::optional<ClogBracket> bracket;
  for (std::size_t i = 0; i + std::size(grid_drags) < tried.size(); ++i) {
    const Trial& softer = tried[i];
    const Trial& stiffer = tried[i + std::size(grid_drags)];
    if (softer.num_never_reached == 0 && stiffer.num_never_reached > 0)
      bracket = {softer.place.log_tension, stiffer.place.log_tension};
  }
  if (!bracket) return std::nullopt;
  constexpr double near_enough = 0.005;
  while (bracket->clogging - bracket->passing > near_enough) {
    const double middle = std::midpoint(bracket->passing, bracket->clogging);
    const bool is_passing = trier({middle, drag}).num_never_reached == 0;
    (is_passing ? bracket->passing : bracket->clogging) = middle;
  }
  return bracket;
}

/// The speed in the neck changes in proportion to how far a droplet is from clogging, and so does the scale
/// on which Delta_v has its minima: places at distances from the clog that double.
std::vector<Place> ladder(const ClogBracket& clog, double drag, const CalibrationRange& range) {
  std::vector<Place> places;
  for (const double distance : {0.0, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32})
    for (const double factor : {0.9, 1.0, 1.1})
      places.push_back({std::max(clog.passing - distance, std::log(range.least_tension)),
                        std::min(factor * drag, range.most_drag)});
  return places;
}

/// The nearest of several places, no two of them at the same line tension.
std::vector<Place> nearest(std::vector<Trial> trials, std::size_t number) {
  std::stable_sort(trials.begin(), trials.end(), is_nearer);
  std::vector<Place> places;
  for (const Trial& trial : trials)
    if (places.size() < number && std::none_of(places.begin(), places.end(), [&](const Place& place) {
          return place.log_tension == trial.place.log_tension;
        }))
      places.push_back(trial.place);
  return places;
}

/// The least squares' problem at a place as if the residuals were linear. All NaN if the droplet clogs a step
/// away, for there the residuals jump and have no slope, or if the frames do not determine both.
struct Linearised {
  Place errors{undefined, undefined};  ///< standard errors of log Gamma and b_0/b_inf
  Place way{undefined, undefined};     ///< to the minimum

  bool is_known() const { return !std::isnan(errors.log_tension); }
};
/// Approximates the residuals as linear, by differences over these steps.
Linearised linearise(Trier& trier, const Place& place, const Place& step) {
  const double drag_below = std::max(0.0, place.drag - step.drag);
  const std::vector<SpeedResiduals> all = for_all({place,
                                                   {place.log_tension + step.log_tension, place.drag},
                                                   {place.log_tension - step.log_tension, place.drag},
                                                   {place.log_tension, place.drag + step.drag},
                                                   {place.log_tension, drag_below}},
                                                  [&](const Place& at) { return trier.residuals(at); });
  const auto& [here, stiffer, softer, slower, faster] = std::tie(all[0], all[1], all[2], all[3], all[4]);
  for (const SpeedResiduals& beside : all)
    if (beside.num_never_reached != here.num_never_reached) return {};
  Eigen::MatrixX2d slopes(here.values.size(), 2);
  slopes.col(0) = (stiffer.values - softer.values) / (2 * step.log_tension);
  slopes.col(1) = (slower.values - faster.values) / (place.drag + step.drag - drag_below);
  const double variance = here.values.squaredNorm() / static_cast<double>(here.values.size() - 2);
  const Eigen::Matrix2d information = slopes.transpose() * slopes;
  if (!(information.determinant() > 1e-12 * information.diagonal().prod())) return {};
  const Eigen::Vector2d errors = (variance * information.inverse()).diagonal().cwiseSqrt();
  const Eigen::Vector2d way = -information.ldlt().solve(slopes.transpose() * here.values);
  return {{errors[0], errors[1]}, {way[0], way[1]}};
}

/// The same over steps that fit: short enough for the droplet to pass on both sides, and then as long as the
/// errors.
Linearised linearise(Trier& trier, const Place& place) {
  constexpr Place longest{0.05, 0.01};
  constexpr Place shortest{5e-4, 1e-4};
  Place step = longest;
  Linearised found = linearise(trier, place, step);
  while (!found.is_known() && step.log_tension > 2 * shortest.log_tension) {
    step = {step.log_tension / 2, step.drag / 2};
    found = linearise(trier, place, step);
  }
  if (!found.is_known()) return found;
  return linearise(trier, place,
                   {std::clamp(found.errors.log_tension, shortest.log_tension, step.log_tension),
                    std::clamp(found.errors.drag, shortest.drag, step.drag)});
}

/// The best of places on the straight way to where the minimum seems to be.
Trial try_along(Trier& trier, const Place& from, const Place& way, const CalibrationRange& range) {
  std::vector<Place> places;
  for (const double share : {1.0, 0.5, 0.2, 0.05})
    places.push_back({std::clamp(from.log_tension + share * way.log_tension, std::log(range.least_tension),
                                 std::log(range.most_tension)),
                      std::clamp(from.drag + share * way.drag, 0.0, range.most_drag)});
  const std::vector<Trial> trials = for_all(places, std::ref(trier));
  return *std::min_element(trials.begin(), trials.end(), is_nearer);
}

/// Is that so little that it does not matter, against the errors or at all?
bool is_negligible(const Place& way, const Place& errors) {
  return std::abs(way.log_tension) <= std::max(0.1 * errors.log_tension, 1e-5) &&
         std::abs(way.drag) <= std::max(0.1 * errors.drag, 1e-6);
}

/// Gauss and Newton's steps; where they lead nowhere, a new simplex, for the last one may have collapsed on a
/// slope.
LocalMinimum polish(Trier& trier, const Trial& from, const CalibrationRange& range) {
  constexpr int most_steps = 20;
  constexpr double worth_it = 0.999;
  Trial best = from;
  for (int i = 0; i < most_steps; ++i) {
    const Linearised here = linearise(trier, best.place);
    if (here.is_known()) {
      if (is_negligible(here.way, here.errors)) return {best, true};
      const Trial along = try_along(trier, best.place, here.way, range);
      const bool is_worth_it = along.delta < worth_it * best.delta;
      best = std::min(best, along, is_nearer);
      if (is_worth_it) continue;
    }
    const Scale scale{{0.005, std::max(0.02 * best.place.drag, 0.001)}, {5e-5, 5e-6}, 80};
    const LocalMinimum found = minimise(trier, best.place, scale, range);
    const bool is_worth_it = found.best.delta < worth_it * best.delta;
    best = std::min(best, found.best, is_nearer);
    if (found.is_converged && !is_worth_it) return {best, true};
  }
  return {best, false};
}

/// The place of the least Delta_v, and the border where droplets begin to clog.
struct SearchResult {
  LocalMinimum minimum;
  std::optional<ClogBracket> clog;
};
SearchResult search(Trier& trier, const CalibrationRange& range) {
  constexpr std::size_t num_starts = 3;
  const std::vector<Trial> tried = for_all(grid(range), std::ref(trier));
  const auto coarse = [&](const Place& from) {
    return minimise(trier, from, {{0.4, std::max(0.3 * from.drag, 0.03)}, {0.01, 0.002}, 40}, range).best;
  };
  std::vector<Trial> minima = for_all(nearest(tried, num_starts), coarse);
  const double drag = std::min_element(minima.begin(), minima.end(), is_nearer)->place.drag;
  const std::optional<ClogBracket> clog = bracket_clog(trier, tried, drag);
  if (clog) {
    const auto fine = [&](const Place& from) {
      return minimise(trier, from, {{0.01, std::max(0.05 * from.drag, 0.001)}, {5e-4, 5e-5}, 60}, range).best;
    };
    const std::vector<Trial> rungs = for_all(ladder(*clog, drag, range), std::ref(trier));
    for (const Trial& minimum : for_all(nearest(rungs, num_starts), fine)) minima.push_back(minimum);
  }
  const Trial& best = *std::min_element(minima.begin(), minima.end(), is_nearer);
  return {polish(trier, best, range), clog};
}

/// Zero drag is no bound that hides something better.
bool is_at_bound(const Place& place, const CalibrationRange& range) {
  constexpr double margin = 0.01;
  return place.log_tension < std::log(range.least_tension) + margin ||
         place.log_tension > std::log(range.most_tension) - margin ||
         place.drag > range.most_drag * (1 - margin);
}

}  // namespace

std::optional<Frame> frame_at(const Profile& profile, double h) {
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const Frame& before = profile[i - 1];
    const Frame& after = profile[i];
    if (!(before.h <= h && h <= after.h)) continue;
    const double share = after.h > before.h ? (h - before.h) / (after.h - before.h) : 0;
    return Frame{h, before.speed + share * (after.speed - before.speed),
                 before.shape + share * (after.shape - before.shape)};
  }
  return std::nullopt;
}

Deviation deviation(const Profile& measured, const Profile& simulated) {
  if (measured.empty()) throw std::invalid_argument("a profile needs frames");
  const std::vector<double> shapes = shape_residuals(measured, simulated);
  const double squares = std::inner_product(shapes.begin(), shapes.end(), shapes.begin(), 0.0);
  return {root_mean_square(speed_residuals(measured, simulated).values),
          shapes.empty() ? undefined : std::sqrt(squares / static_cast<double>(shapes.size()))};
}

Deviation residual_correlation(const Profile& measured, const Profile& simulated) {
  Profile frames = measured;
  std::ranges::stable_sort(frames, {}, &Frame::h);
  const Eigen::VectorXd speeds = speed_residuals(frames, simulated).values;
  return {serial_correlation({speeds.data(), static_cast<std::size_t>(speeds.size())}),
          serial_correlation(shape_residuals(frames, simulated))};
}

Calibration calibrate(const Profile& measured, const Simulation& simulate, const CalibrationRange& range,
                      const CalibrationProgress& progress) {
  if (measured.size() < 3) throw std::invalid_argument("a calibration needs three frames or more");
  Trier trier(measured, simulate, progress);
  const SearchResult found = search(trier, range);
  const Place& place = found.minimum.best.place;
  const Place error = linearise(trier, place).errors;
  const double tension = std::exp(place.log_tension);
  const Profile best = trier.profile(place);
  return {.line_tension = tension,
          .near_wall_drag = place.drag,
          .line_tension_error = tension * error.log_tension,
          .near_wall_drag_error = error.drag,
          .deviation = deviation(measured, best),
          .correlation = residual_correlation(measured, best),
          .num_frames = static_cast<int>(measured.size()),
          .num_simulations = trier.num_simulations() + 1,
          .is_converged = found.minimum.is_converged,
          .is_at_bound = is_at_bound(place, range),
          .num_never_reached = found.minimum.best.num_never_reached,
          .clogging_tension = found.clog ? std::exp(found.clog->clogging) : undefined};
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
