#include "clog/core/run/displacement_record.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace clog {
namespace {

TEST(DisplacementRecord, FindsTheSlopeOfSteadyMotion) {
  DisplacementRecord record;
  for (int i = 1; i <= 1000; ++i) record.add(0.1 * i, 0.03 * 0.1 * i);
  EXPECT_NEAR(record.travel_speed().mean, 0.03, 1e-12);
}

TEST(DisplacementRecord, LeavesOutTheTransient) {
  DisplacementRecord record;
  for (int i = 0; i <= 1000; ++i) record.add(i, i < 230 ? 0 : 0.02 * (i - 230));
  EXPECT_NEAR(record.travel_speed().mean, 0.02, 1e-12);
  EXPECT_NEAR(record.travel_speed().transient, 230, 5);
}

TEST(DisplacementRecord, LeavesOutTheTimeAfterTheArrest) {
  DisplacementRecord record;
  for (int i = 0; i <= 5000; ++i) record.add(i, 0.02 * std::min(i, 500));
  EXPECT_NEAR(record.travel_speed().mean, 0.02, 2e-4);
}

TEST(DisplacementRecord, KeepsTheSlopeOfAVeryLongRun) {
  DisplacementRecord record;
  for (int i = 0; i < 3'000'000; ++i) record.add(i, 0.01 * i + std::sin(0.001 * i));
  EXPECT_NEAR(record.travel_speed().mean, 0.01, 1e-5);
}

TEST(DisplacementRecord, HasNoSpeedWithoutMotion) {
  DisplacementRecord record;
  EXPECT_TRUE(std::isnan(record.travel_speed().mean));
  for (int i = 0; i < 100; ++i) record.add(i, 0.001 * i);
  EXPECT_TRUE(std::isnan(record.travel_speed().mean));
  EXPECT_TRUE(std::isnan(record.travel_speed().transient));
}

}  // namespace
}  // namespace clog
