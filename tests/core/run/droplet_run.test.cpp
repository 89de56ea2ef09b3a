#include "clog/core/run/droplet_run.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "clog/core/model/model.hpp"
#include "clog/core/polygon/neck.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/byte_archive.hpp"
#include "clog/core/tools/error.hpp"
#include "support.hpp"

namespace clog {
namespace {

RunParameters small_run(double line_tension = 1, int vertices = 64) {
  RunParameters run;
  run.dp.line_tension = line_tension;
  run.dp.vertices = vertices;
  run.obstacles.box = 20;
  run.obstacles.density = {};
  run.max_time = 40;
  run.seed = 3;
  return resolve(run);
}

RunResult result_of(const RunParameters& parameters, int checks_at_a_time) {
  DropletRun run(parameters);
  while (!run.advance(checks_at_a_time)) continue;
  return run.result();
}

template <class T>
std::vector<std::byte> bytes_of(const T& values) {
  ByteWriter bytes;
  bytes.put(values);
  return bytes.take();
}

void expect_identical(const RunResult& a, const RunResult& b) {
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.distance, b.distance);
  EXPECT_EQ(a.sound_distance, b.sound_distance);
  EXPECT_EQ(a.lateral, b.lateral);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.kinetic_energy_ratio, b.kinetic_energy_ratio);
  EXPECT_EQ(a.shape_parameter, b.shape_parameter);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.hold.mechanism, b.hold.mechanism);
  EXPECT_TRUE(a.neck.width == b.neck.width || (std::isnan(a.neck.width) && std::isnan(b.neck.width)));
  EXPECT_EQ(bytes_of(a.steady), bytes_of(b.steady));
  EXPECT_EQ(bytes_of(a.dwells), bytes_of(b.dwells));
  EXPECT_EQ(a.contacts.number, b.contacts.number);
  EXPECT_TRUE(a.contacts.first_distance == b.contacts.first_distance || a.contacts.number == 0);
}

void expect_diverged(const RunResult& result) {
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_EQ(result.failed_by, FailedBy::divergence);
  EXPECT_NE(result.message.find("diverged"), std::string::npos) << result.message;
}

TEST(DropletRun, IsTheSameHoweverItIsSliced) {
  const RunResult at_once = result_of(small_run(), 100000);
  expect_identical(at_once, result_of(small_run(), 1));
  expect_identical(at_once, result_of(small_run(), 7));
}

/// The parameters of a run that is short enough for a test and long enough for three snapshots.
RunParameters long_run(Model model) {
  RunParameters run;
  run.obstacles.box = 20;
  run.obstacles.density = {};
  run.obstacles.gap = 0.5;
  run.time_step = 1e-3;
  run.max_time = 850;
  run.model = model;
  if (model == Model::sp) run.wall_stiffness = 0.3;
  if (model == Model::dp) run.dp.vertices = 64, run.dp.line_tension = 0.05, run.drag.near_wall = 0.02;
  return resolve(run);
}

DropletRun resume_in_array(const RunParameters& run, std::span<const std::byte> snapshot) {
  return DropletRun::resume(run, std::make_shared<ObstacleArray>(sample_obstacles(run.obstacles, run.seed)),
                            snapshot);
}

/// A soft droplet among obstacles that cannot hold it, because they have neither friction nor contact angles.
RunParameters soft_among_walls() {
  RunParameters run;
  run.obstacles.box = 20;
  run.obstacles.density = {};
  run.obstacles.gap = 0.4;
  run.time_step = 2e-3;
  run.max_time = 600;
  run.dp.vertices = 64;
  run.dp.line_tension = 0.1;
  return run;
}

RunParameters with_friction(RunParameters run, double coefficient, FilmFriction films) {
  run.dp.perimeter_spring = PerimeterSpring::rest;
  run.dp.perimeter_stiffness_ratio = 0.1;
  run.dp.gravity = Gravity::vertex;
  run.dp.friction = coefficient;
  run.dp.film_friction = films;
  return run;
}

