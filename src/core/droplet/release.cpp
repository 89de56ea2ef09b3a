#include "clog/core/droplet/release.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/portable_math.hpp"
#include "clog/core/tools/units.hpp"

namespace clog {

namespace {

/// Climbs to a local maximum of clearance().
Eigen::Array2d climb(const ObstacleArray& obstacles, Eigen::Array2d place) {
  constexpr double round_off = 1e-12;  // sigma
  const double enough = 2 * units::droplet_diameter;
  double room = clearance(obstacles, place[0], place[1], enough);
  for (double step = 0.1; step > 1e-4 && room < enough;) {
    bool climbed = false;
    for (int direction = 0; direction < 8; ++direction) {
      const double angle = direction * std::numbers::pi / 4;
      const Eigen::Array2d trial = place + step * Eigen::Array2d(portable::cos(angle), portable::sin(angle));
      const double trial_room = clearance(obstacles, trial[0], trial[1], enough);
      if (trial_room > room + round_off) {  // otherwise round-off might keep the loop going along a wall
        room = trial_room;
        place = trial;
        climbed = true;
        break;
      }
    }
    if (!climbed) step /= 2;
  }
  return place;
}

}  // namespace

Eigen::Array2d nearest_void(const ObstacleArray& obstacles) {
  const Period& period = obstacles.period();
  const Eigen::Array2d centre{period.along() / 2, period.across() / 2};
  Eigen::Array2d place = climb(obstacles, centre);
  // If the place is within a post, the search tries places on circles around the centre.
  constexpr double apart = 0.25;  // sigma
  for (int ring = 1; obstacles.is_within_post(place); ++ring) {
    if (ring * apart > std::max(period.along(), period.across()))
      refuse_release("every void is within a post, a closed row of circles", "open rows of circles");
    for (int k = 0; k < 8 * ring; ++k) {
      const double angle = k * std::numbers::pi / (4 * ring);
      const Eigen::Array2d trial =
          centre + ring * apart * Eigen::Array2d(portable::cos(angle), portable::sin(angle));
      if (clearance(obstacles, trial[0], trial[1], apart) <= 0 || obstacles.is_within_post(trial)) continue;
      place = climb(obstacles, trial);
      break;
    }
  }
  return place;
}

double clearance(const ObstacleArray& obstacles, double x, double y, double limit) {
  std::vector<Obstacle> near;
  obstacles.gather({x, y, 0, 0, 0, 0, limit}, near);
  double nearest = limit;
  for (const Obstacle& obstacle : near)
    nearest = std::min(nearest, std::hypot(obstacle.x, obstacle.y) - obstacle.radius);
  for (const Wedge& wedge : obstacles.wedges())
    nearest = std::min(nearest, distance_to(wedge, Eigen::Array2d(x, y) - wedge.centre()).distance);
  return nearest;
}

int num_enclosed(const DropletState& state, const ObstacleArray& obstacles) {
  std::vector<Obstacle> near;
  const auto x = state.x();
  const auto y = state.y();
  obstacles.gather({state.frame.origin[0], state.frame.origin[1], x.minCoeff(), x.maxCoeff(), y.minCoeff(),
                    y.maxCoeff(), 0},
                   near);
  return static_cast<int>(std::count_if(near.begin(), near.end(), [&](const Obstacle& obstacle) {
    return encloses(state.position, obstacle.x, obstacle.y);
  }));
}

DropletState state_at_rest(const Eigen::ArrayXd& droplet, const Eigen::Array2d& place,
                           const Eigen::Array2d& period) {
  assert((period > 0).all());
  DropletState state;
  state.frame.period = period;
  state.frame.shift(place.floor());
  state.position = droplet;
  state.velocity = Eigen::ArrayXd::Zero(droplet.size());
  const Eigen::Array2d local = place - state.frame.global({0, 0});
  state.x() += local[0];
  state.y() += local[1];
  return state;
}

void refuse_release(const std::string& reason, const std::string& remedy) {
  throw Error("cannot release the droplet (" + reason + ") try " + remedy + ", or another seed");
}

}  // namespace clog
