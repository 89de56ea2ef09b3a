#include "clog/fit/calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <random>
#include <stdexcept>
#include <vector>

namespace clog::fit {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A droplet that a barrier of height `1/tension` and the drag near h = 0 slow down.
Profile model(double tension, double drag) {
  Profile profile;
  for (double h = -2; h < 2; h += 0.013) {
    const double near = std::exp(-4 * h * h);
    const double speed = 1 / (1 + 8 * drag * near) + 0.3 / (1 + tension) * h * near;
    profile.push_back({h, speed, 1 + near * 0.1 / (1 + tension)});
  }
  return profile;
}

Profile measured(double tension, double drag, double noise, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> scatter(1, noise);
  Profile profile;
  const Profile all = model(tension, drag);
  for (std::size_t i = 3; i < all.size(); i += 7)
    profile.push_back({all[i].h, all[i].speed * scatter(engine), all[i].shape});
  return profile;
}

TEST(Deviation, IsTheRootMeanSquareOfRelativeDifferences) {
  const Profile simulated{{0, 1, 1}, {1, 2, 1.1}};
  // At h = 0.5 the simulation has v = 1.5, A = 1.05; at 1, 2 and 1.1.
  const Deviation found = deviation({{0.5, 1.8, 1.05 * 1.02}, {1, 2, 1.1}}, simulated);
  EXPECT_NEAR(found.speed, 0.2 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(found.shape, 0.02 / std::sqrt(2.0), 1e-12);
}

TEST(Deviation, CountsWhatIsNeverReachedAndLeavesOutUnknownShapes) {
  const Profile stuck{{0, 1, 1}, {1, 0.5, 1.1}};
  EXPECT_NEAR(deviation({{2, 1, unknown}}, stuck).speed, 20, 1e-12);  // a diameter is missing
  EXPECT_TRUE(std::isnan(deviation({{0.5, 0.75, unknown}}, stuck).shape));
  EXPECT_TRUE(std::isnan(deviation({{0.5, 1, 1.1}}, {{0, 1, unknown}, {1, 1, unknown}}).shape));
  EXPECT_NEAR(deviation({{0.5, 0.75, unknown}, {0, 1, 1.1}}, stuck).shape, 0.1, 1e-12);
  EXPECT_THROW(deviation({}, stuck), std::invalid_argument);
}

TEST(Deviation, TakesTheFirstOfSeveralPassages) {
  const Profile wavering{{0, 1, 1}, {1, 1, 1}, {0.5, 3, 1}, {1.5, 3, 1}};
  EXPECT_NEAR(deviation({{0.75, 1, 1}}, wavering).speed, 0, 1e-12);
}

TEST(Calibrate, RecoversWhatMadeTheProfile) {
  for (const double tension : {0.16, 1.08, 3.0})
    for (const double drag : {0.0, 0.064, 0.4}) {
      const Calibration found = calibrate(measured(tension, drag, 0, 1), model);
      EXPECT_NEAR(found.line_tension, tension, 0.005 * (1 + tension)) << drag;
      EXPECT_NEAR(found.near_wall_drag, drag, 1e-3) << tension;
      EXPECT_LT(found.deviation.speed, 1e-3);
      EXPECT_LT(found.deviation.shape, 1e-3);
      EXPECT_LE(found.num_simulations, 400);
      EXPECT_TRUE(found.is_converged);
      EXPECT_TRUE(std::isnan(found.clogging_tension));
    }
}

TEST(Calibrate, HasErrorsThatTrialsScatterBy) {
  std::vector<Calibration> trials;
  double stated_tension = 0, stated_drag = 0;
  constexpr int num_trials = 60;
  for (unsigned seed = 1; seed <= num_trials; ++seed) {
    trials.push_back(calibrate(measured(0.8, 0.1, 0.02, seed), model));
    stated_tension += trials.back().line_tension_error / num_trials;
    stated_drag += trials.back().near_wall_drag_error / num_trials;
    EXPECT_NEAR(trials.back().deviation.speed, 0.02, 0.01);
  }
  const Trials all = combine(trials);
  // The scatter of 60 is known to 9 %; its mean to a scatter over the root of 60.
  EXPECT_NEAR(all.line_tension_deviation / stated_tension, 1, 0.3);
  EXPECT_NEAR(all.near_wall_drag_deviation / stated_drag, 1, 0.3);
  EXPECT_NEAR(all.line_tension, 0.8, 4 * all.line_tension_deviation / std::sqrt(num_trials));
  EXPECT_NEAR(all.near_wall_drag, 0.1, 4 * all.near_wall_drag_deviation / std::sqrt(num_trials));
}

TEST(Calibrate, HasNoErrorsWhereTheProfileDoesNotDetermineBoth) {
  const Simulation insensitive = [](double, double drag) { return model(1, drag); };
  const Calibration found = calibrate(measured(1, 0.1, 0.01, 3), insensitive);
  EXPECT_TRUE(std::isnan(found.line_tension_error));
  EXPECT_NEAR(found.near_wall_drag, 0.1, 0.02);
}

TEST(Calibrate, SaysWhereItsRangeEnds) {
  EXPECT_TRUE(calibrate(measured(100, 0.1, 0, 1), model).is_at_bound);
  EXPECT_TRUE(calibrate(measured(1, 5, 0, 1), model).is_at_bound);
  EXPECT_FALSE(calibrate(measured(1, 0, 0, 1), model).is_at_bound);
}

TEST(Calibrate, HasNoErrorsBesideALineTensionAtWhichTheDropletClogs) {
  const Simulation clogging = [](double tension, double drag) {
    Profile profile = model(tension, drag);
    if (tension > 1) profile.resize(profile.size() / 2);
    return profile;
  };
  const Calibration beside = calibrate(measured(0.98, 0.1, 0.02, 2), clogging);
  EXPECT_LE(beside.line_tension, 1);
  EXPECT_TRUE(std::isnan(beside.line_tension_error));
  EXPECT_EQ(beside.num_never_reached, 0);
  const Calibration away = calibrate(measured(0.5, 0.1, 0.02, 2), clogging);
  EXPECT_GT(away.line_tension_error, 0);
}

/// A droplet whose speed in the neck falls to nothing at the line tension 1, where it clogs, with bumps whose
/// places depend on how near that is: Delta_v has narrow minima there.
Profile clogging(double tension, double drag) {
  Profile profile;
  for (double h = -1; h < 1; h += 0.004) {
    if (tension >= 1 && h > -0.1) break;
    const double neck = std::exp(-25 * h * h);
    const double bumps = 1 + 0.3 * std::sin(20 * h + 12 * std::log(std::max(1 - tension, 1e-9)));
    const double slow = (1 - std::min(tension, 1.0)) * bumps / (0.02 + drag);
    profile.push_back({h, 1 / (1 + drag * (1 - neck)) * (1 - neck) + neck * std::min(slow, 1.0) + 1e-4, 1});
  }
  return profile;
}

TEST(Calibrate, FindsANarrowMinimumBesideAClog) {
  for (const double tension : {0.91, 0.97, 0.985}) {
    std::mt19937 engine(5);
    std::normal_distribution<double> scatter(1, 0.02);
    Profile frames;
    const Profile all = clogging(tension, 0.3);
    for (std::size_t i = 5; i < all.size(); i += 10)
      frames.push_back({all[i].h, all[i].speed * scatter(engine), 1});
    const Calibration found = calibrate(frames, clogging);
    EXPECT_NEAR(found.line_tension, tension, 4 * found.line_tension_error);
    EXPECT_NEAR(found.near_wall_drag, 0.3, 4 * found.near_wall_drag_error);
    EXPECT_LT(found.line_tension_error, 0.01);
    EXPECT_LT(found.deviation.speed, 0.03) << tension;
    EXPECT_TRUE(found.is_converged);
    EXPECT_NEAR(found.clogging_tension, 1, 0.005);
  }
}

TEST(Calibrate, SaysThatItDidNotConverge) {
  // Every simulation comes nearer than all before, wherever it is: on however many threads, in any order.
  std::atomic<int> num_calls = 0;
  const Simulation ever_nearer = [&](double, double) {
    Profile profile = model(1, 0.1);
    const double excess = 1.0 / ++num_calls;
    for (Frame& frame : profile) frame.speed *= 1 + excess;
    return profile;
  };
  EXPECT_FALSE(calibrate(measured(1, 0.1, 0, 1), ever_nearer).is_converged);
}

TEST(Calibrate, TellsOfEverySimulationAndIsTheSameEveryTime) {
  std::mutex mutex;
  int num_told = 0;
  CalibrationAttempt best{.delta = 100};
  const Calibration found =
      calibrate(measured(1, 0.1, 0.02, 1), model, {}, [&](const CalibrationAttempt& attempt) {
        const std::scoped_lock lock(mutex);
        ++num_told;
        if (attempt.delta < best.delta) best = attempt;
      });
  EXPECT_EQ(found.num_simulations, num_told + 1);  // and the best once more
  EXPECT_LE(best.delta, found.deviation.speed + 1e-12);
  EXPECT_NEAR(best.line_tension, found.line_tension, found.line_tension_error);
  EXPECT_NEAR(best.near_wall_drag, found.near_wall_drag, found.near_wall_drag_error);
  const Calibration again = calibrate(measured(1, 0.1, 0.02, 1), model);
  EXPECT_EQ(found.line_tension, again.line_tension);
  EXPECT_EQ(found.num_simulations, again.num_simulations);
}

TEST(Calibrate, CountsTheFramesThatNoSimulationReaches) {
  const Simulation stuck = [](double tension, double drag) {
    Profile profile = model(tension, drag);
    profile.resize(profile.size() / 2);
    return profile;
  };
  const Profile frames = measured(1, 0.1, 0, 1);
  const Calibration found = calibrate(frames, stuck);
  EXPECT_NEAR(found.num_never_reached, static_cast<double>(frames.size()) / 2, 1);
  EXPECT_GT(found.deviation.speed, 5);
}

TEST(ResidualCorrelation, IsThatOfNoiseOrOfAnotherShape) {
  const Profile simulated = model(1, 0.1);
  const Profile noisy = measured(1, 0.1, 0.02, 1);
  const double most = 3 / std::sqrt(static_cast<double>(noisy.size()));
  EXPECT_LT(std::abs(residual_correlation(noisy, simulated).speed), most);
  Profile faster = noisy;  // its terminal speed is not what it was divided by
  for (Frame& frame : faster) frame.speed *= 1.2;
  EXPECT_GT(residual_correlation(faster, simulated).speed, 0.9);
  std::ranges::reverse(faster);
  EXPECT_GT(residual_correlation(faster, simulated).speed, 0.9) << "whatever the order of the frames";
  faster.resize(7);
  EXPECT_TRUE(std::isnan(residual_correlation(faster, simulated).speed));
}

TEST(Calibrate, RefusesTooFewFrames) {
  EXPECT_THROW(calibrate({{0, 1, 1}, {1, 1, 1}}, model), std::invalid_argument);
}

TEST(Calibrate, PassesOnWhatASimulationThrows) {
  std::atomic<int> num_calls = 0;
  const Simulation failing = [&](double tension, double drag) {
    if (++num_calls > 50) throw std::runtime_error("a droplet broke");  // after the grid
    return model(tension, drag);
  };
  try {
    calibrate(measured(1, 0.1, 0, 1), failing);
    FAIL() << "it went on";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "a droplet broke");
  }
}

TEST(Trials, OfOneHasNoDeviation) {
  const std::vector<Calibration> one{{.line_tension = 2, .near_wall_drag = 0.1}};
  EXPECT_EQ(combine(one).line_tension, 2);
  EXPECT_TRUE(std::isnan(combine(one).line_tension_deviation));
}

}  // namespace
}  // namespace clog::fit
