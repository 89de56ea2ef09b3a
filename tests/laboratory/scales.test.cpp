#include "clog/laboratory/scales.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "clog/core/tools/error.hpp"

namespace clog::laboratory {
namespace {

TEST(SagOnWall, HasItsSoftLimit) {
  // The thickness of a wide puddle is 2 sqrt(Gamma). The puddle's centroid is at half of this height.
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

TEST(DensityDifference, AloneFixesGammaAndSetsTheOuterDensity) {
  const std::string droplet = "diameter=2mm\nangle=30deg\ntension=10mN/m\nspeed=7mm/s\n";
  const auto scales_for = [&](const char* densities) {
    return scales_of(parse_laboratory(droplet + densities, "text"));
  };
  // Gamma_exp = gamma/(g sin(angle) difference sigma^2) = 0.010/(9.81 0.5 150 0.002^2)
  for (const char* density : {"", "density=0.8g/ml", "density=1.9g/ml"}) {
    const Scales scales = scales_for((std::string("density-difference=0.15g/ml\n") + density).c_str());
    EXPECT_NEAR(scales.line_tension_experiment, 0.010 / (9.81 * 0.5 * 150 * 4e-6), 1e-9) << density;
  }
  const Scales by_difference = scales_for("density=0.8g/ml\ndensity-difference=150kg/m^3"),
               by_densities = scales_for("density=0.8g/ml\nouter-density=0.95g/ml");
  EXPECT_NEAR(by_difference.gravity, 9.81 * 0.5 * 150 / 800, 1e-12);
  EXPECT_NEAR(by_difference.terminal_speed, by_densities.terminal_speed, 1e-12);
  EXPECT_THROW(scales_for("outer-density=1g/ml\ndensity-difference=0.15g/ml"), Error);
  EXPECT_THROW(scales_for("density-difference=0g/ml"), Error);
}

TEST(TiltOf, IsThatOfTheLaboratoryForItsOwnGamma) {
  const Laboratory lab = parse_laboratory("diameter=2mm\nangle=30deg\ntension=10mN/m\n", "text");
  const Scales scales = scales_of(lab);
  EXPECT_NEAR(tilt_of(scales.line_tension, lab), std::numbers::pi / 6, 1e-12);
  EXPECT_TRUE(std::isnan(tilt_of(0.1 * scales.line_tension, lab))) << "not even upright";
  EXPECT_TRUE(std::isnan(scales.terminal_speed)) << "no speed is given";
}

TEST(InModelUnits, ConvertsEachNumberThatHasAUnit) {
  const Scales scales{.length = 2e-3, .time = 0.5, .tension = 4e-3};
  EXPECT_EQ(in_model_units("obstacle-gap", "0.5mm, 600 um,0.3sigma,0.4", scales), "0.25, 0.3,0.3,0.4");
  EXPECT_EQ(in_model_units("obstacle-gap", "log(0.2mm,2e0mm,3)", scales), "log(0.1,1,3)");
  EXPECT_EQ(in_model_units("obstacle-gap", "500µm,lin(200 μm,1mm,3)", scales), "0.25,lin(0.1,0.5,3)");
  EXPECT_EQ(in_model_units("obstacle-gap", "-1mm, lin(1mm", scales), "-0.5, lin(0.5");
  EXPECT_EQ(in_model_units("obstacle-density", "0.5/mm^2,saturated,12%", scales), "2,saturated,12%");
  for (const char* area : {"0.5/mm2", "0.5/mm²", "0.5 /mm^2", "0.5e-6/µm²"})
    EXPECT_EQ(in_model_units("obstacle-density", area, scales), "2") << area;
  EXPECT_EQ(in_model_units("max-time", "2min", scales), "240");
  EXPECT_EQ(in_model_units("terminal-speed", "1 mm/s", scales), "0.25");
  EXPECT_EQ(in_model_units("line-tension", "2mN/m", scales), "0.5");
  for (const auto& [key, text] :
       {std::pair{"obstacle-gap", "3s"}, {"vertices", "64mm"}, {"obstacle-gap", "1foot"}})
    EXPECT_THROW(in_model_units(key, text, scales), Error) << key;
}

TEST(Laboratory, KeepsItsLinesWithoutComments) {
  const Laboratory lab = parse_laboratory("# mine\nangle = 90 deg # upright\n\ndiameter=200um\n", "text");
  EXPECT_EQ(lab.text, "angle = 90 deg; diameter = 0.2 mm");
  EXPECT_EQ(parse_laboratory(lab.text, "text").text, lab.text);
  EXPECT_THROW(parse_laboratory("angle = 90 deg\n", "text"), Error);
}

}  // namespace
}  // namespace clog::laboratory
