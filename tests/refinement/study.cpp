/// Measures the gain of refined sweeps against grids, and how often their intervals contain a known curve.
///
///     build/release/tests/refinement_study KEYS REPETITIONS        # KEYS is 1 or 2; a table on the standard
///     output
///
/// The truth is a clogging length with a peak over three decades, at a place, of a width drawn anew in every
/// repetition; the second key shifts the peak and lowers it. Distances are exponential; a run takes as long
/// as its way at the terminal speed, and a while to be proved clogged.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "clog/campaign/refinement.hpp"
#include "clog/fit/clogging_length.hpp"
#include "clog/fit/curve_features.hpp"
#include "clog/fit/fitted_curve.hpp"

namespace {

using namespace clog;
using campaign::RefinedPoint;
using campaign::RefinementGoal;
using fit::CurvePlace;

constexpr double confidence = 0.95;
constexpr double decades = 2;  // of each key
constexpr double range = decades * std::numbers::ln10;
constexpr double max_time = 3000;  // [t0]; the speed is one sigma per t0
constexpr double time_of_proof = 5;

struct Truth {
  int num_keys;
  double peak;
  double width;

  double log_length(const CurvePlace& place) const {
    const double second = num_keys == 2 ? place[1] / range : 0;
    const double apart = (place[0] / range - peak - 0.15 * second) / width;
    return (3 - second) * std::numbers::ln10 * std::exp(-apart * apart / 2);
  }
};

/// A sweep of one truth: points that grow, and what they cost.
class Sweep {
 public:
  Sweep(const Truth& truth, std::uint64_t seed) : truth_(truth), engine_(seed) {}

  void run(const CurvePlace& place, std::int64_t num_runs) {
    RefinedPoint& point = points_[{place[0], place[1]}];
    point.place = place;
    std::exponential_distribution<double> distances(std::exp(-truth_.log_length(place)));
    for (std::int64_t i = 0; i < num_runs; ++i) {
      const double distance = distances(engine_);
      const bool has_clogged = distance < max_time;
      point.num_clogs += has_clogged;
      point.distance += std::min(distance, max_time);
      const double time = has_clogged ? distance + time_of_proof : max_time;
      point.time += time;
      point.work += time;
      work_ += time;
    }
  }
  double work() const { return work_; }
  std::vector<RefinedPoint> points() const {
    std::vector<RefinedPoint> all;
    for (const auto& [place, point] : points_) all.push_back(point);
    return all;
  }
  double num_clogs(const CurvePlace& place) const { return points_.at({place[0], place[1]}).num_clogs; }

 private:
  Truth truth_;
  std::mt19937_64 engine_;
  std::map<std::pair<double, double>, RefinedPoint> points_;
  double work_ = 0;
};

fit::Curve fitted(const Sweep& sweep, std::span<const CurvePlace> places) {
  std::vector<fit::CurvePoint> points;
  for (const RefinedPoint& point : sweep.points())
    points.push_back({point.place, point.num_clogs, point.distance});
  return fit::fit_curve(points, places);
}

std::vector<CurvePlace> grid(int num_keys, int num_values) {
  std::vector<CurvePlace> places;
  for (int j = 0; j < (num_keys == 2 ? num_values : 1); ++j)
    for (int i = 0; i < num_values; ++i)
      places.emplace_back(range * i / (num_values - 1), num_keys == 2 ? range * j / (num_values - 1) : 0);
  return places;
}

/// Results of one way to a curve at one stage: means over repetitions.
struct Tally {
  int number = 0;
  double work = 0;
  double mean_square = 0;
  double square_of_lines = 0;
  double band = 0;
  double peak = 0;
  double height = 0;
  double crossing = 0;
  int num_crossings = 0;

