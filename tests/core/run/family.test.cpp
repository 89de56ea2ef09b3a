#include "clog/core/run/family.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"

namespace clog {
namespace {

/// Soft droplets that break up a few times within the time.
RunParameters soft_run(std::uint32_t seed) {
  RunParameters run;
  run.dp.line_tension = 0.05;
  run.dp.vertices = 64;
  run.dp.break_up_neck = 0.08;
  run.dp.self_contact_range = 0.02;
  run.dp.break_up = BreakUp::daughters;
  run.obstacles.box = 20;
  run.obstacles.density = 0.35;
  run.max_time = 700;
  run.seed = seed;
  return resolve(run);
}

std::shared_ptr<const ObstacleArray> walls_of(const RunParameters& run) {
  return std::make_shared<const ObstacleArray>(scene_of(run).walls(run));
}

FamilyRun finished(const RunParameters& parameters) {
  FamilyRun run(parameters, walls_of(parameters));
  while (!run.advance(1000)) continue;
  return run;
}

void expect_equal(const std::vector<Member>& a, const std::vector<Member>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].path, b[i].path);
    EXPECT_EQ(a[i].status, b[i].status);
    EXPECT_EQ(a[i].diameter, b[i].diameter);
    EXPECT_EQ(a[i].birth.distance, b[i].birth.distance);
    EXPECT_EQ(a[i].end.distance, b[i].end.distance);
    EXPECT_EQ(a[i].end.time, b[i].end.time);
  }
}

TEST(Family, KeepsItsArea) {
  std::size_t num_members = 0;
  for (const std::uint32_t seed : {1, 2, 3}) {
    const std::vector<Member> members = finished(soft_run(seed)).members();
    num_members += members.size();
    double area = 0;
    for (const Member& member : members)
      if (member.status != MemberEnd::broken) area += member.diameter * member.diameter;
    EXPECT_NEAR(area, 1, 1e-13);
  }
  EXPECT_GT(num_members, 8);
}

TEST(Family, BeginsWhereTheMotherEnds) {
  const std::vector<Member> members = finished(soft_run(1)).members();
  std::map<std::string, Member> by_path;
  for (const Member& member : members) by_path[member.path] = member;
  for (const Member& mother : members) {
    if (mother.status != MemberEnd::broken) continue;
    const Member &first = by_path.at(mother.path + '0'), &second = by_path.at(mother.path + '1');
    const auto mean = [&](double a, double b) {
      return (first.diameter * first.diameter * a + second.diameter * second.diameter * b) /
             (mother.diameter * mother.diameter);
    };
    EXPECT_NEAR(mean(first.birth.distance, second.birth.distance), mother.end.distance, 1e-9) << mother.path;
    EXPECT_NEAR(mean(first.birth.lateral, second.birth.lateral), mother.end.lateral, 1e-9) << mother.path;
    EXPECT_EQ(first.birth.time, mother.end.time);
  }
}

/// The run of an ancestor equals a run with break-up=end.
TEST(Family, HasTheAncestorOfARunThatEndsAtBreakUp) {
  RunParameters alone = soft_run(2);
  alone.dp.break_up = BreakUp::end;
  const FamilyRun family = finished(soft_run(2)), single = finished(alone);
  EXPECT_EQ(family.result().status, RunStatus::broken);
  EXPECT_EQ(family.result().distance, single.result().distance);
  EXPECT_EQ(family.result().steps, single.result().steps);
  EXPECT_TRUE(single.members().empty());
}

/// The speed of these daughters is NaN, so their runs cannot begin.
TEST(Family, OutlivesADaughterWhoseRunFails) {
  RunParameters run = soft_run(1);
  run.drag.speed_exponent = std::numeric_limits<double>::quiet_NaN();
  const FamilyRun family = finished(run);
  EXPECT_EQ(family.result().status, RunStatus::broken);
  const std::vector<Member>& members = family.members();
  ASSERT_EQ(members.size(), 3);
  for (const Member& member : {members[1], members[2]}) {
    EXPECT_EQ(member.status, MemberEnd::failed);
    EXPECT_EQ(member.end.distance, member.birth.distance);
    EXPECT_EQ(member.end.lateral, member.birth.lateral);
  }
}

/// The runs of daughters that are much too fast begin, but diverge. They must not change the row of the
/// ancestor. The area of a family is the sum over its leaves.
TEST(Family, OutlivesADaughterThatDiverges) {
  RunParameters run = soft_run(1);
  run.drag.speed_exponent = -20;
  const FamilyRun family = finished(run);
  EXPECT_EQ(family.result().status, RunStatus::broken);
  EXPECT_EQ(family.result().distance, finished(soft_run(1)).result().distance);
  int num_failed = 0;
  double area = 0;
  for (const Member& member : family.members()) {
    if (member.status != MemberEnd::broken) area += member.diameter * member.diameter;
    if (member.status != MemberEnd::failed) continue;
    ++num_failed;
    EXPECT_GT(member.end.time, member.birth.time);
    EXPECT_TRUE(std::isfinite(member.end.distance));
    EXPECT_TRUE(std::isnan(member.end.lateral));
    EXPECT_EQ(member.mechanism, ClogMechanism::none);
  }
  EXPECT_GT(num_failed, 0);
  EXPECT_NEAR(area, 1, 1e-13);
}

