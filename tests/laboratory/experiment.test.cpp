#include "clog/laboratory/experiment.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "clog/core/tools/error.hpp"

namespace clog::laboratory {
namespace {

Experiment octane(double diameter_mm, double angle_degrees, double speed_mm_per_s) {
  return {.diameter = 1e-3 * diameter_mm,
          .terminal_speed = 1e-3 * speed_mm_per_s,
          .tilt = angle_degrees * std::numbers::pi / 180,
          .droplet_density = 703,
          .outer_density = 997,
          .interfacial_tension = 9.6e-3};
}

TEST(Experiment, GivesThePublishedNumbers) {
  // These droplets of octane in water are from the calibration of Cheng et al., with gamma about 10 mJ/m^2.
  // The expected numbers have the digits printed there.
  EXPECT_NEAR(octane(3.5, 28, 7).line_tension(), 0.57, 0.01);
  EXPECT_NEAR(octane(1.98, 8.5, 0.97).line_tension(), 5.80, 0.07);
  EXPECT_NEAR(octane(3.30, 5.0, 1.1).line_tension(), 3.47, 0.05);
  EXPECT_NEAR(octane(3.5, 28, 7).reduced_terminal_speed(), 0.08, 0.006);
  EXPECT_NEAR(octane(1.98, 8.5, 0.97).reduced_terminal_speed(), 0.028, 5e-4);
  EXPECT_NEAR(octane(3.30, 5.0, 1.1).reduced_terminal_speed(), 0.032, 5e-4);
}

TEST(Units, AreReadWithAndWithoutSpace) {
  EXPECT_DOUBLE_EQ(to_si("3.5mm", "length"), 3.5e-3);
  EXPECT_DOUBLE_EQ(to_si("3.5 mm", "length"), 3.5e-3);
  EXPECT_DOUBLE_EQ(to_si("3.5e-3m", "length"), 3.5e-3);
  EXPECT_DOUBLE_EQ(to_si("7mm/s", "speed"), 7e-3);
  EXPECT_DOUBLE_EQ(to_si("180deg", "angle"), std::numbers::pi);
  EXPECT_DOUBLE_EQ(to_si("10 mJ/m^2", "tension"), 0.01);
  EXPECT_DOUBLE_EQ(to_si("0.703g/ml", "density"), 703);
  EXPECT_THROW(to_si("3.5", "length"), Error);
  EXPECT_THROW(to_si("3.5 inch", "length"), Error);
  EXPECT_THROW(to_si("mm", "length"), Error);
}

}  // namespace
}  // namespace clog::laboratory
