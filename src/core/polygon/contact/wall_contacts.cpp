#include "clog/core/polygon/contact/wall_contacts.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "clog/core/droplet/shape.hpp"

namespace clog {
namespace {

// A droplet moves 0.05 sigma in about 1000 steps, so rebuilding the lists costs almost nothing. The list of
// obstacles that may be nearest to a vertex has a thinner skin, because this list grows with the skin.
constexpr double touching_skin = 0.05;
constexpr double nearest_skin = 0.02;

/// Parts of the interface that are closer along the contour than this many films belong to the same layer. At
/// the tip of a fold, where the interface turns, there is no room for a film.
constexpr double arc_of_a_fold = 3;
/// An edge moves to a higher layer only if it is lower than that layer by at most this fraction of a film. At
/// the tip of a fold, another part of the interface may move below an edge before the edge has risen. The
/// edge then keeps its layer; otherwise the higher layer would throw it off.
constexpr double layer_tolerance = 0.25;

}  // namespace

WallContacts::WallContacts(const ObstacleArray& array, double range, Keep keep, double film)
    : array_(&array), range_(range), film_(film), keep_(keep) {
  assert(film == 0 || keep == Keep::touched_by_edge);
}

void WallContacts::update(const DropletState& state, const Travel& travel) {
  const Eigen::Index n = state.size();
  if (reference_.size() == 2 * n + edges_per_group) {
    const double farthest2 =
        ((state.x() - reference_.head(n)).square() + (state.y() - reference_.segment(n, n)).square())
            .maxCoeff();
    if (hold(std::sqrt(farthest2), travel)) return;
  }
  rebuild(state, travel);
}

bool WallContacts::hold(double moved, const Travel& travel) const {
  const double sway = keep_ == Keep::touched_by_edge ? refined_sway : 1;
  return reference_.size() > 0 && sway * (moved + travel.absolute) < skin_;
}

void WallContacts::rebuild(const DropletState& state, const Travel& travel) {
  // For a fast droplet, lists with the usual skin would not stay valid until the next update.
  const double usual_skin = keep_ == Keep::nearest_to_vertex ? nearest_skin : touching_skin;
  rebuild_with_skin(state, std::clamp(2 * refined_sway * travel.absolute, usual_skin, widest_skin));
}

void WallContacts::gather_nearby(const DropletState& state) {
  const auto x = state.x();
  const auto y = state.y();
  // The middles of edges are outside the bounds of the vertices by at most an eighth of an edge.
  double longest2 = 0;
  for (Eigen::Index i = 0, j = x.size() - 1; i < x.size(); j = i++)
    longest2 = std::max(longest2, (x[i] - x[j]) * (x[i] - x[j]) + (y[i] - y[j]) * (y[i] - y[j]));
  ObstacleArray::Window window{state.frame.origin[0],
                               state.frame.origin[1],
                               x.minCoeff(),
                               x.maxCoeff(),
                               y.minCoeff(),
                               y.maxCoeff(),
                               range_ + highest_layer * film_ + skin_ + std::sqrt(longest2) / 8};
  nearby_.clear();
  array_->gather(window, nearby_);
  // A wedge's flank touches a vertex before it touches an edge. But its tip may touch an edge between two
  // vertices, so the tip is listed as a circle.
  if (keep_ == Keep::touched_by_edge)
    for (const Wedge& wedge : array_->wedges())
      if (!wedge.is_flat()) {
        const Eigen::Array2d centre =
            wedge.centre() - state.frame.origin - state.frame.image.cast<double>() * state.frame.period;
        nearby_.push_back({centre[0], centre[1], wedge.radius});
      }
  if (keep_ != Keep::nearest_to_vertex) return;
  // In a sparse array the nearest obstacle may be far away. So the search extends to one period: within this
  // distance, a periodic array has an obstacle.
  for (window.margin = 0.5; window.margin < 2 * array_->period().along(); window.margin *= 2) {
    nearby_.clear();
    array_->gather(window, nearby_);
    measure_distances(state);
    const double worst = nearest_.maxCoeff();
    if (worst + 2 * skin_ <= window.margin || array_->obstacles().empty()) return;
  }
}

void WallContacts::rebuild_with_skin(const DropletState& state, double skin) {
  skin_ = skin;
  num_points_ = state.size();
  reference_.resize(2 * num_points_ + edges_per_group);
  reference_.head(2 * num_points_) = state.position;
  reference_.tail(edges_per_group).setZero();
  items_.clear();
  if (!reference_.allFinite()) return;  // the droplet has diverged; the run detects this at its next check
  gather_nearby(state);
  if (keep_ == Keep::touched_by_edge) {
    list_by_edge(state.position, refined(state.position));
  } else {
    list_by_vertex(state);
    fill_items();
  }
  const auto [smallest, largest] =
      std::minmax_element(nearby_.begin(), nearby_.end(),
                          [](const Obstacle& a, const Obstacle& b) { return a.radius < b.radius; });
  smallest_radius_ = nearby_.empty() ? 0 : smallest->radius;
  largest_radius_ = nearby_.empty() ? 0 : largest->radius;
}

/// Lists the edges that a circle may touch before the next rebuild. An obstacle that may get within range by
/// then is within range + skin now.
/// @param fine  the refined contour, see refined()
void WallContacts::list_by_edge(const Eigen::ArrayXd& position, const Eigen::ArrayXd& fine) {
  const int n = static_cast<int>(num_points_);
  const auto point = [&](int k) {
    const int wrapped = k < 2 * n ? k : k - 2 * n;
    return Eigen::Array2d(fine[wrapped], fine[2 * n + wrapped]);
  };
  bounds_.clear();
  for (int first = 0; first < n; first += edges_per_group) {
    Bounds bounds{point(2 * first), point(2 * first)};
    for (int k = 2 * first + 1; k <= 2 * std::min(first + edges_per_group, n); ++k) {
      bounds.least = bounds.least.min(point(k));
      bounds.most = bounds.most.max(point(k));
    }
    bounds_.push_back(bounds);
  }
  along_.assign(1, 0);
  longest_edge_ = 0;
  for (int i = 0; i < n; ++i) {
    const double length = (point(2 * i + 2) - point(2 * i)).matrix().norm();
    longest_edge_ = std::max(longest_edge_, length);
    along_.push_back(along_.back() + length);
  }
  for (const Obstacle& circle : nearby_) {
    find_layers(circle, position, fine);
    for (int layer = 0; layer <= highest_layer; ++layer)
      for (const NearbyGroup& one : nearby_groups_)
        if (one.edges[static_cast<std::size_t>(layer)] != 0)
          items_.push_back({circle.x, circle.y, circle.radius + range_ + layer * film_, one.group,
                            one.edges[static_cast<std::size_t>(layer)], static_cast<std::uint8_t>(layer)});
  }
}

/// Fills nearby_groups_.
void WallContacts::find_layers(const Obstacle& circle, const Eigen::ArrayXd& position,
                               const Eigen::ArrayXd& fine) {
  constexpr double rounding = 1e-12;
  const int n = static_cast<int>(num_points_);
  const auto refined = [&](int k) -> Eigen::Array2d { return {fine[k], fine[fine.size() / 2 + k]}; };
  const Eigen::Array2d centre{circle.x, circle.y};
  const double lowest = circle.radius + range_;  // distance of layer 0 from the centre
  const double far = (lowest + highest_layer * film_ + skin_) * (1 + rounding);
  // If the circle may touch an edge, the edge's middle is closer to the circle's centre than farthest_middle.
  // The middles of edges between that edge and the circle are closer than this, too.
  const double farthest_middle = far + longest_edge_;
  nearby_groups_.clear();
  for (int group = 0; group < static_cast<int>(bounds_.size()); ++group)
    if (bounds_[group].distance2(centre) <= farthest_middle * farthest_middle)
      nearby_groups_.push_back({.group = group});
  for (NearbyGroup& one : nearby_groups_) {
    if (bounds_[one.group].distance2(centre) > far * far) continue;
    const int first = one.group * edges_per_group;
    for (int i = first; i < std::min(first + edges_per_group, n); ++i) {
      const Eigen::Array2d begin = refined(2 * i), middle = refined(2 * i + 1),
                           end = refined(2 * ((i + 1) % n));
      const double nearest =
          std::min(distance_to_segment(centre, begin, middle), distance_to_segment(centre, middle, end));
      int layer = 0;
      if (film_ > 0 && nearest > lowest + (1 - layer_tolerance) * film_ && nearest <= far) {
        const double fit = (nearest - lowest) / film_ + layer_tolerance;
        layer =
            std::min({num_parts_below(circle, i, middle, position), static_cast<int>(fit), highest_layer});
      }
      if (nearest - lowest - layer * film_ <= skin_)
        one.edges[static_cast<std::size_t>(layer)] |= static_cast<std::uint8_t>(1u << (i - first));
    }
  }
}

/// Counts how often the contour crosses the line from the circle's centre to `place`, a point of an edge in
/// nearby_groups_.
int WallContacts::num_parts_below(const Obstacle& circle, int edge, const Eigen::Array2d& place,
                                  const Eigen::ArrayXd& position) const {
  const int n = static_cast<int>(num_points_);
  const double* const x = position.data();
  const double* const y = x + n;
  const Eigen::Array2d centre{circle.x, circle.y};
  const Bounds line{centre.min(place), centre.max(place)};
  const double way_x = place[0] - circle.x, way_y = place[1] - circle.y;
  const auto is_left = [&](int i) { return way_x * (y[i] - circle.y) - way_y * (x[i] - circle.x) > 0; };
  const auto reaches_across = [&](int begin, int end) {
    const double along_x = x[end] - x[begin], along_y = y[end] - y[begin];
    const auto is_left_of_edge = [&](double px, double py) {
      return along_x * (py - y[begin]) - along_y * (px - x[begin]) > 0;
    };
    return is_left_of_edge(circle.x, circle.y) != is_left_of_edge(place[0], place[1]);
  };
  const double middle = (along_[edge] + along_[edge + 1]) / 2;
  const auto is_far = [&](int i) {
    const double apart = std::abs((along_[i] + along_[i + 1]) / 2 - middle);
    const double own = (along_[i + 1] - along_[i] + along_[edge + 1] - along_[edge]) / 2;
    return std::min(apart, along_.back() - apart) - own > arc_of_a_fold * film_;
  };
  int crossings = 0;
  for (const NearbyGroup& one : nearby_groups_) {
    if (!bounds_[one.group].overlap(line)) continue;
    const int first = one.group * edges_per_group;
    bool before = is_left(first);
    for (int i = first; i < std::min(first + edges_per_group, n); ++i) {
      const int end = i + 1 < n ? i + 1 : 0;
      const bool after = is_left(end);
      if (std::exchange(before, after) != after && reaches_across(i, end) && is_far(i)) ++crossings;
    }
  }
  return crossings;
}

/// Measures the distance of each vertex from all circles nearby, and from the nearest circle.
void WallContacts::measure_distances(const DropletState& state) {
  const auto num_nearby = static_cast<Eigen::Index>(nearby_.size());
  distances_.resize(state.size(), num_nearby);
  nearest_.setConstant(state.size(), std::numeric_limits<double>::infinity());
  for (Eigen::Index k = 0; k < num_nearby; ++k) {
    const Obstacle& obstacle = nearby_[static_cast<std::size_t>(k)];
    distances_.col(k) =
        ((obstacle.x - state.x()).square() + (obstacle.y - state.y()).square()).sqrt() - obstacle.radius;
    nearest_ = nearest_.min(distances_.col(k));
  }
}

/// Lists the obstacles that a vertex may touch, or that may be nearest to it, before the next rebuild. An
/// obstacle may become the nearest only if it is now at most 2 skins farther away than the present nearest
/// obstacle.
void WallContacts::list_by_vertex(const DropletState& state) {
  measure_distances(state);
  candidates_.resize(num_points_);
  for (std::vector<int>& one : candidates_) one.clear();
  for (Eigen::Index k = 0; k < distances_.cols(); ++k)
    for (Eigen::Index i = 0; i < num_points_; ++i) {
      const double reach = keep_ == Keep::nearest_to_vertex ? nearest_[i] + 2 * skin_ : range_ + skin_;
      if (distances_(i, k) <= reach) candidates_[i].push_back(static_cast<int>(k));
    }
}

void WallContacts::fill_items() {
  constexpr std::size_t none = -1;
  item_of_.assign(nearby_.size(), none);
  for (Eigen::Index i = 0; i < num_points_; ++i) {
    const int group = static_cast<int>(i) / edges_per_group;
    for (const int k : candidates_[i]) {
      if (item_of_[k] == none || items_[item_of_[k]].group != group) {
        item_of_[k] = items_.size();
        items_.push_back({nearby_[k].x, nearby_[k].y, nearby_[k].radius + range_, group, 0});
      }
      items_[item_of_[k]].edges |= static_cast<std::uint8_t>(1u << (i % edges_per_group));
    }
  }
}

}  // namespace clog