/// Resumes from a snapshot in which walls hold the droplet. Compares the results.
void expect_to_go_on(const RunParameters& run, const std::function<bool(const DropletState&)>& is_held) {
  DropletRun whole(run);
  std::vector<std::byte> snapshot;
  while (snapshot.empty() || !is_held(resume_in_array(run, snapshot).droplet().state())) {
    ASSERT_FALSE(whole.advance(64));
    snapshot = whole.snapshot();
  }
  DropletRun resumed = resume_in_array(run, snapshot);
  while (!whole.advance(64)) continue;
  while (!resumed.advance(7)) continue;
  expect_identical(resumed.result(), whole.result());
  EXPECT_TRUE((resumed.droplet().state().position == whole.droplet().state().position).all());
}

TEST(DropletRun, GoesOnFromASnapshotWithItsAnchors) {
  const auto has_anchors = [](const DropletState& state) { return !state.anchors.empty(); };
  expect_to_go_on(resolve(with_friction(soft_among_walls(), 0.02, FilmFriction::off)), has_anchors);
  RunParameters wet = soft_among_walls();
  wet.dp.receding_angle = 150;
  expect_to_go_on(resolve(wet), has_anchors);
}

TEST(DropletRun, GoesOnFromASnapshotWithAnchorsThroughFilms) {
  RunParameters run = with_friction(soft_among_walls(), 0.3, FilmFriction::on);
  run.dp.line_tension = 0.03;
  run.max_time = 2000;
  run = resolve(run);
  expect_to_go_on(run, [&](const DropletState& state) { return test::num_behind_films(state) > 0; });
}

TEST(DropletRun, GoesOnFromEverySnapshotBitForBit) {
  for (const Model model : {Model::dp, Model::sp}) {
    RunParameters run = long_run(model);
    if (model == Model::dp)
      run.obstacles.gap = 0.35, run.dp.line_tension = 0.2, run.dp.break_up_neck = 0.02, run.seed = 1;
    DropletRun whole(run);
    EXPECT_TRUE(whole.snapshot().empty());
    std::vector<std::vector<std::byte>> snapshots;
    while (!whole.advance(1))
      if (!whole.snapshot().empty() && (snapshots.empty() || snapshots.back() != whole.snapshot()))
        snapshots.push_back(whole.snapshot());
    ASSERT_EQ(snapshots.size(), 3u);
    EXPECT_EQ(std::isnan(whole.result().neck.width), model == Model::sp) << whole.result().neck.width;
    for (const std::vector<std::byte>& snapshot : snapshots) {
      DropletRun resumed = resume_in_array(run, snapshot);
      EXPECT_GT(resumed.time(), 200);
      while (!resumed.advance(7)) continue;
      expect_identical(resumed.result(), whole.result());
      EXPECT_EQ(resumed.result().speed.mean, whole.result().speed.mean);
      EXPECT_TRUE((resumed.droplet().state().position == whole.droplet().state().position).all());
      EXPECT_EQ(resumed.snapshot(), whole.snapshot());
    }
  }
}

TEST(DropletRun, RefusesASnapshotThatIsTornOrOfAnotherRun) {
  const RunParameters run = long_run(Model::sp);
  DropletRun whole(run);
  while (whole.snapshot().empty()) ASSERT_FALSE(whole.advance(100));
  std::vector<std::byte> bytes = whole.snapshot();
  EXPECT_THROW(resume_in_array(long_run(Model::dp), bytes), Error);
  for (const std::size_t size : {bytes.size() - 1, bytes.size() / 2, std::size_t{4}, std::size_t{0}})
    EXPECT_THROW(resume_in_array(run, std::span(bytes).first(size)), Error) << size;
  bytes.push_back(std::byte{0});
  EXPECT_THROW(resume_in_array(run, bytes), Error);
  bytes.pop_back();
  bytes[0] = ~bytes[0];
  EXPECT_THROW(resume_in_array(run, bytes), Error);
}

