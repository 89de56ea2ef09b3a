#include "clog/core/polygon/contact/self_crossings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/polygon/step/dp_droplet.hpp"
#include "support.hpp"

namespace clog::test_of_self_crossings {
namespace {

/// A droplet with a neck. The two sides of the neck approach each other.
struct Neck {
  RunParameters run;
  DropletState state;

  Neck(int vertices, double speed) {
    run.dp.vertices = vertices;
    run.dp.line_tension = 0.1;
    run = resolve(run);
    const double thin = units::regular_edge_length(vertices);
    const double size = std::sqrt(units::rest_area / polygon_shape(test::dumbbell(vertices, thin)).area);
    state = test::state_of(size * test::dumbbell(vertices, 4 * run.dp.self_contact_range / size));
    const auto x = state.x();
    const auto y = state.y();
    for (Eigen::Index i = 0; i < state.size(); ++i)
      if (std::abs(x[i]) < 0.2) state.velocity[state.size() + i] = y[i] > 0 ? -speed : speed;
  }
};

const ObstacleArray nothing(20, std::vector<Obstacle>{});

TEST(SelfCrossings, HealBeyondTheBarrierOfSelfContact) {
  // Vertices with more kinetic energy than the barrier k_c d_s^2/2 pass through the other side of the neck.
  for (const int vertices : {128, 256}) {
    Neck slow(vertices, 0.05), fast(vertices, 3);
    DpDroplet calm(slow.run, nothing, slow.state), wild(fast.run, nothing, fast.state);
    calm.advance(400);
    EXPECT_EQ(calm.state().num_healed, 0) << vertices << ' ' << *slow.run.time_step;
    wild.advance(400);
    EXPECT_GT(wild.state().num_healed, 0) << vertices;
    EXPECT_TRUE(wild.state().crossings.empty()) << vertices;
    EXPECT_EQ(num_self_crossings(wild.state().position), 0) << vertices;
  }
}

TEST(SelfCrossings, AreSavedAndRestored) {
  const Neck neck(128, 3);
  DpDroplet droplet(neck.run, nothing, neck.state);
  while (droplet.state().crossings.empty()) {
    droplet.advance(1);
    ASSERT_LT(droplet.num_integrated_steps(), 400);
  }
  droplet.rebuild_lists();
  ByteWriter bytes;
  droplet.save(bytes);
  const std::vector<std::byte> saved = bytes.take();
  DpDroplet restored(neck.run, nothing, neck.state);
  ByteReader reader(saved);
  restored.restore(reader);
  EXPECT_EQ(restored.state().crossings.size(), droplet.state().crossings.size());
  droplet.advance(400);
  restored.advance(400);
  EXPECT_GT(droplet.state().num_healed, 0);
  EXPECT_EQ(restored.state().num_healed, droplet.state().num_healed);
  EXPECT_TRUE((restored.state().position == droplet.state().position).all());
  EXPECT_TRUE((restored.state().velocity == droplet.state().velocity).all());
}

/// A contour with a spike from above and a finger. Vertex 0 is the tip of the spike. A test can lead this
/// vertex through the finger from the left, and round the finger's tip at the origin. The finger is between
/// edges 4 and 5, which meet at vertex 5.
class SpikeAtFinger {
 public:
  SpikeAtFinger() : forces_(run(), nothing), state_(test::state_of(shape())) {}

  static RunParameters run() {
    RunParameters run = test::bare_parameters(16);
    run.dp.line_tension = 0;
    run.dp.area_stiffness = 0;
    run.dp.perimeter_stiffness = 0;
    run.dp.self_contact_range = 0.1;
    run.drag.terminal_speed = test::no_drag;
    return run;
  }

  /// Leads the vertex along a straight line in steps of this length. Returns the largest change of the energy
  /// in a step.
  double lead_to(double x, double y, double step) {
    const Eigen::Array2d from{state_.x()[0], state_.y()[0]}, way = Eigen::Array2d(x, y) - from;
    const double num_steps = std::ceil(way.matrix().norm() / step);
    double largest = 0;
    for (double k = 1; k <= num_steps; ++k) {
      const double before = energy();
      const Eigen::Array2d to = from + k / num_steps * way;
      Eigen::ArrayXd moved = Eigen::ArrayXd::Zero(2 * state_.size());
      moved[0] = to[0] - state_.position[0];
      moved[state_.size()] = to[1] - state_.position[state_.size()];
      state_.position += moved;
      forces_.forget_all_contacts();
      forces_.update_contacts(state_, {});
      const auto n = static_cast<int>(state_.size());
      const double* const places = state_.position.data();
      crossings_.follow({n, places, places + n}, {moved.data(), moved.data() + state_.size(), 1},
                        forces_.self_contacts(), state_);
      largest = std::max(largest, std::abs(energy() - before));
    }
    return largest;
  }

  double energy() {
    forces_.forget_all_contacts();
    forces_.update_contacts(state_, {});
    return forces_.energy(state_).self_contact;
  }
  double total_energy() { return energy() + forces_.energy(state_).gravity; }
  DropletState& state() { return state_; }

 private:
  DpForces forces_;
  SelfCrossings crossings_;
  DropletState state_;

