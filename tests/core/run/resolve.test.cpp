#include "clog/core/parameters/parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "clog/core/parameters/schema.hpp"
#include "clog/core/polygon/forces/automatic_values.hpp"
#include "clog/core/polygon/forces/stability.hpp"
#include "clog/core/polygon/wetting/contact_line.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/core/world/lattice.hpp"
#include "refusal.hpp"

namespace clog {
namespace {

struct Refusal {
  const char* what;  // part of the message
  std::vector<std::pair<const char*, ParameterValue>> settings;
};
void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.what; }

class Refused : public testing::TestWithParam<Refusal> {};

TEST_P(Refused, NamesTheFieldAndARemedy) {
  RunParameters run;
  for (const auto& [key, value] : GetParam().settings) parameter(key).set(run, value);
  test::expect_refused(run, GetParam().what);
}

INSTANTIATE_TEST_SUITE_P(
    Parameters, Refused,
    testing::Values(
        Refusal{"time-step=0", {{"time-step", 0.0}}},
        Refusal{"time-step=0.01 (contact, area, tension and spring modes", {{"time-step", 0.01}}},
        Refusal{"omega*dt = 416, wall-stiffness=1e+04) try 2.1",
                {{"vertices", 256}, {"wall-stiffness", 1e4}, {"time-step", 1e-3}, {"area-stiffness", 1e4}}},
        Refusal{"time-step=0.1 (does not resolve the drag", {{"time-step", 0.1}}},
        Refusal{"boxes=0", {{"boxes", 0}}},
        Refusal{"boxes=2 (a lattice", {{"obstacle-layout", "lattice"}, {"boxes", 2}}},
        Refusal{"box=500 (the array would need more than ten gigabytes) use at most 50;", {{"boxes", 10000}}},
        Refusal{"max-time=-1", {{"max-time", -1.0}}}, Refusal{"max-time=1e-4 (shorter", {{"max-time", 1e-4}}},
        Refusal{"clog-energy=0.1", {{"clog-energy", 0.1}}},
        Refusal{"dwell-length=0 (must be positive", {{"dwell-length", 0.0}}},
        Refusal{"dwell-length=0.6 (a droplet that hangs", {{"dwell-length", 0.6}}},
        Refusal{"break-up-neck=-0.1 (must not be", {{"break-up-neck", -0.1}}},
        Refusal{"break-up-neck=0.01 (no neck is thinner than self-contact-range=0.01227",
                {{"break-up-neck", 0.01}}},
        Refusal{"break-up-neck=0.2 (all that pass obstacle-gap=0.2 have a neck as thin as that) use less",
                {{"break-up-neck", 0.2}}},
        Refusal{"break-up-neck=0.45 (all that pass orifice=0.4",
                {{"break-up-neck", 0.45}, {"obstacle-layout", "channel"}, {"orifice", 0.4}}},
        Refusal{"break-up-neck=0.05 (model=sp does not depend on it) leave it out",
                {{"model", "sp"}, {"wall-stiffness", 1.0}, {"break-up-neck", 0.05}}},
        Refusal{"terminal-speed=0", {{"terminal-speed", 0.0}}},
        Refusal{"near-wall-drag=-1", {{"near-wall-drag", -1.0}}},
        Refusal{"near-wall-exponent=-1", {{"near-wall-exponent", -1.0}}},
        Refusal{"relative-drag=-1", {{"relative-drag", -1.0}}},
        Refusal{"near-wall-cutoff=0", {{"near-wall-cutoff", 0.0}}},
        Refusal{"contact-range=-0.01", {{"contact-range", -0.01}}},
        Refusal{"contact-range=0.2 (walls would act at a distance", {{"contact-range", 0.2}}},
        Refusal{"self-contact-range=0", {{"self-contact-range", 0.0}}},
        Refusal{"wall-tension=-1", {{"wall-tension", -1.0}}},
        Refusal{"friction=-0.1 (must not be negative", {{"friction", -0.1}}},
        Refusal{"friction contradicts perimeter-spring=along (an interface of constant tension cannot "
                "balance a tangential force) use preset=elastic",
                {{"friction", 0.1}}},
        Refusal{"yield-traction contradicts perimeter-spring=along", {{"yield-traction", 0.1}}},
        Refusal{"film-friction=on contradicts friction=0", {{"film-friction", "on"}}},
        Refusal{"film-friction=on contradicts self-contact=off",
                {{"perimeter-spring", "mean"},
                 {"friction", 0.1},
                 {"self-contact", "off"},
                 {"film-friction", "on"}}},
        Refusal{"receding-angle=190 (it is the angle between wall and interface) use 0..180, or young",
                {{"receding-angle", 190.0}}},
        Refusal{"receding-angle=130 (above Young's angle, which wall-tension sets) use at most 120, or young",
                {{"wall-tension", 0.5}, {"receding-angle", 130.0}}},
        Refusal{
            "advancing-angle=150 (below Young's angle, which wall-tension sets) use at least 180, or young",
            {{"advancing-angle", 150.0}, {"wall-tension", 1.0}}},
        Refusal{"advancing-angle=150 (Young's angle does not follow from it alone) give receding-angle, too, "
                "or wall-tension",
                {{"advancing-angle", 150.0}}},
        Refusal{"receding-angle=155 (larger than advancing-angle=140) exchange them",
                {{"receding-angle", 155.0}, {"advancing-angle", 140.0}}},
        Refusal{"receding-angle=60 (with this advancing-angle wall-tension, minus the mean of their cosines, "
                "is -0.163, and the interface on a wall would buckle) use angles for at least 0.1",
                {{"receding-angle", 60.0}, {"advancing-angle", 100.0}}},
        Refusal{"receding-angle contradicts perimeter-spring=mean (on such an interface walls act by "
                "friction, not by hysteresis) use friction, or preset=robust",
                {{"receding-angle", 120.0}, {"perimeter-spring", "mean"}}},
        Refusal{"perimeter-stiffness-ratio=-1", {{"perimeter-stiffness-ratio", -1.0}}},
        Refusal{"perimeter-spring=along contradicts gravity=vertex", {{"gravity", "vertex"}}},
        Refusal{"line-tension=-0.1", {{"line-tension", -0.1}}},
        Refusal{"line-tension=nan", {{"line-tension", std::nan("")}}},
        Refusal{"area-stiffness=0", {{"area-stiffness", 0.0}}}, Refusal{"vertices=8", {{"vertices", 8}}},
        Refusal{"perimeter-stiffness=-1", {{"perimeter-stiffness", -1.0}}},
        Refusal{"wall-stiffness=1e-9 (too soft", {{"wall-stiffness", 1e-9}}},
        Refusal{"obstacle-gap=0.01 (not wider than an edge is long", {{"obstacle-gap", 0.01}}},
        Refusal{"obstacle-diameter=0", {{"obstacle-diameter", 0.0}}},
        Refusal{"obstacle-density=-1", {{"obstacle-density", -1.0}}},
        Refusal{"obstacle-density=2.8 (more than every seed finds room for, with obstacle-gap=0.2 and "
                "box=500) use at most 2.779, or saturated",
                {{"obstacle-density", 2.8}}},
        Refusal{"obstacle-density=101% (more than every seed finds room for", {{"obstacle-density", "101%"}}},
        Refusal{"obstacle-density=-5% (must be positive)", {{"obstacle-density", "-5%"}}},
        Refusal{"obstacle-density=20% (a lattice has one",
                {{"obstacle-layout", "lattice"}, {"obstacle-density", "20%"}}},
        Refusal{"obstacle-density=1e300 (more than", {{"obstacle-density", 1e300}}},
        Refusal{"obstacle-diameter-spread=1 (the smallest obstacles would have no diameter) use less than 1",
                {{"obstacle-diameter-spread", 1.0}}},
        Refusal{"obstacle-diameter-spread=-0.1", {{"obstacle-diameter-spread", -0.1}}},
        Refusal{"lattice-angle=5 (a random array has no rows) add obstacle-layout=lattice",
                {{"lattice-angle", 5.0}}},
        Refusal{"lattice-angle=60 (a square lattice turned by 90 degrees is the same lattice) use -45..45",
                {{"obstacle-layout", "lattice"}, {"lattice-angle", 60.0}}},
        Refusal{"lattice-angle=31 (a triangular lattice turned by 60 degrees is the same) use -30..30",
                {{"obstacle-layout", "lattice"}, {"lattice", "triangular"}, {"lattice-angle", 31.0}}},
        Refusal{"pitch=0.3 (posts of obstacle-diameter=0.3 would touch) use more",
                {{"obstacle-layout", "lattice"}, {"pitch", 0.3}}},
        Refusal{"lattice=rhombic (a random array has no rows)", {{"lattice", "rhombic"}}},
        Refusal{"length=50 (there are no user", {{"obstacle-layout", "lattice"}, {"length", 50.0}}},
        Refusal{"obstacle-density=1 (a lattice has one",
                {{"obstacle-layout", "lattice"}, {"obstacle-density", 1.0}}},
        Refusal{"obstacle-diameter-spread=0.2 (the obstacles of a lattice",
                {{"obstacle-layout", "lattice"}, {"obstacle-diameter-spread", 0.2}}},
        Refusal{"box=2 (the droplet would meet", {{"box", 2.0}}}, Refusal{"box=1e6", {{"box", 1e6}}},
        Refusal{"box=5 (holds no two obstacles", {{"box", 5.0}, {"obstacle-diameter", 10.0}}},
        Refusal{"max-time=1e30 (more than 1e15 steps", {{"max-time", 1e30}}},
        Refusal{"time-step=1e-300 (no mode needs", {{"time-step", 1e-300}}},
        Refusal{"line-tension=1e300 (would compress the droplet", {{"line-tension", 1e300}}},
        Refusal{"line-tension=197 (would compress the droplet by more than 5 %, with the stiffest automatic "
                "area-stiffness) use at most 190",
                {{"line-tension", 197.0}}},
        Refusal{"area-stiffness=100 (the line tension would compress",
                {{"line-tension", 10.0}, {"area-stiffness", 100.0}}},
        Refusal{"area-stiffness=1e300 (would need a time-step of", {{"area-stiffness", 1e300}}},
        Refusal{"perimeter-stiffness=1e300 (would need", {{"perimeter-stiffness", 1e300}}},
        Refusal{"wall-stiffness=1e300 (would need", {{"wall-stiffness", 1e300}}},
        Refusal{"wall-stiffness=1e300 (would need", {{"model", "sp"}, {"wall-stiffness", 1e300}}},
        Refusal{"terminal-speed=1e-12 (would need", {{"terminal-speed", 1e-12}}},
        Refusal{"max-time=1e-9 (shorter than one time-step) use at least 0.0025", {{"max-time", 1e-9}}},
        Refusal{"terminal-speed=1e8", {{"terminal-speed", 1e8}}},
        Refusal{"near-wall-drag=1e10", {{"near-wall-drag", 1e10}}},
        Refusal{"missing wall-stiffness", {{"model", "sp"}}},
        Refusal{"near-wall-drag=0.1 (model=sp does not depend on it) leave it out",
                {{"model", "sp"}, {"wall-stiffness", 1.0}, {"near-wall-drag", 0.1}}},
        Refusal{"time-step=0.02 (contact has",
                {{"model", "sp"}, {"wall-stiffness", 1e4}, {"time-step", 0.02}}}));

TEST(Resolve, TakesYoungsAngleFromTheMeanCosineOfMeasuredAngles) {
  RunParameters run;
  run.dp.receding_angle = 140;
  run.dp.advancing_angle = 155;
  EXPECT_NEAR(resolve(run).dp.wall_tension.value(), 0.8361761, 1e-7);  // (cos 25 + cos 40)/2
  for (const double angle : {97.0, 123.0, 155.0, 180.0}) {
    run.dp.receding_angle = run.dp.advancing_angle = angle;
    const RunParameters resolved = resolve(run);
    EXPECT_NEAR(*resolved.dp.wall_tension, -std::cos(angle * std::numbers::pi / 180), 1e-12) << angle;
    EXPECT_FALSE(has_hysteresis(resolved.dp)) << angle;
  }
  run.dp.receding_angle = 140;
  run.dp.advancing_angle.reset();
  EXPECT_EQ(*resolve(run).dp.wall_tension, 1) << "a film of water, which recedes at 140 degrees";
}

TEST(Resolve, FillsInTheStiffestStableContact) {
  RunParameters run;
  run.time_step = 1e-3;
  run = resolve(run);
  const double k = contact_stiffness(*run.wall_stiffness, units::regular_edge_length(*run.dp.vertices));
  EXPECT_NEAR(k * 1e-6 / (units::droplet_mass / *run.dp.vertices), 0.25, 1e-12);
}

TEST(Resolve, FillsInTheLargestStepThatHolds) {
  // Every automatic step must pass the checks of stability in resolve() and be as large as possible. The
  // cases are stiff and soft droplets, many and few vertices, and strong and weak drag.
  for (const int vertices : {16, 64, 256, 1024})
    for (const double line_tension : {0.0, 0.01, 0.3, 10.0})
      for (const double terminal_speed : {0.003, 0.03, 1.0}) {
        RunParameters run;
        run.dp.vertices = vertices;
        run.dp.line_tension = line_tension;
        run.drag.terminal_speed = terminal_speed;
        run.obstacles.gap = 0.5;
        const RunParameters resolved = resolve(run);
        EXPECT_EQ(resolve(resolved).time_step, resolved.time_step);
        EXPECT_LE(*resolved.time_step, 0.2 * terminal_speed);
        // A step that is larger by a tenth must violate one of the bounds. The step has two significant
        // digits.
        const double vertex_mass = units::droplet_mass / vertices;
        const double contact = std::sqrt(
            0.01 * vertex_mass / expected_pressure(resolved, scene_of(resolved).sharpest_bend(resolved)));
        RunParameters larger = resolved;
        larger.wall_stiffness.reset();
        larger.time_step = *resolved.time_step * 1.1 / std::sqrt(auto_step_margin);
        EXPECT_TRUE(1.1 * *resolved.time_step > std::min(contact, 0.2 * terminal_speed) ||
                    test::refusal_of(larger).find("omega*dt") != std::string::npos)
            << vertices << ' ' << line_tension << ' ' << terminal_speed;
      }
}

TEST(Resolve, TakesShorterStepsWithStrongerDragOrElasticInterface) {
  RunParameters run;
  run.dp.line_tension = 0.1;
  run.drag.terminal_speed = 0.003;  // so that drag limits the step
  EXPECT_DOUBLE_EQ(*resolve(run).time_step, 0.2 * 0.003);
  RunParameters near_walls = run;
  near_walls.drag.near_wall = 0.1;
  EXPECT_DOUBLE_EQ(*resolve(near_walls).time_step, 0.1 * 0.003);
  RunParameters relative = run;
  relative.drag.relative = 2;
  EXPECT_DOUBLE_EQ(*resolve(relative).time_step, 0.1 * 0.003);
  RunParameters elastic = run;
  elastic.dp.perimeter_spring = PerimeterSpring::rest;
  elastic.dp.gravity = Gravity::vertex;
  EXPECT_DOUBLE_EQ(*resolve(elastic).time_step, 0.1 * 0.003);
}

TEST(Resolve, TakesStepsAsLongAsTheRootOfTheInertia) {
  // The stiffnesses of contact, area and springs do not depend on the inertia, so the step grows as its root.
  // The terminal speed is so large that drag does not limit the step.
  RunParameters run;
  run.dp.line_tension = 0.3;
  run.drag.terminal_speed = 0.1;
  const RunParameters usual = resolve(run);
  run.dp.inertia = 4;
  const RunParameters heavy = resolve(run);
  EXPECT_NEAR(*heavy.time_step / *usual.time_step, 2, 0.1);  // the step is rounded to two significant digits
  EXPECT_NEAR(*heavy.wall_stiffness / *usual.wall_stiffness, 1, 0.1);
  EXPECT_EQ(heavy.dp.area_stiffness, usual.dp.area_stiffness);
  EXPECT_EQ(heavy.dp.perimeter_stiffness, usual.dp.perimeter_stiffness);
}

TEST(Resolve, FillsInTheSoftestAreaThatKeepsItsSize) {
  RunParameters run;
  run.dp.line_tension = 0.3;
  const RunParameters soft = resolve(run);
  EXPECT_NEAR(expected_pressure(soft, scene_of(soft).sharpest_bend(soft)) / *soft.dp.area_stiffness /
                  units::rest_area,
              2e-3, 1e-4);
  run.dp.line_tension = 10;
  EXPECT_EQ(resolve(run).dp.area_stiffness, 1e4);  // the published value
}

TEST(Resolve, FillsInThePerimeterSpring) {
  RunParameters run;
  run.dp.line_tension = 2;
  EXPECT_DOUBLE_EQ(*resolve(run).dp.perimeter_stiffness, 0.003 / 0.03);
  run.dp.perimeter_spring = PerimeterSpring::mean;
  EXPECT_EQ(*resolve(run).dp.perimeter_stiffness, 1.0);
  run.dp.perimeter_spring = PerimeterSpring::rest;
  run.dp.gravity = Gravity::vertex;
  EXPECT_DOUBLE_EQ(*resolve(run).dp.perimeter_stiffness, 2e-3);
  run.dp.perimeter_stiffness_ratio = 0.1;
  EXPECT_DOUBLE_EQ(*resolve(run).dp.perimeter_stiffness, 0.2);
}

TEST(Resolve, TakesTheStepItProposes) {
  for (const std::optional<double> stiffness : {std::optional<double>(), std::optional<double>(1e4)}) {
    RunParameters run;
    run.wall_stiffness = stiffness;
    run.dp.vertices = 1024;
    run.dp.line_tension = 10;
    run.time_step = 1e-3;
    const std::string message = test::refusal_of(run);
    run.time_step = std::stod(message.substr(message.rfind("try ") + 4));
    EXPECT_NO_THROW(resolve(run));
  }
}

RunParameters lattice_run(double angle, double box) {
  RunParameters run;
  run.obstacles.layout = ObstacleLayout::lattice;
  run.obstacles.lattice_angle = angle;
  run.obstacles.box = box;
  return run;
}

TEST(Resolve, GivesALatticeABoxThatIsItsPeriod) {
  for (const double angle : {-45.0, -7.3, 0.0, 1.0, 12.0, 26.56505, 45.0}) {
    const ObstacleParameters used = resolve(lattice_run(angle, 200)).obstacles;
    EXPECT_LE(used.box, 200) << angle;
    EXPECT_NEAR(used.lattice_angle, angle, largest_angle_error) << angle;
    EXPECT_EQ(used.gap, 0.2);
    EXPECT_EQ(used.diameter, 0.3);
    for (const double steps : {used.box / 0.5 * std::cos(used.lattice_angle * std::numbers::pi / 180),
                               used.box / 0.5 * std::sin(used.lattice_angle * std::numbers::pi / 180)})
      EXPECT_NEAR(steps, std::round(steps), 1e-9) << angle;
    const RunParameters again = resolve(resolve(lattice_run(angle, 200)));
    EXPECT_EQ(again.obstacles, used) << "a row's own box and angle give the row's lattice";
  }
  EXPECT_EQ(resolve(lattice_run(0, 200)).obstacles.box, 200);
}

TEST(Resolve, GivesTheSameLatticeAgain) {
  for (const LatticeKind kind : {LatticeKind::triangular, LatticeKind::rhombic})
    for (const double angle : {-30.0, -7.3, 0.0, 1.0, 26.56505})
      for (const double length : {0.0, 57.0}) {
        RunParameters run = lattice_run(angle, 80);
        run.obstacles.lattice = kind;
        run.obstacles.pitch = 0.7;
        run.obstacles.length = length;
        const ObstacleParameters used = resolve(run).obstacles;
        EXPECT_EQ(used.gap, 0.7 - 0.3);
        EXPECT_LE(used.length, length > 0 ? length : 80);
        RunParameters again = run;
        again.obstacles = used;
        EXPECT_EQ(resolve(again).obstacles, used) << name(kind) << ' ' << angle;
      }
}

TEST(Resolve, TakesTheBoxOrTheAngleThatItProposesForALattice) {
  for (const LatticeKind kind : {LatticeKind::square, LatticeKind::triangular, LatticeKind::rhombic})
    for (const double angle : {0.5, 3.0, -17.0, 27.8}) {
      RunParameters run = lattice_run(angle, 5.2);
      run.obstacles.lattice = kind;
      const std::string message = test::refusal_of(run);
      ASSERT_NE(message.find("lattice-angle="), std::string::npos) << angle;
      const double box = std::stod(message.substr(message.find("use box=") + 8));
      run.obstacles.box = box;
      EXPECT_EQ(test::refusal_of(run), "");
      run.obstacles.box = box - 1.5;
      EXPECT_NE(test::refusal_of(run), "") << "no larger than needed";
      run.obstacles.box = 5.2;
      for (auto at = message.find(", or "); at != std::string::npos; at = message.find(", or ", at + 1)) {
        run.obstacles.lattice_angle = std::stod(message.substr(at + 5));
        EXPECT_EQ(test::refusal_of(run), "") << message;
      }
    }
}

TEST(Resolve, TakesTheSpreadThatItProposes) {
  RunParameters run;
  run.dp.vertices = 256;
  run.obstacles.gap = 0.02;
  run.obstacles.diameter_spread = 0.9;
  const std::string message = test::refusal_of(run);
  ASSERT_NE(message.find("obstacle-diameter-spread=0.9 (the largest two"), std::string::npos) << message;
  run.obstacles.diameter_spread = std::stod(message.substr(message.find("use ") + 4));
  EXPECT_EQ(test::refusal_of(run), "");
}

TEST(Resolve, ChangesNothingThatWasGiven) {
  const RunParameters once = resolve(RunParameters{});
  const RunParameters twice = resolve(once);
  EXPECT_EQ(*once.wall_stiffness, *twice.wall_stiffness);
  EXPECT_EQ(*once.dp.perimeter_stiffness, *twice.dp.perimeter_stiffness);
}

}  // namespace
}  // namespace clog