/// Tries snapshots that have a correct checksum and wrong content: several unlikely values replace each
/// number in turn. resume() may refuse such a snapshot. If resume() accepts the snapshot, the run must
/// continue to its end, without a crash or an endless loop.
TEST(DropletRun, EndsWhateverItsSnapshotHolds) {
  RunParameters run = with_friction(soft_among_walls(), 0.02, FilmFriction::off);
  run.dp.vertices = 32;
  run = resolve(run);
  const auto obstacles = std::make_shared<ObstacleArray>(sample_obstacles(run.obstacles, run.seed));
  DropletRun whole(run);
  while (whole.snapshot().empty()) ASSERT_FALSE(whole.advance(64));
  ASSERT_GT(whole.droplet().state().anchors.size(), 0u);
  std::vector<std::byte> bytes = whole.snapshot();
  const auto resume_and_go_on = [&] {
    DropletRun resumed = DropletRun::resume(run, obstacles, bytes);
    resumed.advance(2);
    return resumed.result();
  };
  ASSERT_NO_THROW(resume_and_go_on());
  constexpr std::size_t word = sizeof(double);
  int refused = 0;
  for (std::size_t at = 0; at + word <= bytes.size(); at += word)
    for (const double value :
         {std::numeric_limits<double>::infinity(), std::nan(""), -1e300, 0.0,
          std::bit_cast<double>(std::int64_t{-1}), std::bit_cast<double>(std::int64_t{3})}) {
      std::byte before[word];
      std::memcpy(before, &bytes[at], word);
      std::memcpy(&bytes[at], &value, word);
      try {
        resume_and_go_on();
      } catch (const Error&) {
        ++refused;
      }
      std::memcpy(&bytes[at], before, word);
    }
  const auto numbers_of_shape = static_cast<int>(4 * 32);
  EXPECT_GT(refused, 3 * numbers_of_shape);  // each number is replaced by infinity, NaN and -1e300
}

/// A droplet's dwells before its clog do not depend on the way in which the clog is detected.
TEST(DropletRun, ItsDwellsDoNotDependOnHowClogsAreFound) {
  RunParameters run = small_run(2);
  run.max_time = 5000;
  const RunResult certified = result_of(run, 1000);
  run.clog_detection = ClogDetection::threshold;
  const RunResult threshold = result_of(run, 1000);
  ASSERT_EQ(certified.status, RunStatus::clogged);
  ASSERT_EQ(threshold.status, RunStatus::clogged);
  EXPECT_GT(threshold.time, certified.time);
  EXPECT_EQ(bytes_of(certified.dwells), bytes_of(threshold.dwells));
  EXPECT_NEAR(certified.dwells.last_distance, certified.distance, run.dwell_length);
  EXPECT_LT(certified.dwells.last_begin, certified.time);
}

TEST(DropletRun, ADropletThatHangsToTheEndOfItsTimeHasADwell) {
  RunParameters run = small_run(2);
  run.max_time = 300;
  run.clog_detection = ClogDetection::threshold;
  run.clog_energy = 1e-300;
  const RunResult result = result_of(run, 1000);
  ASSERT_EQ(result.status, RunStatus::flowing);
  EXPECT_GT(result.dwells.longest[0].length, 200);
  EXPECT_EQ(result.dwells.longest[0].begin, result.dwells.last_begin);
  EXPECT_EQ(result.dwells.longest[0].begin + result.dwells.longest[0].length, result.time);
}

/// Each way of detecting a clog waits for a different time after the droplet came to rest. This time must not
/// count in the steady speed.
TEST(DropletRun, ItsSteadyTravelEndsAtTheArrestHoweverTheClogIsFound) {
  RunParameters run = small_run(1);
  run.drag.terminal_speed = 0.1;  // the steady speed begins after 50 t0
  run.max_time = 5000;
  RunResult certified;
  while (!(certified.dwells.last_begin > 60)) {
    ASSERT_LT(++run.seed, 100u);
    certified = result_of(run, 1000);
  }
  run.clog_detection = ClogDetection::threshold;
  const RunResult threshold = result_of(run, 1000);
  ASSERT_EQ(certified.status, RunStatus::clogged);
  ASSERT_EQ(threshold.status, RunStatus::clogged);
  EXPECT_GT(threshold.time, certified.time);
  EXPECT_EQ(bytes_of(certified.steady), bytes_of(threshold.steady));
  EXPECT_NEAR(certified.steady.time, certified.dwells.last_begin - 50, 1);
}

