#include "clog/core/polygon/contact/wall_friction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "clog/core/model/model.hpp"
#include "clog/core/polygon/step/dp_droplet.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "polygon/forces/reference_forces.hpp"
#include "support.hpp"

namespace clog {
namespace {

using namespace test;
using std::numbers::pi;

RunParameters rough(double friction, double yield_traction) {
  RunParameters run = bare_parameters();
  run.dp.friction = friction;
  run.dp.yield_traction = yield_traction;
  return run;
}

/// Lets walls hold the droplet in place.
void anchor(const RunParameters& run, const ObstacleArray& walls, const DpForces& forces,
            DropletState& state) {
  WallTouches touches(run, walls);
  forces.let_walls_yield(state, touches, forces.walls().items(), Purpose::motion);
}

TEST(WallFriction, ForceIsTheGradientOfTheEnergyWhileTheAnchorsRest) {
  const RunParameters run = rough(0.5, 0);
  const double reach = 0.5 + *run.dp.contact_range;
  const Wedge flank{.tip = {0.1, -reach * 0.98}, .axis = {0.6, -0.8}, .half_angle = 0.7, .radius = 0.05};
  const ObstacleArray walls(20, {{reach + 0.14, 0.05, 0.15}}, {flank});
  DropletState state = state_of(regular_polygon(64, units::rest_area));
  ReferenceForces forces(run, walls);
  forces.update_contacts(state, {.absolute = 0.01, .relative = 0.01});
  anchor(run, walls, forces, state);
  ASSERT_GE(state.anchors.size(), 5);
  EXPECT_TRUE(std::ranges::any_of(state.anchors, [](const WallAnchor& one) { return one.wall.wedge == 0; }));
  state.position = shaken(state.position, 0.003);
  EXPECT_GT(forces.energy(state).anchors, 1e-4);
  EXPECT_LT(force_error(forces, state), 1e-6);
}

TEST(WallTouches, PushesAddUpToTheContactsForce) {
  const RunParameters run = rough(0.5, 0);
  RunParameters smooth = run;
  smooth.dp.friction = 0;
  const ObstacleArray walls(20, {{0.66, 0.05, 0.15}});
  const ObstacleArray nothing = no_obstacles();
  DropletState state = state_of(shaken(regular_polygon(64, units::rest_area), 0.002));
  const auto force_of = [&](const ObstacleArray& array) {
    ReferenceForces forces(smooth, array);
    forces.update_contacts(state, {});
    Eigen::ArrayXd force(128);
    forces.evaluate(state, force);
    return force;
  };
  const Eigen::ArrayXd by_wall = force_of(walls) - force_of(nothing);
  DpForces forces(run, walls);
  forces.update_contacts(state, {});
  WallTouches finder(run, walls);
  double sum = 0, wetted = 0;
  for (const WallTouch& touch : finder.find(state, forces.walls().items())) {
    const Eigen::Array2d normal =
        (Eigen::Array2d(state.x()[touch.vertex], state.y()[touch.vertex]) - Eigen::Array2d(0.66, 0.05))
            .matrix()
            .normalized();
    const Eigen::Array2d push{by_wall[touch.vertex], by_wall[64 + touch.vertex]};
    EXPECT_NEAR(touch.push, std::max(0.0, (push * normal).sum()), 1e-9);
    sum += touch.push;
    wetted += touch.wetted;
  }
  EXPECT_GT(sum, 1);
  EXPECT_GT(wetted, 2 * units::regular_edge_length(64));
}

/// Describes how well the sum of a held droplet's energy and the dissipated energy is conserved.
struct Balance {
  double worst = 0;  ///< Largest difference between the sum and its first value.
  double rise = 0;   ///< Largest rise of the droplet's energy alone between two times.
  double anchors = 0, dissipated = 0;
};
Balance balance(RunParameters run, const ObstacleArray& wall, const Eigen::ArrayXd& initial,
                double terminal_speed, double time_step) {
  run.drag.terminal_speed = terminal_speed;
  run.dp.area_stiffness = 100;
  run.time_step = time_step;
  DpDroplet droplet(run, wall, state_of(initial));
  droplet.measure_dissipation();
  const auto energy = [&] { return droplet.kinetic_energy() + droplet.potential_energy().total(); };
  const auto taken = [&] { return droplet.work().dissipated - droplet.work().spreading; };
  const double begin = energy();
  Balance balance;
  double before = begin;
  for (int i = 0; i < 20; ++i) {
    droplet.advance(static_cast<int>(std::lround(0.08 / time_step)));
    const double now = energy();
    balance.worst = std::max(balance.worst, std::abs(now + taken() - begin));
    balance.rise = std::max(balance.rise, now - before);
    balance.anchors = std::max(balance.anchors, droplet.potential_energy().anchors);
    before = now;
  }
  balance.dissipated = droplet.work().dissipated;
  return balance;
}
void expect_balance(const RunParameters& run, const ObstacleArray& wall, double terminal_speed,
                    const Eigen::ArrayXd& initial = regular_polygon(64, units::rest_area),
                    double most = 1e-6) {
  const Balance coarse = balance(run, wall, initial, terminal_speed, 4e-4);
  const Balance fine = balance(run, wall, initial, terminal_speed, 2.5e-5);
  EXPECT_GT(fine.anchors, 1e-5);
  EXPECT_GT(fine.dissipated, 0.1);
  EXPECT_LT(fine.worst, most);
  EXPECT_GT(std::log2(coarse.worst / fine.worst) / 4, 1.6) << coarse.worst << ' ' << fine.worst;
  EXPECT_LE(fine.rise, 0);
}

TEST(WallAnchors, OfFrictionBalanceTheEnergyToSecondOrder) {
  expect_balance(rough(0.3, 0), ObstacleArray(20, {{0.775, 0.2, 0.15}}), 0.5);
}

/// Two lobes side by side. The neck between them is thin enough to touch itself.
Eigen::ArrayXd lobes_side_by_side(double neck) {
  const Eigen::ArrayXd along = dumbbell(64, neck);
  Eigen::ArrayXd across(along.size());
  across << -along.tail(64), along.head(64);
  return std::sqrt(units::rest_area / polygon_shape(across).area) * across;
}

TEST(WallFriction, ThroughAFilmHasAnEnergyWhileTheAnchorsRest) {
  RunParameters run = rough(0.5, 0);
  run.dp.film_friction = FilmFriction::on;
  const double range = *run.dp.contact_range;
  const double film = 0.98 * run.dp.self_contact_range, overlap = 0.02 * run.dp.self_contact_range;
  DropletState state = state_of(lobes_side_by_side(film));
  const ObstacleArray walls(20, {{0.15 + range + film / 2 - overlap, 0.02, 0.15}});
  ReferenceForces forces(run, walls);
  forces.update_contacts(state, {.absolute = 0.01, .relative = 0.01});
  anchor(run, walls, forces, state);
  const auto is_behind_a_film = [&](const WallAnchor& one) { return one.wall.radius > 0.15 + film; };
  EXPECT_GE(std::ranges::count_if(state.anchors, is_behind_a_film), 1);
  EXPECT_GE(std::ranges::count_if(state.anchors, std::not_fn(is_behind_a_film)), 1);
  state.position = shaken(state.position, 0.003);
  EXPECT_GT(forces.energy(state).anchors, 1e-4);
  EXPECT_LT(force_error(forces, state), 1e-6);
}

TEST(WallAnchors, OfFrictionThroughAFilmBalanceTheEnergyToSecondOrder) {
  RunParameters run = rough(0.3, 0);
  run.dp.line_tension = 0.1;
  run.dp.film_friction = FilmFriction::on;
  const double film = 0.99 * run.dp.self_contact_range;
  expect_balance(run, ObstacleArray(20, {{0.15 + *run.dp.contact_range + film / 2, 0.1, 0.15}}), 0.5,
                 // The tolerance is larger because the contact of the film is stiffer.
                 lobes_side_by_side(film), 1e-5);
}

TEST(WallFriction, IsUsedUpWhereALightRopeBeginsToSlide) {
  // A rope over a disc slides at T_2 = exp(mu theta) T_1 (capstan formula). The moment of friction about the
  // disc's centre is then (T_2 - T_1) R, however the points share this moment.
  constexpr double mu = 0.3, radius = 0.5, stiffness = 1e4;
  constexpr int num = 400;
  const WallFriction friction(mu, 0, stiffness, {});
  for (const double share : {1.0, 0.4}) {
    DropletState state = state_of(Eigen::ArrayXd::Zero(Eigen::Index{2} * num));
    std::vector<WallTouch> touches;
    for (int i = 0; i < num; ++i) {
      const double angle = pi * (i + 0.5) / num, pressed = std::exp(mu * angle) * pi / num;
      const WallPlace disc{0, 0, radius};
      state.x()[i] = radius * std::cos(angle);
      state.y()[i] = radius * std::sin(angle);
      touches.push_back({i, disc, foot_on(disc, {}, {state.x()[i], state.y()[i]}), pressed, 0});
      // Only points near the loaded end of the rope carry load. Each of these points carries as much as it
      // can.
      if (angle < (1 - share) * pi) continue;
      const double slip = mu * pressed / stiffness;
      state.anchors.push_back(
          {i, disc, radius * std::cos(angle - slip / radius), radius * std::sin(angle - slip / radius)});
    }
    const double loaded = std::exp(mu * pi), least = std::exp(mu * (1 - share) * pi);
    EXPECT_NEAR(friction.use(state, touches, {{{0, 0, radius}}}), (loaded - least) / (loaded - 1), 3e-3)
        << share;
    EXPECT_TRUE(std::isnan(friction.use(state, touches, {{{1, 0, radius}}}))) << "another post";
    EXPECT_TRUE(std::isnan(friction.use(state, touches, {})));
  }
}

TEST(WallAnchors, OfAContactLineBalanceTheEnergyToSecondOrder) {
  // A contact line may lose an anchor within a single step, and the error of this step would hide the second
  // order. On an incline no anchor is lost.
  RunParameters run = bare_parameters();
  run.dp.perimeter_spring = PerimeterSpring::along;
  run.dp.perimeter_stiffness = 0.3;
  run.dp.gravity = Gravity::area;
  run.dp.wall_tension = 0.5;
  run.dp.receding_angle = 90;
  run.dp.advancing_angle = 150;
  const Eigen::Array2d into{0.8, -0.6};
  const Wedge incline{.tip = (0.5 + *run.dp.contact_range) * into, .axis = into};
  expect_balance(run, ObstacleArray(20, {}, {incline}), 0.2);
}

/// A rope over half of a disc. The rope consists of vertices that are joined by stiff springs. The straight
/// ends of the rope hang along +x. The disc pushes the vertices away, and holds them by friction. Forces pull
/// at both ends until the rope rests or slides.
class Rope {
 public:
  static constexpr double radius = 0.5;
  struct Law {
    double friction = 0, yield_traction = 0;
  };
  /// @param on_disc   number of edges on the disc
  /// @param first, second  lengths of the ends [sigma]
  Rope(Law law, int on_disc, double weight, double first, double second)
      : weight_(weight),
        edge_(pi * radius / on_disc),
        num_first_(static_cast<int>(std::lround(first / edge_))),
        n_(on_disc + 1 + num_first_ + static_cast<int>(std::lround(second / edge_))),
        friction_(law.friction, law.yield_traction, friction_stiffness_ratio * contact_, {}) {
    state_ = state_of(Eigen::ArrayXd::Zero(Eigen::Index{2} * n_));
    for (int i = 0; i < n_; ++i) {
      const double along = (i - num_first_) * edge_;
      const double angle = along / radius;
      const bool before = i<num_first_, after = i> num_first_ + on_disc;
      state_.position[i] = before ? -along : after ? along - pi * radius : -radius * std::sin(angle);
      state_.position[n_ + i] = before ? radius : after ? -radius : radius * std::cos(angle);
    }
  }

