#include "clog/laboratory/experiment.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "clog/core/tools/error.hpp"
#include "clog/laboratory/profile_file.hpp"

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
  // Cheng et al., calibration: octane droplets in water, gamma of about 10 mJ/m^2; digits as printed there.
  EXPECT_NEAR(octane(3.5, 28, 7).line_tension(), 0.57, 0.01);
  EXPECT_NEAR(octane(1.98, 8.5, 0.97).line_tension(), 5.80, 0.07);
  EXPECT_NEAR(octane(3.30, 5.0, 1.1).line_tension(), 3.47, 0.05);
  EXPECT_NEAR(octane(3.5, 28, 7).reduced_terminal_speed(), 0.08, 0.006);
  EXPECT_NEAR(octane(1.98, 8.5, 0.97).reduced_terminal_speed(), 0.028, 5e-4);
  EXPECT_NEAR(octane(3.30, 5.0, 1.1).reduced_terminal_speed(), 0.032, 5e-4);
}

TEST(Experiment, ScalesLineTensionsAsPublished) {
  // Gamma_exp goes the same way: 0.57 at 28 degrees and 3.5 mm, 5.80 and 3.47 in the other two experiments;
  // two digits are printed, and angles to a tenth of a degree. (The fitted 0.16 +- 0.01 scales to 1.59 and
  // 0.97, published are 1.7 +- 0.1 and 1.08 +- 0.09.)
  const Experiment calibrated = octane(3.5, 28, 7);
  EXPECT_NEAR(scaled_line_tension(0.57, calibrated, octane(1.98, 8.5, 0.97)), 5.80, 0.17);
  EXPECT_NEAR(scaled_line_tension(0.57, calibrated, octane(3.30, 5.0, 1.1)), 3.47, 0.10);
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

class ProfileFile : public testing::Test {
 protected:
  std::string path_ = testing::TempDir() + "clog_profile_" + std::to_string(::getpid()) + ".csv";
  void TearDown() override { std::filesystem::remove(path_); }

  fit::Profile read(const std::string& text, const ProfileScales& scales = {}) {
    std::ofstream(path_) << text;
    return read_profile(path_, scales);
  }
  std::string fault(const std::string& text, const ProfileScales& scales = {}) {
    try {
      read(text, scales);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(ProfileFile, IsReadInReducedUnits) {
  const fit::Profile profile = read("# by hand\nh [sigma], v [v_t], A\n-1,0.9,1.01\n\n0,0.4,\n1,0.8,1.02\n");
  ASSERT_EQ(profile.size(), 3u);
  EXPECT_EQ(profile[0].h, -1);
  EXPECT_EQ(profile[1].speed, 0.4);
  EXPECT_EQ(profile[2].shape, 1.02);
  EXPECT_TRUE(std::isnan(profile[1].shape));
}

TEST_F(ProfileFile, IsReadInMillimetresAndSeconds) {
  const fit::Profile profile =
      read("t [s],v [mm/s],h [mm]\r\n0,7,-3.5\r\n1,3.5,0\r\n2,10.5,7\r\n", {3.5e-3, 7e-3});
  ASSERT_EQ(profile.size(), 3u);
  EXPECT_NEAR(profile[0].h, -1, 1e-15);
  EXPECT_NEAR(profile[0].speed, 1, 1e-15);
  EXPECT_NEAR(profile[2].h, 2, 1e-15);
  EXPECT_NEAR(profile[2].speed, 1.5, 1e-15);
}

TEST_F(ProfileFile, SaysWhatIsWrongAndWhere) {
  EXPECT_NE(fault("h [mm],v [mm/s]\n1,1\n", {0, 1}).find("line 1: is in mm and needs --diameter"),
            std::string::npos);
  EXPECT_NE(fault("h,v\n1,1\n").find("no unit"), std::string::npos);
  EXPECT_NE(fault("h [furlong],v [v_t]\n").find("furlong"), std::string::npos);
  EXPECT_NE(fault("x,y\n1,1\n").find("columns h and v"), std::string::npos);
  EXPECT_NE(fault("h [sigma],v [v_t]\n1,1\n1,fast\n").find("line 3: 'fast' is not a finite number"),
            std::string::npos)
      << fault("h [sigma],v [v_t]\n1,1\n1,fast\n");
  EXPECT_NE(fault("h [sigma],v [v_t]\n1,1\n1\n").find("line 3: has too few columns"), std::string::npos);
  EXPECT_NE(fault("h [sigma],v [v_t]\n1,1\n").find("fewer than three frames"), std::string::npos);
  EXPECT_THROW(read_profile("/nowhere.csv", {}), Error);
}

}  // namespace
}  // namespace clog::laboratory