TEST(DropletRun, ItsSteadyTravelIsThatOfTwoRunsOfTheSameSeed) {
  RunParameters run = small_run();
  run.drag.terminal_speed = 0.1;
  run.obstacles.gap = 1.2;
  run.obstacles.density = {};
  run.max_time = 90;
  const RunResult result = result_of(run, 1000);
  ASSERT_EQ(result.status, RunStatus::flowing);
  run.max_time = result.time - result.steady.time;
  const RunResult start = result_of(run, 1000);
  EXPECT_NEAR(start.time, 50, 1);
  EXPECT_DOUBLE_EQ(result.steady.distance, result.distance - start.distance);
}

TEST(DropletRun, OfAnotherSeedDiffers) {
  RunParameters other = small_run();
  other.seed = 4;
  EXPECT_NE(result_of(small_run(), 100).distance, result_of(other, 100).distance);
}

TEST(DropletRun, EndsFlowingWhenItsTimeIsUp) {
  RunParameters parameters = small_run();
  parameters.obstacles.gap = 1.2;
  parameters.obstacles.density = {};
  const RunResult result = result_of(parameters, 100);
  EXPECT_EQ(result.status, RunStatus::flowing);
  const double step = *resolve(parameters).time_step;
  EXPECT_DOUBLE_EQ(result.time, std::round(40 / step) * step);
  EXPECT_EQ(result.hold.mechanism, ClogMechanism::none);
  EXPECT_GT(result.distance, 0.5);
  EXPECT_GT(result.speed.mean, 0.5 * parameters.drag.terminal_speed);
}

TEST(DropletRun, AStiffDropletInNarrowGapsClogsAndStaysWhereItIs) {
  RunParameters parameters = small_run(2);
  parameters.max_time = 5000;
  parameters.clog_detection = ClogDetection::threshold;
  DropletRun run(parameters);
  while (!run.advance(1000)) continue;
  ASSERT_EQ(run.result().status, RunStatus::clogged);
  EXPECT_LT(run.result().kinetic_energy_ratio, 1e-17);
  EXPECT_LT(run.result().time, 5000);
  EXPECT_EQ(run.result().hold.mechanism, ClogMechanism::squeezed);
  EXPECT_GE(run.result().hold.geometry.num_arcs, 2);

  // The droplet must stay in place if the integration continues. To test this, the run is repeated with a
  // threshold that the droplet cannot reach, so that the run does not end at the clog.
  RunParameters on = parameters;
  on.clog_energy = 1e-300;
  on.max_time = 2 * run.result().time + 100;
  const RunResult later = result_of(on, 1000);
  EXPECT_EQ(later.status, RunStatus::flowing);
  EXPECT_NEAR(later.distance, run.result().distance, 1e-6);
}

TEST(DropletRun, KeepsItsContactsShallowAndItsAreaOnTheWay) {
  for (const double line_tension : {0.2, 1.0, 10.0}) {
    DropletRun run(small_run(line_tension, 256));
    while (!run.advance(50)) {
      const PolygonShape shape = run.droplet().shape();
      EXPECT_NEAR(shape.area, 0.7854, 0.02);
      EXPECT_LT(shape.shape_parameter(), 5);
    }
    EXPECT_NE(run.result().status, RunStatus::failed);
  }
}

TEST(DropletRun, ADivergedRunIsAResult) {
  // The step is too long for the contacts of this soft disk. resolve() would refuse it, but is not called.
  RunParameters parameters = small_run();
  parameters.model = Model::sp;
  parameters.wall_stiffness = 1e9;
  parameters.time_step = 0.5;
  parameters.drag.terminal_speed = 30;
  parameters.max_time = 1e5;
  expect_diverged(result_of(parameters, 100));
}

TEST(DropletRun, ABurstPolygonIsAResultToo) {
  // The step would have to be split into too many parts. resolve() would refuse it, but is not called.
  RunParameters parameters = small_run();
  parameters.drag.terminal_speed = 100;
  parameters.time_step = 5;
  parameters.max_time = 1e6;
  expect_diverged(result_of(parameters, 10));
}

