#include "clog/results/activity.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace clog::results {
namespace {

nlohmann::json told(const Activity& activity, double now) {
  return nlohmann::json::parse(activity.line("2026-01-01T00:00:00Z", now));
}

TEST(Activity, CountsBusyRanksAndWhatIsLostToTheTail) {
  Activity activity(2);
  activity.started(0);
  activity.started(0);
  activity.ended(2);
  activity.started(3);  // a rank was idle for a second, but this was not at the end of the sweep
  activity.ended(4);
  activity.ended(6.5);
  const nlohmann::json line = told(activity, 6.5);
  EXPECT_EQ(line["busy"].get<std::vector<double>>(), (std::vector<double>{2, 2, 1, 2, 1, 1, 1}));
  EXPECT_EQ(line["idle_seconds"], 3.5);
  EXPECT_EQ(line["tail_seconds"], 2.5);
  EXPECT_EQ(line["ranks"], 2);
}

TEST(Activity, KeepsTheSumWhenStretchesGetLonger) {
  Activity activity(3);
  double busy = 0;
  for (int i = 0; i < 5000; ++i) {
    activity.started(2.0 * i);
    activity.ended(2.0 * i + 1.25);
    busy += 1.25;
  }
  const double now = 9999;
  const nlohmann::json line = told(activity, now);
  EXPECT_LE(line["busy"].size(), 200u);
  double sum = 0;
  for (const double mean : line["busy"]) sum += mean * line["stretch"].get<double>();
  EXPECT_NEAR(sum, busy, 0.01 * busy);
  EXPECT_NEAR(line["idle_seconds"], 3 * now - busy, 0.01);
}

TEST(Activity, CountsRestarts) {
  Activity activity(1);
  activity.started(0);
  EXPECT_EQ(told(activity, 1)["restarts"], 0);
  activity.restarted();
  EXPECT_EQ(told(activity, 1)["restarts"], 1);
}

TEST(Activity, KeepsTheLatestSessions) {
  std::string lines;
  for (int i = 0; i < 60; ++i) lines = with_session(lines, std::to_string(i) + "\n");
  EXPECT_TRUE(lines.starts_with("10\n"));
  EXPECT_TRUE(lines.ends_with("59\n"));
}

}  // namespace
}  // namespace clog::results
