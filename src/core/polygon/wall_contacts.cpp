#include "clog/core/polygon/wall_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "clog/core/droplet/shape.hpp"

namespace clog {
namespace {

// A droplet moves 0.05 sigma in about 1000 steps: renewals are then too rare to cost anything. A list of
// possible nearest obstacles grows with the skin, so it gets a thinner one.
constexpr double touching_skin = 0.05;
constexpr double nearest_skin = 0.02;

}  // namespace

WallContacts::WallContacts(const ObstacleArray& array, double range, Keep keep)
    : array_(&array), range_(range), keep_(keep) {}

void WallContacts::update(const DropletState& state, const Travel& travel) {
  if (reference_.size() == state.position.size()) {
    const Eigen::Index n = state.size();
    const Eigen::ArrayXd moved = state.position - reference_;
    const double farthest2 = (moved.head(n).square() + moved.tail(n).square()).maxCoeff();
    const double sway = keep_ == Keep::touched_by_edge ? refined_sway : 1;
    if (sway * (std::sqrt(farthest2) + travel.absolute) < skin_) return;
  }
  // A fast droplet needs more than the usual skin even to reach the next update.
  const double usual_skin = keep_ == Keep::nearest_to_vertex ? nearest_skin : touching_skin;
  rebuild(state, std::clamp(2 * refined_sway * travel.absolute, usual_skin, widest_skin));
}

void WallContacts::gather_nearby(const DropletState& state) {
  const auto x = state.x();
  const auto y = state.y();
  // Middles of edges stick out of the vertices' bounds by an eighth of an edge at most.
  double longest2 = 0;
  for (Eigen::Index i = 0, j = x.size() - 1; i < x.size(); j = i++)
    longest2 = std::max(longest2, (x[i] - x[j]) * (x[i] - x[j]) + (y[i] - y[j]) * (y[i] - y[j]));
  ObstacleArray::Window window{state.frame.origin[0],
                               state.frame.origin[1],
                               x.minCoeff(),
                               x.maxCoeff(),
                               y.minCoeff(),
                               y.maxCoeff(),
                               range_ + skin_ + std::sqrt(longest2) / 8};
  nearby_.clear();
  array_->gather(window, nearby_);
  // A wedge's flanks touch vertices first, but its tip can come between two of them.
  if (keep_ == Keep::touched_by_edge)
    for (const Wedge& wedge : array_->wedges())
      if (!wedge.is_flat()) {
        const Eigen::Array2d centre =
            wedge.centre() - state.frame.origin - state.frame.image.cast<double>() * state.frame.period;
        nearby_.push_back({centre[0], centre[1], wedge.radius});
      }
  if (keep_ != Keep::nearest_to_vertex) return;
  // The nearest obstacle may be far away in a sparse array: look as far as a period (a periodic array holds
  // at least one obstacle there, if it holds any).
  for (window.margin = 0.5; window.margin < 2 * array_->period().along(); window.margin *= 2) {
    nearby_.clear();
    array_->gather(window, nearby_);
    double worst = 0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Obstacle& obstacle : nearby_)
        nearest = std::min(nearest, std::hypot(x[i] - obstacle.x, y[i] - obstacle.y) - obstacle.radius);
      worst = std::max(worst, nearest);
    }
    if (worst + 2 * skin_ <= window.margin || array_->obstacles().empty()) return;
  }
}

void WallContacts::rebuild(const DropletState& state, double skin) {
  skin_ = skin;
  reference_ = state.position;
  num_points_ = state.size();
  num_slots_ = 0;
  items_.clear();
  if (!reference_.allFinite()) return;  // a droplet that has diverged; the run will see it at its next check
  gather_nearby(state);
  const Eigen::ArrayXd fine = refined(state.position);
  const auto half = [&](Eigen::Index i) {
    return Eigen::Array2d(fine[i % (2 * num_points_)], fine[2 * num_points_ + i % (2 * num_points_)]);
  };
  const auto distance_from = [&](const Obstacle& obstacle, Eigen::Index i) {
    const Eigen::Array2d centre{obstacle.x, obstacle.y};
    if (keep_ != Keep::touched_by_edge) return (centre - half(2 * i)).matrix().norm() - obstacle.radius;
    return std::min(distance_to_segment(centre, half(2 * i), half(2 * i + 1)),
                    distance_to_segment(centre, half(2 * i + 1), half(2 * i + 2))) -
           obstacle.radius;
  };
  candidates_.resize(num_points_);
  std::vector<double> distance(nearby_.size());
  for (Eigen::Index i = 0; i < num_points_; ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < nearby_.size(); ++k) {
      distance[k] = distance_from(nearby_[k], i);
      nearest = std::min(nearest, distance[k]);
    }
    // An obstacle is in contact later only if it is within range + skin now; it is the nearest later only if
    // it is within 2 skins of the nearest now.
    const double reach = keep_ == Keep::nearest_to_vertex ? nearest + 2 * skin_ : range_ + skin_;
    candidates_[i].clear();
    for (std::size_t k = 0; k < nearby_.size(); ++k)
      if (distance[k] <= reach) candidates_[i].push_back(static_cast<int>(k));
    num_slots_ = std::max(num_slots_, static_cast<int>(candidates_[i].size()));
  }

  fill_slots();
  fill_items();
  const auto [smallest, largest] =
      std::minmax_element(nearby_.begin(), nearby_.end(),
                          [](const Obstacle& a, const Obstacle& b) { return a.radius < b.radius; });
  smallest_radius_ = nearby_.empty() ? 0 : smallest->radius;
  largest_radius_ = nearby_.empty() ? 0 : largest->radius;
}

void WallContacts::fill_slots() {
  // Out of reach, yet finite: distances to it stay ordinary numbers.
  constexpr double nowhere = 1e8;
  // Whole vectors may be read at the end.
  slots_.setZero(Eigen::Index{3} * num_slots_ * num_points_ + edges_per_group);
  for (int s = 0; s < num_slots_; ++s)
    for (Eigen::Index i = 0; i < num_points_; ++i) {
      const bool used = s < static_cast<int>(candidates_[i].size());
      const Obstacle obstacle = used ? nearby_[candidates_[i][s]] : Obstacle{nowhere, nowhere, 0};
      slots_[(3 * s + 0) * num_points_ + i] = obstacle.x;
      slots_[(3 * s + 1) * num_points_ + i] = obstacle.y;
      slots_[(3 * s + 2) * num_points_ + i] = obstacle.radius;
    }
}

void WallContacts::fill_items() {
  items_.clear();
  constexpr std::size_t none = -1;
  std::vector<std::size_t> item_of(nearby_.size(), none);  // the latest of each circle
  for (Eigen::Index i = 0; i < num_points_; ++i) {
    const int group = static_cast<int>(i) / edges_per_group;
    for (const int k : candidates_[i]) {
      if (item_of[k] == none || items_[item_of[k]].group != group) {
        item_of[k] = items_.size();
        items_.push_back({nearby_[k].x, nearby_[k].y, nearby_[k].radius + range_, group, 0});
      }
      items_[item_of[k]].edges |= static_cast<std::uint8_t>(1u << (i % edges_per_group));
    }
  }
}

}  // namespace clog