TEST(DropletRun, FailsWhenTheInterfaceCrossesItself) {
  // Far below the tested line tensions the interface grows and crosses itself, although area and speed stay
  // normal.
  RunParameters parameters = small_run(0.001);
  parameters.max_time = 1000;
  const RunResult result = result_of(parameters, 1000);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_NE(result.message.find("crossed itself"), std::string::npos) << result.message;
  EXPECT_EQ(result.failed_by, FailedBy::crossing);
  EXPECT_LT(result.time, 1000);

  // Every 2048 steps the run checks whether the droplet crosses itself. The sound distance is the distance at
  // the last check without a crossing. If a crossing is still there at the next check, the run fails. From
  // the crossing on, the sound distance stays, while the droplet sinks further.
  parameters.max_time = result.time - (2048 + DropletRun::steps_per_check) * parameters.time_step.value();
  const RunResult before = result_of(parameters, 1000);
  EXPECT_EQ(before.status, RunStatus::flowing);
  EXPECT_EQ(before.distance, before.sound_distance);
  EXPECT_EQ(result.sound_distance, before.distance);
  EXPECT_GT(result.distance, result.sound_distance);

  // The published equations have no self-contact, so they permit crossings.
  parameters.dp.self_contact = SelfContact::off;
  EXPECT_EQ(result_of(parameters, 1000).status, RunStatus::flowing);
}

TEST(DropletRun, ADropletThatHasNotFallenYetIsNotClogged) {
  RunParameters parameters = small_run();
  parameters.obstacles.gap = 1.2;
  parameters.obstacles.density = {};
  parameters.drag.terminal_speed = 10;
  parameters.clog_energy = 5e-4;  // at its first checks the droplet is still slower than this
  DropletRun run(parameters);
  run.advance(5);
  EXPECT_EQ(run.result().status, RunStatus::running);
}

TEST(DropletRun, RunsWithSpringsToTheRestLength) {
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    RunParameters parameters;
    parameters.dp.perimeter_spring = PerimeterSpring::rest;
    parameters.dp.vertices = 128;
    parameters.obstacles.box = 20;
    parameters.obstacles.density = {};
    parameters.max_time = 3;
    parameters.seed = seed;
    EXPECT_EQ(result_of(resolve(parameters), 10).status, RunStatus::flowing) << "seed " << seed;
  }
}

TEST(DropletRun, FollowsASoftDiskToo) {
  RunParameters parameters;
  parameters.model = Model::sp;
  parameters.wall_stiffness = 5;
  parameters.obstacles.box = 20;
  parameters.obstacles.density = {};
  parameters.max_time = 2000;
  const RunResult result = result_of(resolve(parameters), 1000);
  EXPECT_EQ(result.status, RunStatus::clogged);
  EXPECT_EQ(result.shape_parameter, 1);
  EXPECT_EQ(result.hold.mechanism, ClogMechanism::squeezed);
}

/// A droplet that starts 3 sigma upstream of a circle of diameter 0.3. The circle's centre is `offset` beside
/// the path of the droplet.
RunParameters falls_onto_a_circle(double line_tension, double offset, int vertices = 128) {
  RunParameters run;
  run.dp.line_tension = line_tension;
  run.dp.vertices = vertices;
  run.dp.break_up_neck = 0.03;
  run.obstacles.box = 20;
  run.obstacles.layout = ObstacleLayout::file;
  run.obstacles.own = OwnCircles({{13, 10 + offset, 0.15}});
  run.max_time = 250;
  return resolve(run);
}

