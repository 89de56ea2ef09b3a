#include "clog/core/polygon/clog_geometry.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/polygon/contact/wall_contacts.hpp"

namespace clog {
namespace {

struct Polygon {
  const Eigen::ArrayXd& position;

  Eigen::Index size() const { return position.size() / 2; }
  Eigen::Index next(Eigen::Index i) const { return i + 1 < size() ? i + 1 : 0; }
  Eigen::Array2d vertex(Eigen::Index i) const { return {position[i], position[size() + i]}; }
  double length(Eigen::Index edge) const { return (vertex(next(edge)) - vertex(edge)).matrix().norm(); }

  /// Calls visit() for every place where the contour crosses the line on which coordinate `axis` equals
  /// `value`. The argument is the other coordinate.
  template <class Visit>
  void visit_crossings(int axis, double value, Visit visit) const {
    for (Eigen::Index i = 0; i < size(); ++i) {
      const Eigen::Array2d a = vertex(i), b = vertex(next(i));
      if ((a[axis] > value) == (b[axis] > value)) continue;
      visit(a[1 - axis] + (value - a[axis]) / (b[axis] - a[axis]) * (b[1 - axis] - a[1 - axis]));
    }
  }
};

/// An obstacle: a circle, or the circles of a post.
struct Post {
  std::vector<Obstacle> circles;

  const Obstacle& most_upstream() const {
    return *std::ranges::min_element(circles, {}, [](const Obstacle& c) { return c.x - c.radius; });
  }
  const Obstacle& most_downstream() const {
    return *std::ranges::max_element(circles, {}, [](const Obstacle& c) { return c.x + c.radius; });
  }
};

std::vector<Post> posts_of(std::span<const Obstacle> circles) {
  const std::vector<int> post_of = posts_among(circles);
  std::vector<Post> posts;
  for (std::size_t k = 0; k < circles.size(); ++k) {
    posts.resize(std::max(posts.size(), static_cast<std::size_t>(post_of[k]) + 1));
    posts[post_of[k]].circles.push_back(circles[k]);
  }
  return posts;
}

/// Whether the droplet hangs over a post. This is the case if the interface covers the post's upstream side
/// at a distance of at most one radius, and extends beyond the post on both sides.
bool hangs_over(const Polygon& polygon, const Post& post) {
  const Obstacle& upstream = post.most_upstream();
  bool covers = false;
  polygon.visit_crossings(1, upstream.y, [&](double x) {
    covers = covers || (x < upstream.x && upstream.x - x < 2 * upstream.radius);
  });
  if (!covers) return false;
  const Obstacle& downstream = post.most_downstream();
  bool left = false, right = false;
  polygon.visit_crossings(0, downstream.x + downstream.radius, [&](double y) {
    left = left || y < downstream.y;
    right = right || y > downstream.y;
  });
  return left && right;
}

/// A touched obstacle, either a post or a wall. The support is the sum of its forces on the droplet against
/// the flow, divided by the contact's stiffness [sigma].
struct Touched {
  double support = 0;
  bool is_wrapped = false;
  std::vector<Obstacle> circles;  ///< the circles of a post
  std::optional<Wedge> wall;
  double longest_link = 0;  ///< longest touching edge divided by its distance from the centre; 0 for walls
};

/// Smallest share of the support for which a wrapped obstacle counts as a carrier.
constexpr double least_share = 0.1;

/// Finds the obstacle that each edge overlaps most (-1: none), and all touched obstacles.
class Contacts {
 public:
  Contacts(const Polygon& polygon, double range)
      : range_(range), of_edge_(static_cast<std::size_t>(polygon.size()), -1), deepest_(of_edge_.size(), 0) {}

  void add_post(const Polygon& polygon, const Post& post, std::span<const Surroundings::Layer> layers) {
    Touched touched{.circles = post.circles, .wall = {}};
    bool is_touched = false;
    const auto add_link = [&](Eigen::Index edge, const Obstacle& circle) {
      touched.longest_link = std::max(touched.longest_link, polygon.length(edge) / (range_ + circle.radius));
    };
    for (const Obstacle& circle : post.circles) {
      for (Eigen::Index i = 0; i < polygon.size(); ++i) {
        const auto [overlap, push] = overlap_with(polygon, circle, i);
        if (!take(i, overlap, push, touched)) continue;
        is_touched = true;
        add_link(i, circle);
      }
    }
    if (!is_touched) return;
    for (const Surroundings::Layer& layer : layers) {
      if (std::ranges::none_of(post.circles,
                               [&](const Obstacle& circle) { return share_centre(circle, layer.circle); }))
        continue;
      const auto [overlap, push] = overlap_with(polygon, layer.circle, layer.edge);
      if (overlap <= 0) continue;
      touched.support -= push;
      add_link(layer.edge, layer.circle);
    }
    touched.is_wrapped = hangs_over(polygon, post);
    touched_.push_back(touched);
  }