  double error() const { return std::sqrt(mean_square / number); }
  double error_of_lines() const { return std::sqrt(square_of_lines / number); }
  double cost() const { return work / number; }
};

/// lambda as it is read from a grid without a fit: S/d at each value (half a clog where there is none),
/// straight lines of log lambda between, along each key.
double on_straight_lines(const std::vector<RefinedPoint>& points, const CurvePlace& place) {
  CurvePlace below = CurvePlace::Constant(-std::numeric_limits<double>::infinity()), above = -below;
  for (const RefinedPoint& point : points)
    for (int key = 0; key < place.size(); ++key) {
      if (point.place[key] <= place[key]) below[key] = std::max(below[key], point.place[key]);
      if (point.place[key] >= place[key]) above[key] = std::min(above[key], point.place[key]);
    }
  const auto share = [&](const CurvePlace& corner, int key) {
    if (corner[key] == below[key] && below[key] == above[key]) return 1.0;
    if (corner[key] == below[key]) return (above[key] - place[key]) / (above[key] - below[key]);
    if (corner[key] == above[key]) return (place[key] - below[key]) / (above[key] - below[key]);
    return 0.0;
  };
  constexpr double half_a_clog = 0.5;
  double sum = 0;
  for (const RefinedPoint& point : points)
    sum += share(point.place, 0) * share(point.place, 1) *
           std::log(point.distance / std::max(point.num_clogs, half_a_clog));
  return sum;
}

void judge(Tally& tally, const Truth& truth, const Sweep& sweep, std::span<const CurvePlace> places,
           const fit::Curve& curve) {
  const double z = fit::normal_deviate(confidence);
  const Eigen::VectorXd deviation = curve.deviation();
  double squares = 0;
  double held = 0;
  std::size_t highest = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto index = static_cast<Eigen::Index>(i);
    const double error = curve.mean[index] - truth.log_length(places[i]);
    squares += error * error;
    held += std::abs(error) <= z * deviation[index];
    if (truth.log_length(places[i]) > truth.log_length(places[highest])) highest = i;
  }
  const auto size = static_cast<double>(places.size());
  ++tally.number;
  tally.work += sweep.work();
  tally.mean_square += squares / size;
  tally.band += held / size;
  const CurvePlace top = truth.num_keys == 1 ? CurvePlace(truth.peak * range, 0) : places[highest];
  const double height = truth.log_length(top);
  const fit::CurvePeak peak = fit::find_peak(curve, places, confidence);
  tally.peak += (peak.place_lower.array() <= top.array() + 1e-9).all() &&
                (peak.place_upper.array() >= top.array() - 1e-9).all();
  tally.height += peak.interval.lower <= std::exp(height) && std::exp(height) <= peak.interval.upper;
  if (truth.num_keys == 2) return;
  const double third = 1 / 3.0;  // a crossing at one decade
  const double crossed = range * (truth.peak - truth.width * std::sqrt(-2 * std::log(third)));
  for (const fit::CurveCrossing& one : fit::find_crossings(curve, places, 10, confidence)) {
    if (!one.is_upward) continue;
    ++tally.num_crossings;
    tally.crossing += one.interval.lower <= crossed && crossed <= one.interval.upper;
  }
}

/// The same of a grid, which may also be read without a fit.
void judge_grid(Tally& tally, const Truth& truth, const Sweep& sweep, std::span<const CurvePlace> places) {
  judge(tally, truth, sweep, places, fitted(sweep, places));
  const std::vector<RefinedPoint> points = sweep.points();
  double squares = 0;
  for (const CurvePlace& place : places)
    squares += std::pow(on_straight_lines(points, place) - truth.log_length(place), 2);
  tally.square_of_lines += squares / static_cast<double>(places.size());
}

using Stages = std::map<int, Tally>;

/// @param judge_it  called after every stage
void refine(Sweep& sweep, const std::vector<CurvePlace>& places, const RefinementGoal& goal, int num_stages,
            const std::function<void(int stage, const fit::Curve& curve)>& judge_it) {
  constexpr std::int64_t block = 4;
  const int num_keys = places.front()[1] == places.back()[1] ? 1 : 2;
  for (const CurvePlace& first : grid(num_keys, num_keys == 1 ? 7 : 4)) {
    const auto nearest = std::ranges::min_element(
        places, {}, [&](const CurvePlace& place) { return (place - first).squaredNorm(); });
    sweep.run(*nearest, block);
  }
  for (int stage = 0;; ++stage) {
    const fit::Curve curve = fitted(sweep, places);
    judge_it(stage, curve);
    if (stage == num_stages || campaign::known_precision(curve, places, goal) <= goal.precision) return;
    const auto runs = campaign::expected_runs(sweep.points(), {places, max_time}, curve.mean);
    const auto blocks = campaign::choose_blocks(
        curve, runs, goal,
        {block, std::vector<std::int64_t>(places.size(), 100), campaign::share_of_round * sweep.work()});
    for (std::size_t i = 0; i < places.size(); ++i)
      if (blocks[i] > 0) sweep.run(places[i], block * blocks[i]);
  }
}

/// Adds seeds as --until-precision does: at most doubles them in a round, until there are so many clogs.
void fill_grid(Sweep& sweep, std::span<const CurvePlace> values, std::int64_t clogs) {
  for (const CurvePlace& place : values) {
    std::int64_t num_seeds = 4;
    sweep.run(place, num_seeds);
    for (double found = 0; (found = sweep.num_clogs(place)) < static_cast<double>(clogs);) {
      const auto estimate =
          static_cast<std::int64_t>(std::ceil(static_cast<double>(num_seeds * clogs) / std::max(found, 1.0)));
      const std::int64_t next = std::clamp(estimate, num_seeds + 1, 2 * num_seeds);
      sweep.run(place, next - num_seeds);
      num_seeds = next;
    }
  }
}