  /// Whether the rope slides towards its second end.
  bool slides(double first_pull, double second_pull) {
    constexpr int loading = 6000, waiting = 40000;
    double before = 0;
    for (int step = 0; step < loading + waiting; ++step) {
      const double share = std::min(1.0, static_cast<double>(step) / loading);
      // Both pulls grow in proportion, so that the rope does not slide before the pulls are complete.
      move(share * first_pull, share * second_pull, share * weight_);
      if (step == loading + waiting / 2) before = state_.position[n_ - 1];
    }
    return state_.position[n_ - 1] - before > 1e-4 * edge_;
  }

 private:
  static constexpr double contact_ = 4e4, spring_ = 8e4;
  double weight_, edge_;
  int num_first_, n_;
  WallFriction friction_;
  KnownAnchors known_;
  DropletState state_;

  /// Makes a step of length 1. The mass is large enough for a stable step. The drag nearly stops the rope
  /// from swinging.
  void move(double first_pull, double second_pull, double weight) {
    constexpr double mass = 8 * spring_;
    const double kept = 1 - 2 * pi * 0.35 / n_;
    Eigen::ArrayXd force = Eigen::ArrayXd::Zero(Eigen::Index{2} * n_);
    auto x = state_.x();
    auto y = state_.y();
    for (int i = 0; i + 1 < n_; ++i) {
      const Eigen::Array2d edge{x[i + 1] - x[i], y[i + 1] - y[i]};
      const double length = edge.matrix().norm();
      const Eigen::Array2d pull = spring_ * (length - edge_) / length * edge;
      force[i] += pull[0], force[n_ + i] += pull[1];
      force[i + 1] -= pull[0], force[n_ + i + 1] -= pull[1];
    }
    std::vector<WallTouch> touches;
    for (int i = 0; i < n_; ++i) {
      force[i] += weight * edge_;
      const double r = std::hypot(x[i], y[i]);
      if (r >= radius) continue;
      const double push = contact_ * (radius - r);
      force[i] += push * x[i] / r, force[n_ + i] += push * y[i] / r;
      // An edge is on the disc if both of its ends are on the disc.
      double wetted = 0;
      if (!touches.empty() && touches.back().vertex == i - 1) {
        touches.back().wetted += edge_ / 2;
        wetted = edge_ / 2;
      }
      const WallPlace disc{0, 0, radius};
      touches.push_back({i, disc, foot_on(disc, {}, {x[i], y[i]}), push, wetted});
    }
    force[0] += first_pull;
    force[n_ - 1] += second_pull;
    friction_.follow(state_, touches, Purpose::motion, known_);
    friction_.add_forces(state_, force);
    state_.velocity = kept * (state_.velocity + force / mass);
    state_.position += state_.velocity;
  }
};

/// The pull at the second end at which the rope begins to slide, with a precision of 0.2 %.
double threshold(const std::function<bool(double)>& slides, double low, double high) {
  while (high - low > 0.002 * high) {
    const double middle = (low + high) / 2;
    (slides(middle) ? high : low) = middle;
  }
  return (low + high) / 2;
}

/// Expects that the error is small with 32 edges on the disc, and smaller than with 16 edges.
void expect_convergence(const std::function<double(int)>& error) {
  const double coarse = error(16), fine = error(32);
  std::printf("error of the threshold: %+.4f with 16, %+.4f with 32 edges on half a turn\n", coarse, fine);
  EXPECT_LT(std::abs(fine), 0.02);
  EXPECT_LT(std::abs(fine), std::max(std::abs(coarse), 0.002)) << "the threshold is known to 0.002";
}

TEST(RopeOverADisc, WithoutWeightSlidesAtExpMuTheta) {
  // For a rope without weight the capstan equation holds: T_2 = exp(mu theta) T_1.
  const double mu = 0.5;
  const double exact = std::exp(mu * pi);
  expect_convergence([&](int edges) {
    const auto slides = [&](double pull) {
      return Rope({.friction = mu}, edges, 0, 0.3, 0.3).slides(1, pull);
    };
    return threshold(slides, 0.8 * exact, 1.2 * exact) / exact - 1;
  });
}

TEST(RopeOverADisc, OfWeightSlidesWhenItsOverhangSaysSo) {
  // The tension follows dT/dphi = mu (T + w R sin phi) + w R cos phi over half a turn. So the rope begins to
  // slide when the lengths of its hanging ends fulfil
  // L_2 = exp(mu pi) L_1 + 2 mu R (1 + exp(mu pi))/(1 + mu^2). The ends of the simulated rope have other
  // lengths. Forces at the ends replace the missing weight, or balance the additional weight.
  const double mu = 0.5, weight = 2;
  const double grip = std::exp(mu * pi);
  const double hanging = 0.3 * 0.5 * pi;
  const double exact =
      grip * hanging + 2 * mu * Rope::radius * (1 + grip) / (1 + mu * mu);  // length of the longer overhang
  expect_convergence([&](int edges) {
    const double edge = pi * Rope::radius / edges;
    const double length = (std::round(hanging / edge) + 0.5) * edge;  // the disc then begins at a vertex
    const auto slides = [&](double overhang) {
      return Rope({.friction = mu}, edges, weight, hanging, hanging)
          .slides(weight * (hanging - length), weight * (overhang - length));
    };
    return threshold(slides, 0.8 * exact, 1.2 * exact) / exact - 1;
  });
}

TEST(RopeOverADisc, ThatOnlySticksSlidesAtPiRTau) {
  // w (L_2 - L_1) = pi R tau_y.
  const double traction = 1.5;
  const double exact = 1 + pi * Rope::radius * traction;
  expect_convergence([&](int edges) {
    const auto slides = [&](double pull) {
      return Rope({.yield_traction = traction}, edges, 0, 0.3, 0.3).slides(1, pull);
    };
    return (threshold(slides, 0.8 * exact, 1.2 * exact) - exact) / (exact - 1);
  });
}

/// An elastic droplet that sinks on a small disc, a little beside the middle of the disc.
DropletRun falls_on_disc(double friction, ClogDetection detection, double clog_energy) {
  RunParameters run;
  run.dp.vertices = 128;
  run.dp.line_tension = 0.1;
  run.dp.perimeter_spring = PerimeterSpring::rest;
  run.dp.perimeter_stiffness_ratio = 0.1;
  run.dp.gravity = Gravity::vertex;
  run.dp.friction = friction;
  run.drag.terminal_speed = 0.1;
  run.obstacles.box = 20;
  run.max_time = 1000;
  run.clog_detection = detection;
  run.clog_energy = clog_energy;
  run = resolve(run);
  DropletState state = state_of(model_of(run).free_shape(run));
  state.x() += 9.3;
  state.y() += 10.02;
  return {run, std::make_shared<ObstacleArray>(20, std::vector<Obstacle>{{10, 10, 0.15}}), std::move(state),
          3.0};
}
RunResult ended(DropletRun run) {
  while (!run.advance(100)) {
  }
  return run.result();
}

TEST(WallFriction, HoldsADropletThatHangsOverADisc) {
  // Without friction the droplet slips off. With friction, both kinds of clog-detection find the same place
  // of rest. The certified detection is faster, because its search for an equilibrium starts as soon as the
  // walls nearly cease to yield.
  constexpr double quiet = 1e-15;
  EXPECT_EQ(ended(falls_on_disc(0, ClogDetection::certified, quiet)).status, RunStatus::passed);
  const RunResult certified = ended(falls_on_disc(0.1, ClogDetection::certified, quiet));
  const RunResult waited = ended(falls_on_disc(0.1, ClogDetection::threshold, quiet));
  ASSERT_EQ(certified.clogged_by, FoundBy::certified);
  ASSERT_EQ(waited.clogged_by, FoundBy::threshold);
  EXPECT_NEAR(certified.distance, waited.distance, 1e-6);
  EXPECT_NEAR(certified.lateral, waited.lateral, 1e-6);
  EXPECT_LT(certified.kinetic_energy_ratio, 1e-10);
  EXPECT_LT(certified.time, 0.8 * waited.time);
}

TEST(WallAnchors, AreSavedAndRestored) {
  const RunParameters run = rough(0.3, 0);
  const ObstacleArray wall(20, {{0.66, 0.1, 0.15}});
  DpDroplet droplet(run, wall, state_of(regular_polygon(64, units::rest_area)));
  droplet.advance(640);
  droplet.rebuild_lists();
  ASSERT_GT(droplet.potential_energy().anchors, 0);
  ByteWriter bytes;
  droplet.save(bytes);
  DpDroplet restored(run, wall, state_of(regular_polygon(64, units::rest_area)));
  const std::vector<std::byte> saved = bytes.take();
  ByteReader reader(saved);
  restored.restore(reader);
  droplet.advance(640);
  restored.advance(640);
  EXPECT_TRUE((restored.state().position == droplet.state().position).all());
  EXPECT_TRUE((restored.state().velocity == droplet.state().velocity).all());
}

}  // namespace
}  // namespace clog