  void add_wall(const Polygon& polygon, const Wedge& wall) {
    Touched touched{.circles = {}, .wall = wall};
    bool is_touched = false;
    for (Eigen::Index i = 0; i < polygon.size(); ++i) {
      const Eigen::Array2d begin = polygon.vertex(i), end = polygon.vertex(polygon.next(i));
      // The point of the edge closest to a flank is an end of the edge. The point closest to the tip may be
      // between the ends.
      const auto distance = [&](const Eigen::Array2d& place) {
        return distance_to(wall, place - wall.centre());
      };
      const WedgeDistance nearest =
          std::min({distance(begin), distance(end), distance(nearest_on_segment(wall.centre(), begin, end))},
                   [](const WedgeDistance& a, const WedgeDistance& b) { return a.distance < b.distance; });
      const double overlap = range_ - nearest.distance;
      // round-off in the normal of a wall along the flow; a wall along the flow supports nothing
      constexpr double round_off = 1e-12;
      const double upstream = std::abs(nearest.normal[0]) < round_off ? 0 : nearest.normal[0];
      is_touched |= take(i, overlap, overlap * upstream, touched);
    }
    if (is_touched) touched_.push_back(touched);
  }

  const std::vector<Touched>& touched() const { return touched_; }
  const std::vector<int>& of_edge() const { return of_edge_; }

 private:
  double range_;
  std::vector<Touched> touched_;
  std::vector<int> of_edge_;
  std::vector<double> deepest_;

  /// The overlap of an edge with a circle, and the component of the overlap along the flow [sigma].
  struct Overlap {
    double size, along;
  };
  Overlap overlap_with(const Polygon& polygon, const Obstacle& circle, Eigen::Index edge) const {
    const Eigen::Array2d centre{circle.x, circle.y};
    const Eigen::Array2d away =
        nearest_on_segment(centre, polygon.vertex(edge), polygon.vertex(polygon.next(edge))) - centre;
    const double distance = away.matrix().norm(), size = range_ + circle.radius - distance;
    return {size, size * away[0] / distance};
  }

