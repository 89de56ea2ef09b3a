#include "clog/sweep/row_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace clog::sweep {
namespace {

using Keys = std::vector<std::pair<const char*, const char*>>;

Plan limits_plan(const Keys& keys) {
  Settings settings;
  settings.set("seeds", "1..3");
  for (const auto& [name, text] : keys) settings.set(name, text);
  return Plan(settings);
}

RunRow limits_row(const Keys& keys) { return describe(limits_plan(keys).task(0)); }

TEST(UntestedParameters, AreNoneWithinWhatWasFoundSound) {
  const Keys sound[] = {{},
                        {{"line-tension", "0.05"}},
                        {{"line-tension", "10"}, {"vertices", "256"}},
                        {{"line-tension", "0.05"}, {"vertices", "64"}},
                        {{"preset", "elastic"}, {"line-tension", "0.04"}},
                        {{"preset", "heavy-interface"}, {"line-tension", "0.1"}},
                        {{"receding-angle", "120"}},
                        {{"preset", "elastic"}, {"friction", "0.5"}},
                        {{"model", "sp"}, {"wall-stiffness", "1"}}};
  for (const Keys& keys : sound) EXPECT_TRUE(untested_parameters(limits_row(keys)).empty());
}

TEST(UntestedParameters, AreNamedWithTheirValueBeyondIt) {
  const std::pair<Keys, const char*> untested[] = {
      {{{"line-tension", "0"}}, "line-tension=0 (robust is tested from 0.05 to 10)"},
      {{{"line-tension", "30"}}, "line-tension=30 (robust is tested from 0.05 to 10)"},
      {{{"line-tension", "0.01"}}, "line-tension=0.01 (robust is tested from 0.05 to 10)"},
      {{{"preset", "elastic"}, {"line-tension", "0.03"}},
       "line-tension=0.03 (elastic is tested from 0.04 to 10)"},
      {{{"preset", "heavy-interface"}, {"line-tension", "0.09"}},
       "line-tension=0.09 (heavy-interface is tested from 0.1 to 10)"},
      {{{"preset", "literal"}}, "preset=literal (droplets cross themselves and obstacles)"},
      {{{"self-contact", "off"}}, "preset=custom (this interface was not tested)"},
      {{{"receding-angle", "50"}}, "receding-angle=50 (tested from 60 on)"},
      {{{"preset", "elastic"}, {"friction", "0.6"}}, "friction=0.6 (tested up to 0.5)"},
      {{{"preset", "elastic"}, {"yield-traction", "0.2"}},
       "yield-traction=0.2 (tested up to 0.1 g rho sigma)"},
      {{{"vertices", "32"}}, "vertices=32 (tested from 64 to 1024)"},
      {{{"vertices", "2048"}}, "vertices=2048 (tested from 64 to 1024)"},
      {{{"obstacle-diameter", "0.04"}, {"vertices", "128"}},
       "obstacle-diameter=0.04 (obstacles thinner than two edges, 0.04909, slip into the droplet; use more "
       "vertices)"}};
  for (const auto& [keys, words] : untested)
    EXPECT_EQ(untested_parameters(limits_row(keys)), std::vector<std::string>{words});
}

TEST(UntestedParameters, OfAPlanAreNamedOnceEach) {
  EXPECT_EQ(untested_parameters(limits_plan({{"line-tension", "0.1,1"}})), "");
  EXPECT_EQ(untested_parameters(limits_plan({{"line-tension", "0,1,30"}, {"obstacle-gap", "0.2,0.3"}})),
            "outside the range tested for soundness (handbook, How far to trust it): line-tension=0 "
            "(robust is tested from "
            "0.05 to 10), "
            "line-tension=30 (robust is tested from 0.05 to 10)");
  EXPECT_TRUE(
      untested_parameters(limits_plan({{"line-tension", "11,12,13,14,15,16"}})).ends_with(", and 2 more"));
}

TEST(Repetition, BeginsWhereADropletHasComeFartherThanTheBox) {
  RunRow row = limits_row({{"box", "20"}});
  EXPECT_EQ(repetition_length(row), 20);
  row.distance = 20;
  EXPECT_FALSE(has_met_repetition(row));
  row.distance = 20.1;
  EXPECT_TRUE(has_met_repetition(row));
  row.parameters.obstacles.density = 1;
  EXPECT_TRUE(has_met_repetition(row));
  row.parameters.obstacles.layout = ObstacleLayout::file;
  EXPECT_TRUE(has_met_repetition(row));
  row.parameters.obstacles.layout = ObstacleLayout::channel;
  EXPECT_FALSE(has_met_repetition(row));
}

TEST(Repetition, BeginsAfterAllBoxes) {
  RunRow row = limits_row({{"box", "20"}, {"boxes", "3"}});
  EXPECT_EQ(repetition_length(row), 60);
  row.distance = 59;
  row.lateral = 30;
  EXPECT_FALSE(has_met_repetition(row));
  row.distance = 61;
  EXPECT_TRUE(has_met_repetition(row));
}

TEST(Repetition, IsTheNatureOfALattice) {
  RunRow row = limits_row({{"obstacle-layout", "lattice"}, {"box", "20"}, {"obstacle-gap", "1.2"}});
  row.distance = 1000;
  EXPECT_FALSE(has_met_repetition(row));
}

TEST(Repetition, IsForeseenFromTheLongestTime) {
  EXPECT_EQ(possible_repetition(limits_plan({{"box", "20"}, {"max-time", "600"}})), "");
  EXPECT_EQ(possible_repetition(limits_plan({{"obstacle-layout", "lattice"}, {"obstacle-gap", "1.2"}})), "");
  EXPECT_EQ(
      possible_repetition(limits_plan({{"box", "20,500"}, {"max-time", "1e3,1e4"}})),
      "droplets of 2 of 4 parameter sets may travel farther than the length of their array and meet the same "
      "obstacles again: terminal-speed*max-time is up to 300, boxes*box 20; boxes=15 is long enough");
  EXPECT_TRUE(
      possible_repetition(limits_plan({{"box", "500"}, {"max-time", "2e5"}}))
          .ends_with("boxes=12 is long enough; box=45 boxes=134 is, too, and takes less time and memory"));
}

std::vector<std::string> limits_with(std::vector<Obstacle> circles, const Keys& keys) {
  Settings settings;
  settings.attach("posts.csv", OwnCircles(std::move(circles), "posts.csv"));
  settings.set("obstacles", "posts.csv");
  for (const auto& [name, text] : keys) settings.set(name, text);
  return limits_of_circles(Plan(settings));
}

TEST(Repetition, OfOwnCirclesIsNotMendedByMoreBoxes) {
  Settings settings;
  settings.attach("posts.csv", OwnCircles({{1, 2, 0.5}, {4, 5, 0.5}}, "posts.csv"));
  for (const auto& [name, text] : Keys{{"obstacles", "posts.csv"}, {"box", "7"}, {"max-time", "600"}})
    settings.set(name, text);
  const std::string said = possible_repetition(Plan(settings));
  EXPECT_TRUE(
      said.ends_with("up to 18, boxes*box 7; give a file of circles that is as long, or a shorter max-time"))
      << said;
}

TEST(LimitsOfCircles, AreThoseThatCirclesOfAFileDoNotFill) {
  EXPECT_TRUE(limits_of_circles(limits_plan({{"box", "20"}})).empty());
  const auto bare_in = [](const char* box, const char* boxes) {
    return limits_with(
        {{1, 2, 0.5}, {4, 5, 0.5}, {7, 8, 0}},
        {{"box", box}, {"boxes", boxes}, {"line-tension", "0.1,1"}, {"obstacle-diameter", "1"}});
  };
  const std::string lanes =
      "obstacles=posts.csv leaves y=2.5 to 4.5, 5.5 to 7.5, 8.5 to 10.5 bare, wider than a droplet; the "
      "array "
      "repeats at box=9: droplets sink there and touch nothing (n); if that is not meant, give a smaller box";
  EXPECT_EQ(bare_in("9", "1"), std::vector<std::string>{lanes});
  const std::string band =
      "obstacles=posts.csv leaves x=7.5 to 27.5 bare, before the array repeats at boxes*box=27: "
      "droplets sink freely there; if that is not meant, give fewer boxes or a smaller box";
  EXPECT_EQ(bare_in("9", "3"), (std::vector<std::string>{band, lanes}));
  EXPECT_EQ(bare_in("15", "1").size(), 2u) << "along and across";
}

TEST(LimitsOfCircles, AreDevicesOfWhichCirclesFillASmallPart) {
  const auto said_of = [](const char* box, const char* length, const char* exit) {
    return limits_with(
        {{2, 2, 0.2}, {8, 4, 0.2}, {14, 2, 0.2}},
        {{"box", box}, {"length", length}, {"side-walls", "on"}, {"release", "entrance"}, {"exit", exit}});
  };
  EXPECT_TRUE(said_of("6", "16", "15").empty());
  EXPECT_EQ(said_of("1500", "4000", "3500"),
            std::vector<std::string>{
                "obstacles=posts.csv has all circles at x=2 to 14, y=2 to 4, a small part of "
                "4000 by 1500 in droplet diameters; check box, length, entrance and exit (without a "
                "unit, they are in droplet diameters)"});
}

TEST(LimitsOfCircles, AreDiametersThatAFileLacks) {
  const auto said_of = [](double radius, const char* diameter) {
    return limits_with({{1, 1, 0.5}, {3, 2.5, radius}, {5, 3.3, radius}, {7, 4.6, 0.5}},
                       {{"box", "5"}, {"length", "9"}, {"obstacle-diameter", diameter}});
  };
  EXPECT_TRUE(said_of(0.5, "0.3").empty());
  for (const char* chosen : {"0.4", "0.3,0.4", "0.4,0.3"}) EXPECT_TRUE(said_of(0, chosen).empty()) << chosen;
  EXPECT_EQ(
      said_of(0, "0.3"),
      std::vector<std::string>{
          "obstacles=posts.csv gives no diameter for 2 circles; obstacle-diameter=0.3 is used for them"});
}

TEST(LimitsOfResults, AreTheLinesThatSaySomething) {
  EXPECT_TRUE(limits_of_results(limits_plan({{"box", "20"}, {"max-time", "600"}})).empty());
  const Plan plan = limits_plan({{"box", "20"}, {"max-time", "1e3"}, {"line-tension", "30"}});
  EXPECT_EQ(limits_of_results(plan),
            (std::vector<std::string>{possible_repetition(plan), untested_parameters(plan)}));
}

TEST(ObstacleSpacing, IsFromCentreToCentre) {
  EXPECT_DOUBLE_EQ(obstacle_spacing(limits_row({{"obstacle-gap", "0.4"}, {"obstacle-diameter", "0.5"}})),
                   0.9);
}

TEST(ObstacleSpacing, OfOwnCirclesFollowsFromHowManyThereAre) {
  Settings settings;
  // With four circles in a box of 8 x 8, the spacing is 4, whatever the places and diameters of the circles
  // are.
  settings.attach("posts.csv", OwnCircles({{1, 1, 0.2}, {2, 1, 0.2}, {5, 3, 0.2}, {3, 6, 0.2}}, "posts.csv"));
  settings.set("obstacles", "posts.csv");
  settings.set("box", "8");
  RunRow row = describe(Plan(settings).task(0));
  EXPECT_DOUBLE_EQ(obstacle_spacing(row), 4);
  row.obstacle_density = RunRow::not_known;
  EXPECT_DOUBLE_EQ(obstacle_spacing(row), row.parameters.obstacles.diameter + row.parameters.obstacles.gap);
}

RunRow wrapped_clog(double friction, FilmFriction films, double mesh_hold) {
  RunRow row;
  row.parameters.dp.friction = friction;
  row.parameters.dp.film_friction = films;
  row.status = RunStatus::clogged;
  row.hold.mechanism = ClogMechanism::wrapped;
  row.hold.geometry.mesh_hold = mesh_hold;
  return row;
}

TEST(MayHangOnMesh, WhereCornersBearMoreThanFriction) {
  // The ratio of the forces on the ends of a rope over half of a disc is exp(pi mu).
  const double ratio = std::exp(std::numbers::pi * 0.1);
  const double borne = (ratio - 1) / (ratio + 1);
  EXPECT_NEAR(weight_borne_by_friction(wrapped_clog(0.1, FilmFriction::on, 0).parameters.dp), borne, 1e-12);
  EXPECT_FALSE(may_hang_on_mesh(wrapped_clog(0.1, FilmFriction::on, 0.99 * borne)));
  EXPECT_TRUE(may_hang_on_mesh(wrapped_clog(0.1, FilmFriction::on, 1.01 * borne)));
}

TEST(MayHangOnMesh, WithoutFrictionAboveOnePercent) {
  EXPECT_FALSE(may_hang_on_mesh(wrapped_clog(0, FilmFriction::off, 0.0099)));
  EXPECT_TRUE(may_hang_on_mesh(wrapped_clog(0, FilmFriction::off, 0.0101)));
}

TEST(MayHangOnMesh, IfFrictionActsOnOneInterfaceOnly) {
  RunRow row = wrapped_clog(1, FilmFriction::off, 0.001);
  EXPECT_TRUE(may_hang_on_mesh(row));
  row.hold.mechanism = ClogMechanism::squeezed;
  EXPECT_FALSE(may_hang_on_mesh(row));
}

}  // namespace
}  // namespace clog::sweep