/// The liquid hangs on both sides of a thin film over the obstacle. The film has two interfaces on each side,
/// so four times the tension Gamma carries the weight pi/4. Below Gamma = pi/16 the film breaks. A stiffer
/// droplet stays on the obstacle.
TEST(BreakUp, HeadOnADropletTooHeavyForFourInterfacesBreaks) {
  for (const int vertices : {64, 128, 256}) {
    const RunResult broken = result_of(falls_onto_a_circle(0.95 * std::numbers::pi / 16, 0, vertices), 100);
    EXPECT_EQ(broken.status, RunStatus::broken) << vertices;
    EXPECT_LT(broken.neck.width, 0.03);
    EXPECT_EQ(broken.neck.distance, broken.distance);
    EXPECT_EQ(broken.clogged_by, FoundBy::not_clogged);
    const RunResult whole = result_of(falls_onto_a_circle(0.4, 0, vertices), 100);
    EXPECT_EQ(whole.status, RunStatus::flowing) << vertices;
    EXPECT_LT(whole.distance, 3) << "it lies on the obstacle";
  }
}

/// A droplet that would break up in a head-on collision slips off to one side in an off-centre collision.
/// Only a softer droplet breaks up in such a collision.
TEST(BreakUp, OffCentreADropletHasToBeSofterToBreak) {
  for (const double side : {-1.0, 1.0}) {
    const RunResult passed = result_of(falls_onto_a_circle(0.15, 0.1 * side), 100);
    EXPECT_EQ(passed.status, RunStatus::flowing);
    EXPECT_GT(passed.distance, 4);
    EXPECT_GT(passed.lateral * -side, 0.1);
    EXPECT_EQ(result_of(falls_onto_a_circle(0.05, 0.1 * side), 100).status, RunStatus::broken);
    EXPECT_EQ(result_of(falls_onto_a_circle(0.05, 0.3 * side), 100).status, RunStatus::flowing);
  }
}

/// The search for necks changes only the end of a run.
TEST(BreakUp, TheCourseIsTheSameWithoutIt) {
  RunParameters run = falls_onto_a_circle(0.05, 0.1);
  const RunResult broken = result_of(run, 100);
  run.max_time = broken.time;
  run.dp.break_up_neck = 0;
  const RunResult same = result_of(run, 100);
  EXPECT_EQ(same.status, RunStatus::flowing);
  EXPECT_TRUE(std::isnan(same.neck.width));
  EXPECT_EQ(same.distance, broken.distance);
  EXPECT_EQ(same.kinetic_energy_ratio, broken.kinetic_energy_ratio);
}

/// The run starts from a droplet that hangs over an obstacle. The neck of the droplet still gets thinner, but
/// the certified detection already knows the place of rest. If the neck will be too thin at this place, the
/// droplet does not count as clogged. It must break up as soon as its neck is too thin.
TEST(BreakUp, ComesBeforeACertifiedClog) {
  RunParameters run;
  run.dp.perimeter_spring = PerimeterSpring::rest;
  run.dp.line_tension = 0.1;
  run.dp.perimeter_stiffness = 0.1 * run.dp.line_tension;
  run.dp.gravity = Gravity::vertex;
  run.dp.vertices = 64;
  run.obstacles.gap = 0.3;
  run.obstacles.box = 40;
  run.obstacles.density = {};
  run.max_time = 3000;
  run.seed = 3;
  run = resolve(run);
  DropletRun hung(run);
  while (!hung.advance(1000)) continue;
  ASSERT_EQ(hung.result().clogged_by, FoundBy::certified);
  const DropletState state = hung.droplet().state();
  const std::optional<DropletState> rest = model_of(run).equilibrium(run, hung.obstacles(), state);
  ASSERT_TRUE(rest);
  const double now = thinnest_neck(state.position).width, at_rest = thinnest_neck(rest->position).width;
  ASSERT_LT(at_rest, now);
  run.max_time = 1000;
  const auto obstacles = std::make_shared<const ObstacleArray>(sample_obstacles(run.obstacles, run.seed));
  for (const double share : {-0.5, 0.5}) {  // The limit is below or above the width of the neck at rest.
    run.dp.break_up_neck = at_rest + share * (now - at_rest);
    DropletRun on(run, obstacles, state);
    while (!on.advance(1000)) continue;
    EXPECT_EQ(on.result().status, share > 0 ? RunStatus::broken : RunStatus::clogged)
        << at_rest << " " << now;
  }
}

}  // namespace
}  // namespace clog
