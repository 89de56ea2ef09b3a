#include "clog/laboratory/scales.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "clog/core/tools/error.hpp"

namespace clog::laboratory {
namespace {

TEST(SagOnWall, HasItsSoftLimit) {
  // A wide puddle is 2 sqrt(Gamma) thick, and its centroid in the middle.
  EXPECT_NEAR(sag_on_wall(0.002), 0.5 - std::sqrt(0.002), 0.003);
}

TEST(SagOnWall, FallsWithTheLineTension) {
  double before = 0.5;
  for (const double line_tension : {0.01, 0.1, 1.0, 10.0, 100.0}) {
    const double sag = sag_on_wall(line_tension);
    EXPECT_GT(sag, 0);
    EXPECT_LT(sag, before);
    before = sag;
  }
  EXPECT_LT(before, 1e-2);
}

TEST(SagOnWall, IsNotKnownBeyondWhatIsTested) {
  EXPECT_TRUE(std::isnan(sag_on_wall(0)));
  EXPECT_TRUE(std::isnan(sag_on_wall(1e6)));
  EXPECT_TRUE(std::isnan(line_tension_of_sag(0.6)));
}

TEST(SagOnWall, CanBeInverted) {
  for (const double line_tension : {0.03, 0.7, 20.0})
    EXPECT_NEAR(line_tension_of_sag(sag_on_wall(line_tension)) / line_tension, 1, 1e-6);
}

TEST(TiltOf, IsThatOfTheLaboratoryForItsOwnGamma) {
  const Laboratory lab = parse_laboratory("diameter=2mm\nangle=30deg\ntension=10mN/m\n", "text");
  const Scales scales = scales_of(lab);
  EXPECT_NEAR(tilt_of(scales.line_tension, lab), std::numbers::pi / 6, 1e-12);
  EXPECT_TRUE(std::isnan(tilt_of(0.1 * scales.line_tension, lab))) << "not even upright";
  EXPECT_TRUE(std::isnan(scales.terminal_speed)) << "no speed is given";
}

TEST(Laboratory, KeepsItsLinesWithoutComments) {
  const Laboratory lab = parse_laboratory("# mine\nangle = 90 deg # upright\n\ndiameter=200um\n", "text");
  EXPECT_EQ(lab.text, "angle = 90 deg; diameter = 200um");
  EXPECT_EQ(parse_laboratory(lab.text, "text").text, lab.text);
  EXPECT_THROW(parse_laboratory("angle = 90 deg\n", "text"), Error);
}

}  // namespace
}  // namespace clog::laboratory
