#include "clog/core/parameters/parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>

#include "clog/core/polygon/forces/automatic_values.hpp"
#include "clog/core/polygon/forces/stability.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/core/world/lattice.hpp"

namespace clog {
namespace {

struct Refusal {
  const char* what;  // part of the message
  std::function<void(RunParameters&)> spoil;
};
void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.what; }

class Refused : public testing::TestWithParam<Refusal> {};

TEST_P(Refused, NamesTheFieldAndARemedy) {
  RunParameters run;
  GetParam().spoil(run);
  try {
    resolve(run);
    FAIL() << "accepted what should name " << GetParam().what;
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(GetParam().what), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Parameters, Refused,
    testing::Values(
        Refusal{"time-step=0", [](auto& run) { run.time_step = 0; }},
        Refusal{"time-step=0.01 (contact, area, tension and spring modes",
                [](auto& run) { run.time_step = 0.01; }},
        Refusal{"omega*dt = 416, wall-stiffness=1e+04) try 2.1",
                [](auto& run) {
                  run.dp.vertices = 256, run.wall_stiffness = 1e4, run.time_step = 1e-3,
                  run.dp.area_stiffness = 1e4;
                }},
        Refusal{"time-step=0.1 (does not resolve the drag", [](auto& run) { run.time_step = 0.1; }},
        Refusal{"boxes=0", [](auto& run) { run.obstacles.boxes = 0; }},
        Refusal{"boxes=2 (a lattice",
                [](auto& run) { run.obstacles.layout = ObstacleLayout::lattice, run.obstacles.boxes = 2; }},
        Refusal{"box=500 (the array would need more than ten gigabytes) use at most 50;",
                [](auto& run) { run.obstacles.boxes = 10000; }},
        Refusal{"max-time=-1", [](auto& run) { run.max_time = -1; }},
        Refusal{"max-time=1e-4 (shorter", [](auto& run) { run.max_time = 1e-4; }},
        Refusal{"clog-energy=0.1", [](auto& run) { run.clog_energy = 0.1; }},
        Refusal{"dwell-length=0 (must be positive", [](auto& run) { run.dwell_length = 0; }},
        Refusal{"dwell-length=0.6 (a droplet that hangs", [](auto& run) { run.dwell_length = 0.6; }},
        Refusal{"break-up-neck=-0.1 (must not be", [](auto& run) { run.dp.break_up_neck = -0.1; }},
        Refusal{"break-up-neck=0.01 (no neck is thinner than self-contact-range=0.01227",
                [](auto& run) { run.dp.break_up_neck = 0.01; }},
        Refusal{"break-up-neck=0.2 (all that pass obstacle-gap=0.2 have a neck as thin as that) use less",
                [](auto& run) { run.dp.break_up_neck = 0.2; }},
        Refusal{"break-up-neck=0.45 (all that pass orifice=0.4",
                [](auto& run) {
                  run.dp.break_up_neck = 0.45, run.obstacles.layout = ObstacleLayout::channel;
                  run.channel.orifice = 0.4;
                }},
        Refusal{"break-up-neck=0.05 (model=sp does not depend on it) leave it out",
                [](auto& run) {
                  run.model = Model::sp, run.wall_stiffness = 1, run.dp.break_up_neck = 0.05;
                }},
        Refusal{"terminal-speed=0", [](auto& run) { run.drag.terminal_speed = 0; }},
        Refusal{"near-wall-drag=-1", [](auto& run) { run.drag.near_wall = -1; }},
        Refusal{"near-wall-exponent=-1", [](auto& run) { run.drag.near_wall_exponent = -1; }},
        Refusal{"relative-drag=-1", [](auto& run) { run.drag.relative = -1; }},
        Refusal{"near-wall-cutoff=0", [](auto& run) { run.drag.near_wall_cutoff = 0; }},
        Refusal{"contact-range=-0.01", [](auto& run) { run.dp.contact_range = -0.01; }},
        Refusal{"contact-range=0.2 (walls would act at a distance",
                [](auto& run) { run.dp.contact_range = 0.2; }},
        Refusal{"self-contact-range=0", [](auto& run) { run.dp.self_contact_range = 0; }},
        Refusal{"wall-tension=-1", [](auto& run) { run.dp.wall_tension = -1; }},
        Refusal{"friction=-0.1 (must not be negative", [](auto& run) { run.dp.friction = -0.1; }},
        Refusal{"friction contradicts perimeter-spring=along (an interface of constant tension cannot balance "
                "a tangential force) use preset=elastic",
                [](auto& run) { run.dp.friction = 0.1; }},
        Refusal{"yield-traction contradicts perimeter-spring=along",
                [](auto& run) { run.dp.yield_traction = 0.1; }},
        Refusal{"film-friction=on contradicts friction=0",
                [](auto& run) { run.dp.film_friction = FilmFriction::on; }},
        Refusal{"film-friction=on contradicts self-contact=off",
                [](auto& run) {
                  run.dp.perimeter_spring = PerimeterSpring::mean;
                  run.dp.friction = 0.1;
                  run.dp.self_contact = SelfContact::off;
                  run.dp.film_friction = FilmFriction::on;
                }},
        Refusal{"receding-angle=190 (an angle between wall and interface) use 0..180, or young",
                [](auto& run) { run.dp.receding_angle = 190; }},
        Refusal{"receding-angle=130 (above Young's angle, which wall-tension sets) use at most 120, or young",
                [](auto& run) { run.dp.wall_tension = 0.5, run.dp.receding_angle = 130; }},
        Refusal{"advancing-angle=150 (below Young's angle, which wall-tension sets) use at least 180, or "
                "young",
                [](auto& run) { run.dp.advancing_angle = 150; }},
        Refusal{"receding-angle contradicts perimeter-spring=mean (on such an interface walls act by "
                "friction, not by hysteresis) use friction, or preset=robust",
                [](auto& run) {
                  run.dp.receding_angle = 120, run.dp.perimeter_spring = PerimeterSpring::mean;
                }},
        Refusal{"perimeter-stiffness-ratio=-1", [](auto& run) { run.dp.perimeter_stiffness_ratio = -1; }},
        Refusal{"perimeter-spring=along contradicts gravity=vertex",
                [](auto& run) { run.dp.gravity = Gravity::vertex; }},
        Refusal{"line-tension=-0.1", [](auto& run) { run.dp.line_tension = -0.1; }},
        Refusal{"line-tension=nan",
                [](auto& run) { run.dp.line_tension = std::numeric_limits<double>::quiet_NaN(); }},
        Refusal{"area-stiffness=0", [](auto& run) { run.dp.area_stiffness = 0; }},
        Refusal{"vertices=8", [](auto& run) { run.dp.vertices = 8; }},
        Refusal{"perimeter-stiffness=-1", [](auto& run) { run.dp.perimeter_stiffness = -1; }},
        Refusal{"wall-stiffness=1e-9 (too soft", [](auto& run) { run.wall_stiffness = 1e-9; }},
        Refusal{"obstacle-gap=0.01 (not wider than an edge is long",
                [](auto& run) { run.obstacles.gap = 0.01; }},
        Refusal{"obstacle-diameter=0", [](auto& run) { run.obstacles.diameter = 0; }},
        Refusal{"obstacle-density=-1", [](auto& run) { run.obstacles.density = -1; }},
        Refusal{"obstacle-density=2.8 (more than every seed finds room for, with obstacle-gap=0.2 and "
                "box=500) use at most 2.779, or saturated",
                [](auto& run) { run.obstacles.density = 2.8; }},
        Refusal{"obstacle-density=101% (more than every seed finds room for",
                [](auto& run) { run.obstacles.density = ObstacleDensity::share_of_saturated(1.01); }},
        Refusal{"obstacle-density=-5% (must be positive)",
                [](auto& run) { run.obstacles.density = ObstacleDensity::share_of_saturated(-0.05); }},
        Refusal{"obstacle-density=20% (a lattice has one",
                [](auto& run) {
                  run.obstacles.layout = ObstacleLayout::lattice;
                  run.obstacles.density = ObstacleDensity::share_of_saturated(0.2);
                }},
        Refusal{"obstacle-density=1e300 (more than", [](auto& run) { run.obstacles.density = 1e300; }},
        Refusal{"obstacle-diameter-spread=1 (the smallest obstacles would have no diameter) use less than 1",
                [](auto& run) { run.obstacles.diameter_spread = 1; }},
        Refusal{"obstacle-diameter-spread=-0.1", [](auto& run) { run.obstacles.diameter_spread = -0.1; }},
        Refusal{"lattice-angle=5 (a random array has no rows) add obstacle-layout=lattice",
                [](auto& run) { run.obstacles.lattice_angle = 5; }},
        Refusal{"lattice-angle=60 (a square lattice turned by 90 degrees is the same) use -45..45",
                [](auto& run) {
                  run.obstacles.layout = ObstacleLayout::lattice, run.obstacles.lattice_angle = 60;
                }},
        Refusal{"obstacle-density=1 (a lattice has one",
                [](auto& run) { run.obstacles.layout = ObstacleLayout::lattice, run.obstacles.density = 1; }},
        Refusal{"obstacle-diameter-spread=0.2 (the obstacles of a lattice",
                [](auto& run) {
                  run.obstacles.layout = ObstacleLayout::lattice, run.obstacles.diameter_spread = 0.2;
                }},
        Refusal{"box=2 (the droplet would meet", [](auto& run) { run.obstacles.box = 2; }},
        Refusal{"box=1e6", [](auto& run) { run.obstacles.box = 1e6; }},
        Refusal{"box=5 (holds no two obstacles",
                [](auto& run) { run.obstacles.box = 5, run.obstacles.diameter = 10; }},
        Refusal{"max-time=1e30 (more than 1e15 steps", [](auto& run) { run.max_time = 1e30; }},
        Refusal{"time-step=1e-300 (smaller", [](auto& run) { run.time_step = 1e-300; }},
        Refusal{"line-tension=1e300 (would compress the droplet",
                [](auto& run) { run.dp.line_tension = 1e300; }},
        Refusal{"line-tension=197 (would compress the droplet by more than 5 %, with the stiffest automatic "
                "area-stiffness) use at most 190",
                [](auto& run) { run.dp.line_tension = 197; }},
        Refusal{"area-stiffness=100 (the line tension would compress",
                [](auto& run) { run.dp.line_tension = 10, run.dp.area_stiffness = 100; }},
        Refusal{"area-stiffness=1e300 (would need a time-step of",
                [](auto& run) { run.dp.area_stiffness = 1e300; }},
        Refusal{"perimeter-stiffness=1e300 (would need",
                [](auto& run) { run.dp.perimeter_stiffness = 1e300; }},
        Refusal{"wall-stiffness=1e300 (would need", [](auto& run) { run.wall_stiffness = 1e300; }},
        Refusal{"wall-stiffness=1e300 (would need",
                [](auto& run) { run.model = Model::sp, run.wall_stiffness = 1e300; }},
        Refusal{"terminal-speed=1e-12 (would need", [](auto& run) { run.drag.terminal_speed = 1e-12; }},
        Refusal{"max-time=1e-9 (shorter than one time-step) use at least 0.0025",
                [](auto& run) { run.max_time = 1e-9; }},
        Refusal{"terminal-speed=1e8", [](auto& run) { run.drag.terminal_speed = 1e8; }},
        Refusal{"near-wall-drag=1e10", [](auto& run) { run.drag.near_wall = 1e10; }},
        Refusal{"missing wall-stiffness", [](auto& run) { run.model = Model::sp; }},
        Refusal{"near-wall-drag=0.1 (model=sp does not depend on it) leave it out",
                [](auto& run) { run.model = Model::sp, run.wall_stiffness = 1, run.drag.near_wall = 0.1; }},
        Refusal{"time-step=0.02 (contact has",
                [](auto& run) { run.model = Model::sp, run.wall_stiffness = 1e4, run.time_step = 0.02; }}));

/// The message with which resolve() refuses these parameters; empty if it accepts them.
std::string refusal_of(const RunParameters& run) {
  try {
    resolve(run);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Resolve, FillsInTheStiffestStableContact) {
  RunParameters run;
  run.time_step = 1e-3;
  run = resolve(run);
  const double k = contact_stiffness(*run.wall_stiffness, units::regular_edge_length(*run.dp.vertices));
  EXPECT_NEAR(k * 1e-6 / (units::droplet_mass / *run.dp.vertices), 0.25, 1e-12);
}

TEST(Resolve, FillsInTheLargestStepThatHolds) {
  // Every resolved step passes resolve()'s own checks of stability, for stiff and for soft droplets, many and
  // few vertices, strong and weak drag, given and automatic contact; and it is no smaller than it need be.
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
        // Two digits are kept of the smallest of its bounds.
        const double vertex_mass = units::droplet_mass / vertices;
        const double contact = std::sqrt(
            0.01 * vertex_mass / expected_pressure(resolved, scene_of(resolved).sharpest_bend(resolved)));
        RunParameters larger = resolved;
        larger.wall_stiffness.reset();
        larger.time_step = *resolved.time_step * 1.1 / std::sqrt(auto_step_margin);
        EXPECT_TRUE(1.1 * *resolved.time_step > std::min(contact, 0.2 * terminal_speed) ||
                    refusal_of(larger).find("omega*dt") != std::string::npos)
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
  // And contact, area and springs are as stiff as before. Where drag limits the step it grows faster.
  RunParameters run;
  run.dp.line_tension = 0.3;
  run.drag.terminal_speed = 0.1;
  const RunParameters usual = resolve(run);
  run.dp.inertia = 4;
  const RunParameters heavy = resolve(run);
  EXPECT_NEAR(*heavy.time_step / *usual.time_step, 2, 0.1);  // two digits are kept
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
  EXPECT_EQ(resolve(run).dp.area_stiffness, 1e4);  // the published one
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
    std::string message;
    try {
      resolve(run);
    } catch (const Error& error) {
      message = error.what();
    }
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

TEST(Resolve, TakesTheBoxThatItProposesForALattice) {
  for (const double angle : {0.5, 3.0, -17.0, 44.0}) {
    const std::string message = refusal_of(lattice_run(angle, 5.2));
    ASSERT_NE(message.find("lattice-angle="), std::string::npos) << angle;
    const double box = std::stod(message.substr(message.find("use box=") + 8));
    EXPECT_EQ(refusal_of(lattice_run(angle, box)), "");
    EXPECT_NE(refusal_of(lattice_run(angle, box - 1.5)), "") << "no larger than needed";
  }
}

TEST(Resolve, TakesTheSpreadThatItProposes) {
  RunParameters run;
  run.dp.vertices = 256;
  run.obstacles.gap = 0.02;
  run.obstacles.diameter_spread = 0.9;
  const std::string message = refusal_of(run);
  ASSERT_NE(message.find("obstacle-diameter-spread=0.9 (the largest two"), std::string::npos) << message;
  run.obstacles.diameter_spread = std::stod(message.substr(message.find("use ") + 4));
  EXPECT_EQ(refusal_of(run), "");
}

TEST(Resolve, ChangesNothingThatWasGiven) {
  const RunParameters once = resolve(RunParameters{});
  const RunParameters twice = resolve(once);
  EXPECT_EQ(*once.wall_stiffness, *twice.wall_stiffness);
  EXPECT_EQ(*once.dp.perimeter_stiffness, *twice.dp.perimeter_stiffness);
}

}  // namespace
}  // namespace clog
