#include "core/polygon/step/wall_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "core/polygon/step/step_input.hpp"
#include "core/polygon/step/step_memory.hpp"
#include "polygon/forces/reference_forces.hpp"
#include "support.hpp"

namespace clog {
namespace {

using namespace test;

TEST(WallPlan, PushesAsPlainLoopsDoWhicheverEdgesCirclesShare) {
  // Plain loops compute the force on a droplet with circles around it, and without the circles. The
  // difference is the expected force.
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> part(0, 1);
  for (const int n : {16, 24, 30, 101, 256}) {
    const RunParameters run = bare_parameters(n);
    const double edge = units::regular_edge_length(n);
    const DropletState state = state_of(shaken(regular_polygon(n, units::rest_area), 0.1 * edge));
    const kernel::StepKernel kernel = kernel::step_kernel(kick_terms(run, 0));
    WallPlan plan(n);
    StepMemory memory(n);
    const kernel::StepArrays& a = memory.arrays();
    memory.load(state.position, a.position);
    const ObstacleArray nothing = no_obstacles();
    ReferenceForces alone(run, nothing);
    Eigen::ArrayXd force(2 * n), others(2 * n), pushes(2 * n);
    alone.update_contacts(state, {});
    alone.evaluate(state, others);
    for (const int num_circles : {6, 1, 20, 0, 3}) {
      std::vector<Obstacle> circles;
      for (int k = 0; k < num_circles; ++k) {
        const double radius = (0.5 + 10 * part(engine)) * edge, angle = 2 * std::numbers::pi * part(engine);
        const double far = 0.5 + radius + *run.dp.contact_range - 0.5 * edge * part(engine);
        circles.push_back({far * std::cos(angle), far * std::sin(angle), radius});
      }
      const ObstacleArray walls(20, std::move(circles));
      ReferenceForces forces(run, walls);
      forces.update_contacts(state, {});
      forces.evaluate(state, force);
      plan.make(forces.walls().items());
      kernel.clear_pushes(n, a);
      kernel.push(n, plan.windows(), nullptr, 0, contact_as_kick(run, forces, 1), a);
      memory.store(a.push, pushes);
      EXPECT_EQ((pushes != 0).any(), num_circles > 0) << n;
      EXPECT_LT((pushes - (force - others)).abs().maxCoeff(), 1e-10)
          << n << ", " << num_circles << " circles";
    }
  }
}

}  // namespace
}  // namespace clog