/// Work at which these stages have such an error, between two of them on a straight line of logarithms; 0 if
/// none has.
double work_for(const Stages& stages, double error, double (Tally::*error_of)() const) {
  const Tally* before = nullptr;
  for (const auto& [stage, tally] : stages) {
    const double here = (tally.*error_of)();
    if (before && (before->*error_of)() > error && here <= error) {
      const double above = (before->*error_of)();
      const double share = std::log(above / error) / std::log(above / here);
      return std::exp(std::log(before->cost()) + share * std::log(tally.cost() / before->cost()));
    }
    before = &tally;
  }
  return 0;
}

void print(const std::string& name, const Stages& stages) {
  for (const auto& [stage, one] : stages) {
    const double number = one.number;
    fmt::print("{:24} {:5} {:5} {:10.0f} {:7.3f}  {:6.3f} {:6.3f} {:6.3f} {:6.3f}\n", name, stage, one.number,
               one.cost(), one.error(), one.band / number, one.peak / number, one.height / number,
               one.num_crossings > 0 ? one.crossing / one.num_crossings : NAN);
  }
}

/// @param error_of  of the grids
void print_gains(const char* title, const Stages& refined, const std::map<std::string, Stages>& grids,
                 double (Tally::*error_of)() const) {
  fmt::print("{}\n", title);
  for (const auto& [name, stages] : grids) {
    fmt::print("  {:24}", name);
    for (const double error : {0.30, 0.25, 0.20, 0.15, 0.12, 0.10}) {
      const double mine = work_for(refined, error, &Tally::error);
      const double theirs = work_for(stages, error, error_of);
      if (mine > 0 && theirs > 0)
        fmt::print("  {:.2f}: {:4.1f}", error, theirs / mine);
      else
        fmt::print("  {:.2f}:    -", error);
    }
    fmt::print("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "refinement_study KEYS REPETITIONS\n");
    return 2;
  }
  const int num_keys = std::atoi(argv[1]);
  const int repetitions = std::atoi(argv[2]);
  const std::vector<CurvePlace> places = grid(num_keys, num_keys == 1 ? 97 : 13);
  Stages refined;
  Stages known;
  std::map<std::string, Stages> grids;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    std::mt19937_64 engine(static_cast<std::uint64_t>(repetition) + 1);
    std::uniform_real_distribution<double> uniform(0, 1);
    const Truth truth{num_keys, 0.35 + 0.3 * uniform(engine), 0.15 + 0.15 * uniform(engine)};
    Sweep sweep(truth, engine());
    refine(sweep, places, {}, 10,
           [&](int stage, const fit::Curve& curve) { judge(refined[stage], truth, sweep, places, curve); });
    for (const int percent : {30, 20}) {
      Sweep again(truth, engine());
      fit::Curve last;
      refine(again, places, {RefinementGoal::Kind::curve, percent / 100.0}, 100,
             [&](int, const fit::Curve& curve) { last = curve; });
      judge(known[percent], truth, again, places, last);
    }
    for (const int num_values : num_keys == 1 ? std::vector{8, 12, 16} : std::vector{4, 6, 8})
      for (const int number : {4, 8, 16, 32, 64, 128}) {
        const std::vector<CurvePlace> values = grid(num_keys, num_values);
        Sweep until(truth, engine());
        fill_grid(until, values, number);
        judge_grid(grids[fmt::format("{} until precision", num_values)][number], truth, until, places);
        Sweep equal(truth, engine());
        for (const CurvePlace& place : values) equal.run(place, number);
        judge_grid(grids[fmt::format("{} equal seeds", num_values)][number], truth, equal, places);
      }
  }
  fmt::print("{:24} {:>5} {:>5} {:>10} {:>7}  {:>6} {:>6} {:>6} {:>6}\n", "way", "stage", "reps", "work",
             "error", "band", "peak", "height", "cross");
  print("refined", refined);
  print("refined until curve %", known);
  for (const auto& [name, stages] : grids) print(name, stages);
  fmt::print(
      "\nwork of grids over that of the refined sweep, for the same error of log lambda along the curve\n");
  print_gains("with the same fit", refined, grids, &Tally::error);
  print_gains("with straight lines between the values", refined, grids, &Tally::error_of_lines);
  return 0;
}
