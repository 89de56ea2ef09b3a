#include "clog/core/run/steady_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace clog {
namespace {

constexpr double terminal_speed = 0.5;
constexpr double start = SteadyRecord::free_fall / terminal_speed;

/// The place of a droplet that falls freely until the time `fall`, and then at half the terminal speed. There
/// is a check per t0.
double place_at(double time, double fall) {
  return terminal_speed * (std::min(time, fall) + 0.5 * std::max(0.0, time - fall));
}

SteadyRecord record_until(double end, double fall) {
  SteadyRecord record(terminal_speed);
  for (double time = 1; time <= end; ++time) record.add(time, place_at(time, fall));
  return record;
}

TEST(SteadyRecord, ExcludesTheFastStartWithoutLookingAtTheSpeed) {
  const SteadyTravel travel = record_until(110, 8).until(110, place_at(110, 8));
  EXPECT_EQ(travel.time, 110 - start);
  EXPECT_DOUBLE_EQ(travel.distance / travel.time, 0.5 * terminal_speed);
}

TEST(SteadyRecord, BeginsAtTheSameTimeForEveryDroplet) {
  for (const double fall : {0.0, 5.0, 50.0, 200.0})
    EXPECT_EQ(record_until(100, fall).until(100, place_at(100, fall)).time, 100 - start);
}

TEST(SteadyRecord, ARunThatEndsByTheStartHasNoSteadyTravel) {
  for (const double end : {1.0, start - 1, start}) {
    const SteadyTravel travel = record_until(end, 0).until(end, place_at(end, 0));
    EXPECT_TRUE(std::isnan(travel.time) && std::isnan(travel.distance)) << end;
  }
  EXPECT_EQ(record_until(start + 1, 0).until(start + 1, place_at(start + 1, 0)).time, 1);
}

TEST(SteadyRecord, ADropletArrestedByTheStartHasNoSteadyTravel) {
  const SteadyRecord record = record_until(100, 0);
  EXPECT_TRUE(std::isnan(record.until(start - 2, 1).time));
  EXPECT_TRUE(std::isnan(record.until(start, 1).time));
}

}  // namespace
}  // namespace clog
