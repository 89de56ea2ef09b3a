#include "clog/core/run/contact_record.hpp"

#include <algorithm>
#include <cmath>

#include "clog/core/tools/error.hpp"

namespace clog {
namespace {

/// Positions of one obstacle in two frames differ by less than this, because of round-off [sigma].
constexpr double same_place = 1e-6;
/// Additional distance up to which obstacles are listed, so that lists are seldom rebuilt [sigma].
constexpr double skin = 0.25;

/// Distance from a point to the segment from `begin` to `end` [sigma].
double distance_to_edge(const Eigen::Array2d& point, const Eigen::Array2d& begin, const Eigen::Array2d& end) {
  const Eigen::Array2d edge = end - begin;
  const double length2 = edge.square().sum();
  const double place = length2 > 0 ? std::clamp(((point - begin) * edge).sum() / length2, 0.0, 1.0) : 0;
  return (begin + place * edge - point).matrix().norm();
}

/// Distance from a circle's centre to the closest vertex or, if edges meet walls, to the closest point of an
/// edge [sigma].
double distance_from(const Obstacle& circle, const DropletState& state, bool meets_edges) {
  const auto x = state.x();
  const auto y = state.y();
  Eigen::Index nearest = 0;
  const double distance2 = ((x - circle.x).square() + (y - circle.y).square()).minCoeff(&nearest);
  const Eigen::Index n = state.size();
  if (!meets_edges || n < 2) return std::sqrt(distance2);
  const Eigen::Array2d centre{circle.x, circle.y};
  const auto vertex = [&](Eigen::Index i) { return Eigen::Array2d(x[i % n], y[i % n]); };
  const Eigen::Array2d middle = vertex(nearest);
  return std::min(distance_to_edge(centre, vertex(nearest + n - 1), middle),
                  distance_to_edge(centre, middle, vertex(nearest + 1)));
}

/// Distance of a wedge from the closest of the droplet's moving points [sigma].
double gap_to(const Wedge& wedge, const DropletState& state) {
  double gap = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    const Eigen::Array2d place = state.frame.global({state.x()[i], state.y()[i]});
    gap = std::min(gap, distance_to(wedge, place - wedge.centre()).distance);
  }
  return gap;
}

}  // namespace

void ContactRecord::add(const DropletState& state, const ObstacleArray& obstacles,
                        const Eigen::Array2d& release, double distance) {
  const Eigen::Array2d lower{state.x().minCoeff(), state.y().minCoeff()};
  const Eigen::Array2d upper{state.x().maxCoeff(), state.y().maxCoeff()};
  const bool is_listed =
      (origin_ == state.frame.origin).all() && (lower >= lower_).all() && (upper <= upper_).all();
  if (!is_listed) look_around(state, obstacles, lower, upper);
  const double far = reach_.range + parting;
  seen_.assign(num_posts_, {});
  for (std::size_t k = 0; k < near_.size(); ++k) {
    const Obstacle& circle = near_[k];
    const Eigen::Array2d centre{circle.x, circle.y};
    const bool is_far =
        (centre + circle.radius + far < lower).any() || (centre - circle.radius - far > upper).any();
    const double gap = is_far ? far : distance_from(circle, state, reach_.by_edges) - circle.radius;
    include(seen_[post_of_[k]], {release[0] + circle.x, release[1] + circle.y}, gap);
  }
  for (const Wedge& wedge : obstacles.wedges()) {
    const Eigen::Array2d place = release + wedge.tip - state.frame.global({0, 0});
    include(seen_.emplace_back(), {place[0], place[1]}, gap_to(wedge, state));
  }
  for (const Seen& obstacle : seen_) count(obstacle, distance);
}

void ContactRecord::look_around(const DropletState& state, const ObstacleArray& obstacles,
                                const Eigen::Array2d& lower, const Eigen::Array2d& upper) {
  origin_ = state.frame.origin;
  lower_ = lower - skin;
  upper_ = upper + skin;
  near_.clear();
  // The list also contains obstacles just out of reach, so that the loop below detects which obstacles the
  // droplet has left.
  obstacles.gather(
      {origin_[0], origin_[1], lower_[0], upper_[0], lower_[1], upper_[1], reach_.range + parting + 2 * skin},
      near_);
  post_of_ = posts_among(near_);
  num_posts_ = near_.empty() ? 0 : static_cast<std::size_t>(std::ranges::max(post_of_)) + 1;
}

void ContactRecord::include(Seen& obstacle, const Place& place, double gap) {
  if (gap < obstacle.gap) {
    obstacle.gap = gap;
    obstacle.nearest = place;
  }
  const auto num_left = std::erase_if(met_, [&](const Place& one) {
    return std::abs(one.x - place.x) < same_place && std::abs(one.y - place.y) < same_place;
  });
  obstacle.is_met |= num_left > 0;
}

void ContactRecord::count(const Seen& obstacle, double distance) {
  if (obstacle.gap >= reach_.range + (obstacle.is_met ? parting : 0)) return;
  met_.push_back(obstacle.nearest);
  if (!obstacle.is_met && ++contacts_.number == 1) contacts_.first_distance = distance;
}

void ContactRecord::save(ByteWriter& bytes) const {
  bytes.put(contacts_);
  bytes.put(met_);
}

void ContactRecord::restore(ByteReader& bytes) {
  bytes.get(contacts_);
  bytes.get(met_);
  const bool is_first_known = !std::isnan(contacts_.first_distance);
  if (contacts_.number < std::ssize(met_) || is_first_known != (contacts_.number > 0) ||
      std::isinf(contacts_.first_distance) || !std::ranges::all_of(met_, [](const Place& one) {
        return std::isfinite(one.x) && std::isfinite(one.y);
      }))
    throw Error("its contacts are out of range");
}

}  // namespace clog