  static Eigen::ArrayXd shape() {
    Eigen::ArrayXd position(32);
    position << -0.4, -0.25, -1.5, -1.6, -1.2, 0, -1.2, -1.2, -0.6, 0, 0.6, 1.2, 1.5, 1.8, 1.7, 0.25,  //
        0.3, 0.8, 1.2, 0.4, 0, 0, -0.5, -1.2, -1.6, -1.8, -1.7, -1.6, -1.2, -0.5, 0.6, 0.8;
    return position;
  }
};

/// A path through both sides of the finger, and back round its tip.
struct Place {
  double x, y;
};
const std::vector<Place> near_the_tip = {{-0.1, 0.05}, {-0.1, -0.02}, {-0.03, -0.05}, {0.05, -0.04},
                                         {0.07, 0.02}, {0, 0.07},     {-0.4, 0.3}};
const std::vector<Place> far_from_the_tip = {{-0.4, -0.08}, {-0.2, -0.2}, {0.15, -0.2},
                                             {0.3, 0},      {0.2, 0.4},   {-0.4, 0.3}};

TEST(SelfCrossings, HaveAContinuousEnergyOnTheirWayRoundAFreeEnd) {
  for (const std::vector<Place>& path : {near_the_tip, far_from_the_tip}) {
    const auto largest_change = [&](double step) {
      SpikeAtFinger spike;
      double largest = 0;
      std::size_t most_crossings = 0;
      for (const Place& place : path) {
        largest = std::max(largest, spike.lead_to(place.x, place.y, step));
        most_crossings = std::max(most_crossings, spike.state().crossings.size());
      }
      EXPECT_EQ(most_crossings, 2U) << "one on each side of the finger";
      EXPECT_TRUE(spike.state().crossings.empty());
      EXPECT_NEAR(spike.energy(), 0, 1e-12);
      return largest;
    };
    EXPECT_LT(largest_change(1e-4), 0.15 * largest_change(1e-3));
  }
}

/// The force on each coordinate of a droplet at rest, from the velocity after one short step.
Eigen::ArrayXd forces_of_step(const RunParameters& given, const DropletState& state) {
  RunParameters run = given;
  run.time_step = 1e-6;  // so short that nothing moves
  DpDroplet droplet(run, nothing, state);
  droplet.advance(1);
  return droplet.state().velocity *
         (units::droplet_mass / static_cast<double>(state.size()) / *run.time_step);
}

TEST(SelfCrossings, PushInTheStepWithTheSlopeOfTheirEnergy) {
  int num_crossed = 0;
  for (const std::vector<Place>& path : {near_the_tip, far_from_the_tip}) {
    SpikeAtFinger spike;
    for (const Place& place : path) {
      spike.lead_to(place.x, place.y, 1e-3);
      num_crossed += !spike.state().crossings.empty();
      const Eigen::ArrayXd force = forces_of_step(SpikeAtFinger::run(), spike.state());
      for (Eigen::Index k = 0; k < force.size(); ++k) {
        constexpr double step = 1e-6;
        double& coordinate = spike.state().position[k];
        const double there = coordinate;
        coordinate = there + step;
        const double above = spike.total_energy();
        coordinate = there - step;
        const double below = spike.total_energy();
        coordinate = there;
        EXPECT_NEAR(force[k], (below - above) / (2 * step), 1e-5 * force.abs().maxCoeff())
            << k << " at " << place.x << ' ' << place.y;
      }
    }
  }
  EXPECT_GE(num_crossed, 4);
}

TEST(SelfCrossings, PushWithTheSlopeOfTheirEnergyWhereSeveralNeighboursPassed) {
  const Neck neck(256, 3);
  DpDroplet droplet(neck.run, nothing, neck.state);
  SelfContacts contacts(neck.run.dp.self_contact_range, units::regular_edge_length(256));
  std::size_t most = 0;
  for (int step = 0; step < 400; ++step) {
    droplet.advance(1);
    DropletState state = droplet.state();
    if (state.crossings.empty()) continue;
    most = std::max(most, state.crossings.size());
    const auto n = static_cast<int>(state.size());
    const double* const places = state.position.data();
    const Contour contour{n, places, places + n};
    contacts.rebuild(state, {});
    SelfCrossings crossings;
    crossings.rebuild(contour, state.crossings);
    crossings.find_pushes(contour, contacts);
    Eigen::ArrayXd force = Eigen::ArrayXd::Zero(state.position.size()), slope = force;
    for (const auto& [vertex, push] : crossings.pushes()) {
      force[vertex] += push[0];
      force[n + vertex] += push[1];
    }
    for (Eigen::Index k = 0; k < force.size(); ++k) {
      constexpr double small = 1e-8;
      double& coordinate = state.position[k];
      const double there = coordinate;
      coordinate = there + small;
      const double above = crossings.find_pushes(contour, contacts);
      coordinate = there - small;
      slope[k] = (above - crossings.find_pushes(contour, contacts)) / (2 * small);
      coordinate = there;
    }
    EXPECT_LT((force + slope).abs().maxCoeff(), 1e-5 * force.abs().maxCoeff()) << step;
  }
  EXPECT_GT(most, 2U);
}

TEST(SelfCrossings, PushWithRangePlusDepth) {
  // The spike is far from other edges.
  SpikeAtFinger spike;
  spike.lead_to(-0.6, -0.08, 1e-3);
  ASSERT_EQ(spike.state().crossings.size(), 1U);
  const RunParameters run = SpikeAtFinger::run();
  const double stiffness = contact_stiffness(*run.wall_stiffness, units::regular_edge_length(16));
  EXPECT_NEAR(forces_of_step(run, spike.state())[16], stiffness * (0.1 + 0.08), 1e-6 * stiffness);
}

TEST(SelfCrossings, AreNoRest) {
  SpikeAtFinger spike;
  spike.lead_to(-0.6, -0.08, 1e-3);
  EXPECT_FALSE(model_of(SpikeAtFinger::run()).equilibrium(SpikeAtFinger::run(), nothing, spike.state()));
}

}  // namespace
}  // namespace clog::test_of_self_crossings
