#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/droplet/release.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/parameters/circles.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "refusal.hpp"

namespace clog {
namespace {

RunParameters among(std::vector<Obstacle> circles) {
  RunParameters run;
  run.dp.vertices = 64;
  run.obstacles.layout = ObstacleLayout::file;
  run.obstacles.box = 10;
  run.obstacles.own = OwnCircles(std::move(circles), "posts.csv");
  return run;
}

TEST(OwnCircles, AreKnownByAStandardCheckSum) {
  // The three numbers have 24 bytes: "123456789" and 15 zeros. The CRC-64/XZ of these bytes was computed bit
  // by bit with Python.
  Obstacle text;
  const char bytes[sizeof text] = "123456789";
  std::memcpy(&text, bytes, sizeof text);
  EXPECT_EQ(OwnCircles({text}).check_sum(), "b2f0675da29a87f6");
  EXPECT_NE(OwnCircles({{1, 2, 3}}), OwnCircles({{1, 2, 4}}));
  EXPECT_EQ(OwnCircles({{1, 2, 3}}, "a"), OwnCircles({{1, 2, 3}}, "b"));
  const OwnCircles known({{1, 2, 3}});
  const OwnCircles other = OwnCircles::from_check_sum(known.check_sum());
  EXPECT_EQ(other, known);
  EXPECT_FALSE(other.are_known());
  EXPECT_THROW(other.circles(), Error);
  for (const char* wrong : {"", "12", "123456789012345g", "12345678901234567"})
    EXPECT_THROW(OwnCircles::from_check_sum(wrong), Error) << wrong;
}

TEST(OwnCircles, HaveTheGapAndTheDensityOfTheirFile) {
  const RunParameters run = resolve(among({{2, 5, 0.25}, {3, 5, 0}}));
  EXPECT_NEAR(run.obstacles.gap, 1 - 0.25 - 0.15, 1e-12) << "a radius of 0 is half of obstacle-diameter";
  EXPECT_DOUBLE_EQ(run.obstacles.density.per_area.value(), 0.02);
  EXPECT_EQ(scene_of(run).walls(run).obstacles().size(), 2u);
  EXPECT_EQ(resolve(run).obstacles, run.obstacles) << "resolved once more nothing changes";
}

TEST(OwnCircles, AreRefusedWithTheirPlaces) {
  test::expect_refused(among({{2, 5, 0.5}, {2.5, 5, 0.5}}),
                       "posts.csv (those at x=2, y=5 and x=2.5, y=5 overlap by 0.5 sigma)");
  test::expect_refused(among({{0.1, 5, 0.5}, {9.4, 5, 0.5}}), "periodic images");
  test::expect_refused(among({{11, 5, 0.5}}), "outside the array");
  test::expect_refused(among({{700, 125, 60}}), "first line such as # units=um droplet=200um");
  test::expect_refused(among({{std::nan(""), 5, 0.5}}), "outside the array");
  test::expect_refused(among({{5, 5, 5}}), "periodic image");
  test::expect_refused(among({{5, 5, 0.5}, {6.04, 5, 0.5}}), "not wider than an edge");
  RunParameters none = among({});
  test::expect_refused(none, "there are none");
  none.obstacles.own.reset();
  test::expect_refused(none, "obstacles=FILE.csv");
}

RunParameters between_walls(std::vector<Obstacle> circles) {
  RunParameters run = among(std::move(circles));
  run.obstacles.length = 23.5;
  run.obstacles.side_walls = SideWalls::on;
  run.obstacles.release = Release::entrance;
  run.obstacles.entrance = 2;
  run.obstacles.exit = 20;
  return run;
}

TEST(OwnCircles, InARowAreOnePostThatMayGrowOutOfAWall) {
  std::vector<Obstacle> row = {{9, 3, 0.3}};
  for (int i = 0; i < 20; ++i) row.push_back({12, 0.05 + 0.1 * i, 0.2});
  const RunParameters run = resolve(between_walls(row));
  EXPECT_NEAR(run.obstacles.gap, std::hypot(3, 3 - 1.95) - 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(run.obstacles.density.per_area.value(), 2 / 235.0) << "two posts";
  // The gap between the first circle and the wall becomes 0.005.
  for (Obstacle& circle : row) circle.y += 0.155;
  test::expect_refused(between_walls(row), "at the wall");
}

TEST(OwnCircles, AreShiftedSoThatTheDropletStartsAnywhere) {
  // If n places are uniform, the mean of cos(2 pi x/L) is 0 within its standard error, which is 1/sqrt(2 n).
  RunParameters run = resolve(among({{5, 5, 0.3}}));
  const ObstacleArray fixed = scene_of(run).walls(run);
  EXPECT_EQ(fixed.obstacles()[0].x, 5);
  run.obstacles.release = Release::anywhere;
  double sum_x = 0, sum_y = 0;
  constexpr int number = 2000;
  for (run.seed = 0; run.seed < number; ++run.seed) {
    const ObstacleArray walls = scene_of(run).walls(run);
    sum_x += std::cos(2 * std::numbers::pi * walls.obstacles()[0].x / 10);
    sum_y += std::cos(2 * std::numbers::pi * walls.obstacles()[0].y / 10);
  }
  const double error = 1 / std::sqrt(2.0 * number);
  EXPECT_LT(std::abs(sum_x / number), 4 * error);
  EXPECT_LT(std::abs(sum_y / number), 4 * error);
}

TEST(OwnCircles, MayBeAnyLengthAndFindEachOtherOverItsBorder) {
  RunParameters run = among({{0.2, 5, 0.25}, {23.2, 5, 0.25}});
  run.obstacles.length = 23.5;
  test::expect_refused(run, "x=23.2, y=5 touch)");
  run.obstacles.own = OwnCircles({{0.2, 5, 0.25}, {22.9, 5, 0.25}});
  EXPECT_NEAR(resolve(run).obstacles.gap, 0.8 - 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(resolve(run).obstacles.density.per_area.value(), 2 / 235.0);
  run.obstacles.boxes = 2;
  test::expect_refused(run, "boxes=2");
}

TEST(OwnCircles, StandBetweenWallsWithoutImagesAcross) {
  // In a periodic array these circles would overlap across the border of the box.
  const RunParameters run = resolve(between_walls({{12, 0.1, 0.3}, {12, 9.9, 0.3}}));
  const ObstacleArray device = scene_of(run).walls(run);
  ASSERT_EQ(device.wedges().size(), 2u);
  EXPECT_DOUBLE_EQ(device.wedges()[1].tip[1] - device.wedges()[0].tip[1], 10);
  EXPECT_GT(device.smallest_gap(), 1) << "images are beyond the walls, out of reach";
}

TEST(OwnCircles, AreEnteredOnALineAndLeftAtTheExit) {
  RunParameters run = between_walls({{12, 5, 0.3}});
  run.obstacles.entrance_from = 3;
  run.obstacles.entrance_to = 4;
  run = resolve(run);
  const Scene& scene = scene_of(run);
  for (run.seed = 1; run.seed <= 20; ++run.seed) {
    const ObstacleArray device = scene.walls(run);
    const DropletState start = scene.release(run, device);
    const Eigen::Array2d place = start.frame.global(start.centre());
    const Eigen::Array2d in_file = scene.place_in_file(run, place);
    EXPECT_NEAR(in_file[0], 2, 1e-9) << "free, so just there";
    EXPECT_GE(in_file[1], 3 - 1e-9);
    EXPECT_LE(in_file[1], 4 + 1e-9);
    EXPECT_NEAR(scene.passing_distance(run, place), 18, 1e-9);
  }
}

TEST(OwnCircles, RefuseWaysThatCannotBe) {
  RunParameters run = between_walls({{12, 5, 0.3}});
  run.obstacles.exit = 2;
  test::expect_refused(run, "exit=2 (must lie downstream");
  run.obstacles.exit = 24;
  test::expect_refused(run, "exit=24");
  run.obstacles.exit = 20;
  run.obstacles.release = Release::anywhere;
  test::expect_refused(run, "entrance=2 (the droplet is not released on a line)");
  run.obstacles.entrance = 0;
  test::expect_refused(run, "exit=20");
  run = between_walls({{12, 0.34, 0.3}});
  test::expect_refused(run, "at the wall");
}

TEST(OwnCircles, OfASingleOneHaveTheGapToItsPeriodicImage) {
  RunParameters run = among({{5, 5, 3}});
  run.obstacles.diameter = 6;
  EXPECT_DOUBLE_EQ(resolve(run).obstacles.gap, 10 - 6);
  EXPECT_DOUBLE_EQ(resolve(between_walls({{12, 5, 3}})).obstacles.gap, 23.5 - 6) << "none beyond the walls";
  EXPECT_NEAR(resolve(between_walls({{4, 0.1, 0.3}, {10, 9.5, 0.3}})).obstacles.gap, std::hypot(6, 9.4) - 0.6,
              1e-12);
}

TEST(OwnCircles, AreRefusedInAPeriodInWhichTheDropletMeetsItsImage) {
  RunParameters run = among({{1, 1, 0.2}});
  run.obstacles.box = 4.9;
  test::expect_refused(run, "box=4.9 (the droplet would meet its own periodic image) use at least 5");
  run.obstacles.side_walls = SideWalls::on;
  test::expect_refused(run, "length=4.9 (the droplet would meet its own periodic image along the flow)");
  run.obstacles.boxes = 2;
  EXPECT_EQ(test::refusal_of(run), "");
}

/// A channel that is hardly wider than the droplet. One wall has a bump of radius 0.4.
RunParameters narrow_channel(double width, double line_tension) {
  RunParameters run = between_walls({{8, 0, 0.4}});
  run.obstacles.box = width;
  run.obstacles.entrance = 4;
  run.obstacles.exit = 12;
  run.dp.line_tension = line_tension;
  run.max_time = 2000;
  return resolve(run);
}

RunResult end_of(const RunParameters& run) {
  DropletRun droplet(run);
  while (!droplet.advance(1000)) continue;
  return droplet.result();
}

TEST(OwnCircles, BlockOrPassADropletInANarrowChannelByItsStiffness) {
  // A width of 1.45 - 0.4 is free beside the bump, where a circle of diameter 1 fits. A width of 1.05 - 0.4
  // has room only for a soft droplet.
  EXPECT_EQ(end_of(narrow_channel(1.45, 3)).status, RunStatus::passed);
  EXPECT_EQ(end_of(narrow_channel(1.05, 0.1)).status, RunStatus::passed);
  const RunResult stiff = end_of(narrow_channel(1.05, 3));
  EXPECT_EQ(stiff.status, RunStatus::clogged);
  // The stiff droplet rests on the bump and on the opposite wall, approximately where a circle of radius 1/2
  // touches this wall and the bump, which is a circle of radius 0.4 at (8, 0).
  const double height = 1.05 - 0.5, reach = 0.5 + 0.4;
  EXPECT_NEAR(stiff.release[0] + stiff.distance, 8 - std::sqrt(reach * reach - height * height), 0.1);
}

TEST(OwnCircles, LetADropletPassBetweenWallsWhichHoldIt) {
  // The gap between the circle and the wall is narrower than the droplet.
  RunParameters run = between_walls({{8, 1.75, 0.8}});
  run.dp.line_tension = 0.3;
  run.obstacles.box = 5;
  run.obstacles.entrance_from = run.obstacles.entrance_to = 0.9;
  run.obstacles.exit = 12;
  run.max_time = 2000;
  const RunResult result = end_of(resolve(run));
  EXPECT_EQ(result.status, RunStatus::passed);
  EXPECT_NEAR(result.release[0], 2, 1e-9);
  EXPECT_NEAR(result.release[0] + result.distance, 12, 0.2);
  EXPECT_GT(result.release[1] + result.lateral, 0.4) << "not through the wall";
}

/// A device with up to four random circles, some larger than the droplet, in a box of random size. Most
/// random circles are refused because they overlap, and are drawn again.
RunParameters random_device(std::mt19937& random, Model model, Release release) {
  const auto draw = [&](double from, double to) { return std::uniform_real_distribution(from, to)(random); };
  while (true) {
    RunParameters run;
    run.model = model;
    if (model == Model::dp) run.dp.vertices = 64;
    if (model == Model::sp) run.wall_stiffness = 1;
    run.obstacles.layout = ObstacleLayout::file;
    run.obstacles.box = draw(5, 12);
    run.obstacles.length = draw(5, 12);
    const double smaller = std::min(run.obstacles.box, run.obstacles.length);
    std::vector<Obstacle> circles(std::uniform_int_distribution<std::size_t>(1, 4)(random));
    for (Obstacle& circle : circles)
      circle = {draw(0, run.obstacles.length), draw(0, run.obstacles.box), draw(0.1, 0.4 * smaller)};
    run.obstacles.own = OwnCircles(circles);
    run.obstacles.release = release;
    if (release == Release::entrance) {
      run.obstacles.entrance = draw(0, 0.9 * run.obstacles.length);
      run.obstacles.exit = draw(run.obstacles.entrance + 0.1, run.obstacles.length);
    }
    run.seed = static_cast<std::uint32_t>(random());
    run.max_time = 10;
    if (test::refusal_of(run).empty()) return resolve(run);
  }
}

/// Distance between a place and the nearest surface of a circle or of one of its periodic images.
double room_at(const Eigen::Array2d& place, const ObstacleParameters& obstacles) {
  const Period period = obstacles.period();
  double room = std::numeric_limits<double>::infinity();
  for (const Obstacle& circle : obstacles.own->circles())
    room = std::min(room, std::hypot(std::remainder(place[0] - circle.x, period.along()),
                                     std::remainder(place[1] - circle.y, period.across())) -
                              circle.radius);
  return room;
}

TEST(OwnCircles, LetDropletsStartWithinTheBoxWhereverTheyAre) {
  std::mt19937 random(7);
  int num_across_the_border = 0;
  for (const Model model : {Model::dp, Model::sp})
    for (const Release release : {Release::anywhere, Release::entrance, Release::centre})
      for (int i = 0; i < 40; ++i) {
        const RunParameters run = random_device(random, model, release);
        const ObstacleParameters& obstacles = run.obstacles;
        const Scene& scene = scene_of(run);
        const ObstacleArray device = scene.walls(run);
        DropletState start;
        try {
          start = scene.release(run, device);
        } catch (const Error&) {
          continue;  // there is no void that is large enough
        }
        const Eigen::Array2d place = start.frame.global(start.centre());
        const Eigen::Array2d in_file = scene.place_in_file(run, place);
        ASSERT_GE(in_file.minCoeff(), 0);
        ASSERT_LT(in_file[0], obstacles.length);
        ASSERT_LT(in_file[1], obstacles.box);
        // The distance to the nearest circle must be the same in the file as in the array. A soft disk may
        // overlap this circle.
        ASSERT_NEAR(room_at(in_file, obstacles),
                    std::min(clearance(device, place[0], place[1], 12), room_at(in_file, obstacles)), 1e-9);
        const double least_room = model == Model::dp ? 0 : -1;
        ASSERT_GT(room_at(in_file, obstacles), least_room);
        ASSERT_LE(start.centre().abs().maxCoeff(), 1.5) << "near the origin of its frame";
        if ((place < 0).any() || place[0] >= obstacles.length || place[1] >= obstacles.box)
          ++num_across_the_border;
        if (obstacles.exit == 0) continue;
        const double way = scene.passing_distance(run, place);
        ASSERT_NEAR(std::remainder(in_file[0] + way - obstacles.exit, obstacles.length), 0, 1e-9);
        ASSERT_LE(std::abs(obstacles.exit - way - obstacles.entrance), obstacles.length / 2 + 1e-9);
      }
  EXPECT_GE(num_across_the_border, 10) << "the case is tested";
}

TEST(OwnCircles, LetDropletsStartBetweenWallsWhateverTheRoundOff) {
  for (const Model model : {Model::dp, Model::sp})
    for (const double box : {1.5, 3.0, 6.0, 7.0, 8.0}) {
      RunParameters run = among({{6, box / 2, 0.15}});
      run.model = model;
      if (model == Model::sp) run.dp = {}, run.wall_stiffness = 1;
      run.obstacles.box = box;
      run.obstacles.length = 14;
      run.obstacles.side_walls = SideWalls::on;
      run.obstacles.release = Release::anywhere;
      run = resolve(run);
      for (run.seed = 1; run.seed <= 20; ++run.seed) {
        const DropletState start = scene_of(run).release(run, scene_of(run).walls(run));
        const double y = scene_of(run).place_in_file(run, start.frame.global(start.centre()))[1];
        EXPECT_GT(y, 0);
        EXPECT_LT(y, box);
      }
    }
}

TEST(OwnCircles, HaveTheirDropletStartUpstreamIfTheVoidIsAcrossTheBorder) {
  // The only void is around the corner of the box.
  RunParameters run = among({{5, 5, 4}});
  run.obstacles.release = Release::entrance;
  run.obstacles.entrance = 3;
  run.obstacles.exit = 10;
  run = resolve(run);
  int num_upstream = 0;
  for (run.seed = 1; run.seed <= 20; ++run.seed) {
    DropletRun droplet(run);
    droplet.advance(1);
    const RunResult result = droplet.result();
    EXPECT_EQ(result.status, RunStatus::running);
    EXPECT_GE(result.release.minCoeff(), 0);
    EXPECT_LT(result.release.maxCoeff(), 10);
    if (result.release[0] > 8) ++num_upstream;
  }
  EXPECT_GE(num_upstream, 3);
}

}  // namespace
}  // namespace clog