TEST(Family, RepeatsOneMember) {
  const RunParameters run = soft_run(1);
  const auto walls = walls_of(run);
  const std::vector<Member> members = finished(run).members();
  for (const Member& member : members) {
    const std::optional<Member> again = FamilyRun(run, walls).member(member.path);
    ASSERT_TRUE(again) << member.path;
    expect_equal({*again}, {member});
    std::optional<DropletRun> born = FamilyRun(run, walls).at_birth(member.path);
    ASSERT_EQ(born.has_value(), member.status != MemberEnd::small);
    if (!born) continue;
    EXPECT_EQ(born->time(), 0);
    while (!born->advance(1000)) continue;
    EXPECT_NEAR(member.birth.distance + member.diameter * born->result().distance, member.end.distance,
                1e-12);
  }
  EXPECT_FALSE(FamilyRun(run, walls).member("0000000"));
}

TEST(Family, ResumesFromASnapshotBitForBit) {
  const RunParameters run = soft_run(1);
  const auto walls = walls_of(run);
  FamilyRun whole(run, walls);
  std::vector<std::vector<std::byte>> snapshots;
  std::string last_path = "none";
  while (!whole.advance(200))
    if (whole.present_member().path != last_path) {
      last_path = whole.present_member().path;
      if (!last_path.empty()) snapshots.push_back(whole.snapshot());
    }
  ASSERT_GT(snapshots.size(), 1);
  for (const std::vector<std::byte>& snapshot : snapshots) {
    FamilyRun resumed = FamilyRun::resume(run, walls, snapshot);
    EXPECT_EQ(resumed.result().distance, whole.result().distance);
    EXPECT_EQ(resumed.result().neck.width, whole.result().neck.width);
    while (!resumed.advance(1000)) continue;
    expect_equal(resumed.members(), whole.members());
  }
}

TEST(Family, RefusesATornSnapshot) {
  const RunParameters run = soft_run(1);
  const auto walls = walls_of(run);
  FamilyRun family(run, walls);
  while (family.present_member().path.empty() && !family.advance(100)) continue;
  std::vector<std::byte> snapshot = family.snapshot();
  snapshot.resize(snapshot.size() / 2);
  EXPECT_THROW(FamilyRun::resume(run, walls, snapshot), Error);
}

/// In its own units a daughter is a droplet of diameter 1. The factors for lengths, times, speeds and Gamma
/// follow from the dimensions of these quantities.
TEST(Daughter, HasTheParametersOfItsSize) {
  const RunParameters ancestor = soft_run(1);
  const double d = 0.5;
  const RunParameters daughter = daughter_parameters(ancestor, d, 100, 40);
  EXPECT_EQ(daughter.dp.line_tension, ancestor.dp.line_tension / (d * d));
  EXPECT_EQ(daughter.obstacles.gap, ancestor.obstacles.gap / d);
  EXPECT_EQ(daughter.dp.break_up_neck, ancestor.dp.break_up_neck / d);
  EXPECT_DOUBLE_EQ(*daughter.obstacles.density.per_area, *ancestor.obstacles.density.per_area * d * d);
  EXPECT_DOUBLE_EQ(daughter.max_time, 100 / std::sqrt(d));
  // Speeds are in sqrt(sigma g), so a given speed is a larger number in the units of a smaller droplet.
  EXPECT_DOUBLE_EQ(daughter.drag.terminal_speed * std::sqrt(d), ancestor.drag.terminal_speed);
  RunParameters faster_if_large = ancestor;
  faster_if_large.drag.speed_exponent = 1;
  EXPECT_DOUBLE_EQ(daughter_parameters(faster_if_large, d, 100, 40).drag.terminal_speed * std::sqrt(d),
                   d * ancestor.drag.terminal_speed);
  EXPECT_EQ(daughter_parameters(ancestor, 0.02, 100, 40).dp.line_tension, 30);
}

TEST(Daughter, MeetsTheObstaclesOfItsAncestor) {
  const RunParameters run = soft_run(1);
  const ObstacleArray walls = *walls_of(run), scaled = obstacles_in_units_of(walls, 0.5);
  ASSERT_EQ(scaled.obstacles().size(), walls.obstacles().size());
  EXPECT_NEAR(scaled.smallest_gap(), 2 * walls.smallest_gap(), 1e-9);
  EXPECT_EQ(scaled.period().across(), 2 * walls.period().across());
}

}  // namespace
}  // namespace clog
