#include "clog/core/polygon/contact/self_crossings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/polygon/step/dp_droplet.hpp"
#include "support.hpp"

namespace clog::test_of_self_crossings {
namespace {

/// A droplet with a neck whose two sides approach each other.
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
  // Vertices of kinetic energy above the barrier k_c d_s^2/2 pass through the other side of the neck.
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

/// A fold whose upper side is a vertex, 0, at the height y above an edge from 3 to 4, far from the rest.
struct Fold {
  std::vector<double> x = {0, 1, 1.2, 1, -1, -1.2}, y;
  DropletState state;
  explicit Fold(double height) : y({height, 0.5, 0, -0.5, -0.5, 0}) {}

  Contour contour() {
    const auto close = [](std::vector<double>& v) {
      closed.insert(closed.end(), v.end() - 1, v.end());
      closed.insert(closed.end(), v.begin(), v.end());
      closed.insert(closed.end(), v.begin(), v.end());
      closed.insert(closed.end(), v.begin(), v.end());
    };
    closed.clear();
    close(x), close(y);
    const std::size_t half = closed.size() / 2;
    return {6, closed.data() + 1, closed.data() + half + 1};
  }

 private:
  static inline std::vector<double> closed;
};

TEST(SelfCrossings, PushBackWithTheSlopeOfTheirEnergy) {
  SelfContacts contacts(0.1, 0.3);
  for (const double height : {-0.52, -0.6, -0.9}) {
    Fold fold(height);
    contacts.update(
        test::state_of((Eigen::ArrayXd(12) << 0, 1, 1.2, 1, -1, -1.2, 0, .5, 0, -.5, -.5, 0).finished()), {});
    const SelfCrossing crossing{.vertex = 0, .edge = 3};
    const SelfCrossings::Push push = SelfCrossings::push_back(crossing, fold.contour(), contacts);
    EXPECT_NEAR(push.force[1], 0.1 + (-0.5 - height), 1e-12) << height;
    EXPECT_NEAR(push.fraction, 0.5, 1e-12);
    constexpr double step = 1e-6;
    const auto energy = [&](double at) {
      Fold moved(at);
      return SelfCrossings::energy(crossing, moved.contour(), contacts);
    };
    EXPECT_NEAR(push.force[1], -(energy(height + step) - energy(height - step)) / (2 * step), 1e-8);
  }
}

}  // namespace
}  // namespace clog::test_of_self_crossings