  /// Whether the edge touches `obstacle`, the next entry of touched_. If so, adds the edge's force along the
  /// flow to this entry.
  bool take(Eigen::Index edge, double overlap, double push, Touched& obstacle) {
    if (overlap <= 0) return false;
    obstacle.support -= push;
    if (overlap > deepest_[edge]) {
      deepest_[edge] = overlap;
      of_edge_[edge] = static_cast<int>(touched_.size());
    }
    return true;
  }
};

/// Whether one of two obstacles is a wall and the other a post that overlaps this wall. There is then no gap
/// between them.
bool overlap(const Touched& one, const Touched& other) {
  if (!one.wall) return other.wall && overlap(other, one);
  return std::ranges::any_of(other.circles, [&](const Obstacle& circle) {
    const Eigen::Array2d from_centre = Eigen::Array2d(circle.x, circle.y) - one.wall->centre();
    return distance_to(*one.wall, from_centre).distance < circle.radius;
  });
}

/// A chain of edges, counter-clockwise, that touch the same obstacle. Edges between two circles of one post
/// also belong to the chain.
struct Arc {
  int obstacle;
  Eigen::Index first_edge, last_edge;
};

std::vector<Arc> find_arcs(const Polygon& polygon, const Contacts& contacts) {
  const std::vector<int>& of_edge = contacts.of_edge();
  std::vector<Arc> arcs;
  for (Eigen::Index i = 0; i < polygon.size(); ++i) {
    const Eigen::Index before = i > 0 ? i - 1 : polygon.size() - 1;
    if (of_edge[i] < 0 || of_edge[before] == of_edge[i]) continue;
    Eigen::Index last = i;
    while (of_edge[polygon.next(last)] == of_edge[i]) last = polygon.next(last);
    arcs.push_back({of_edge[i], i, last});
  }
  const auto are_one = [&](const Arc& from, const Arc& to) {
    return from.obstacle == to.obstacle && contacts.touched()[from.obstacle].circles.size() > 1;
  };
  std::vector<Arc> joined;
  for (const Arc& arc : arcs) {
    if (!joined.empty() && are_one(joined.back(), arc))
      joined.back().last_edge = arc.last_edge;
    else
      joined.push_back(arc);
  }
  if (joined.size() > 1 && are_one(joined.back(), joined.front())) {
    joined.front().first_edge = joined.back().first_edge;
    joined.pop_back();
  }
  return joined;
}

}  // namespace

ClogGeometry clog_geometry(const Eigen::ArrayXd& position, const Surroundings& around, double contact_range,
                           int links_per_edge) {
  const Polygon polygon{position};
  Contacts contacts(polygon, contact_range);
  for (const Post& post : posts_of(around.circles)) contacts.add_post(polygon, post, around.layers);
  for (const Wedge& wall : around.walls) contacts.add_wall(polygon, wall);

  ClogGeometry geometry;
  double support = 0, wrapped_support = 0, mesh_hold = 0;
  for (const Touched& touched : contacts.touched()) {
    support += std::max(0.0, touched.support);
    if (!touched.is_wrapped) continue;
    ++geometry.num_wrapped;
    wrapped_support += std::max(0.0, touched.support);
    const double edge = links_per_edge * touched.longest_link;
    mesh_hold += std::max(0.0, touched.support) * edge * edge / 16;
  }
  if (support > 0) geometry.wrapped_support = wrapped_support / support;
  if (support > 0) geometry.mesh_hold = mesh_hold / support;
  for (const Touched& touched : contacts.touched())
    if (touched.is_wrapped && touched.support > 0 && touched.support >= least_share * support)
      geometry.carriers.insert(geometry.carriers.end(), touched.circles.begin(), touched.circles.end());

  const std::vector<Arc> arcs = find_arcs(polygon, contacts);
  geometry.num_arcs = static_cast<int>(arcs.size());
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const Arc& from = arcs[i];
    const Arc& to = arcs[(i + 1) % arcs.size()];
    if (from.obstacle == to.obstacle) continue;
    if (overlap(contacts.touched()[from.obstacle], contacts.touched()[to.obstacle])) continue;
    // One of the two obstacles must support the droplet. The other counts as a side of the gap even if it
    // pushes the droplet across the flow or a little downstream.
    const std::vector<Touched>& touched = contacts.touched();
    if (std::max(touched[from.obstacle].support, touched[to.obstacle].support) <= 0) continue;
    // The outward normal of a counter-clockwise contour points downstream where y grows.
    const double begin_y = polygon.vertex(polygon.next(from.last_edge))[1];
    const double end_y = polygon.vertex(to.first_edge)[1];
    geometry.num_gaps += end_y > begin_y;
  }
  return geometry;
}

namespace {

/// The edges of the refined interface in upper layers.
std::vector<Surroundings::Layer> layers_on(const ObstacleArray& array, const DropletState& state,
                                           const DpParameters& dp) {
  const double range = dp.contact_range.value();
  WallContacts contacts(array, range, WallContacts::Keep::touched_by_edge, film_thickness(dp));
  contacts.update(state, {});
  std::vector<Surroundings::Layer> layers;
  for (const WallContacts::Item& item : contacts.items())
    for (unsigned edges = item.layer > 0 ? item.edges : 0; edges != 0; edges &= edges - 1) {
      const Eigen::Index edge = item.group * WallContacts::edges_per_group + std::countr_zero(edges);
      for (const Eigen::Index half : {2 * edge, 2 * edge + 1})
        layers.push_back({half, {item.x, item.y, item.reach - range}});
    }
  return layers;
}

}  // namespace

ClogGeometry clog_geometry(const DropletState& state, const ObstacleArray& array, const DpParameters& dp) {
  const double contact_range = dp.contact_range.value();
  const bool meets_edges = dp.wall_contact == WallContact::edge;
  const Eigen::ArrayXd interface = meets_edges ? refined(state.position) : state.position;
  const Eigen::Index n = interface.size() / 2;
  Surroundings around;
  array.gather({state.frame.origin[0], state.frame.origin[1], interface.head(n).minCoeff(),
                interface.head(n).maxCoeff(), interface.tail(n).minCoeff(), interface.tail(n).maxCoeff(),
                contact_range},
               around.circles);
  around.walls = array.wedges();
  for (Wedge& wall : around.walls) wall.tip -= state.frame.global({0, 0});
  if (film_thickness(dp) > 0) around.layers = layers_on(array, state, dp);
  return clog_geometry(interface, around, contact_range, meets_edges ? 2 : 1);
}

}  // namespace clog
