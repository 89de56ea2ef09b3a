#include "clog/core/polygon/clog_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "clog/core/droplet/shape.hpp"

namespace clog {
namespace {

struct Polygon {
  const Eigen::ArrayXd& position;

  Eigen::Index size() const { return position.size() / 2; }
  Eigen::Index next(Eigen::Index i) const { return i + 1 < size() ? i + 1 : 0; }
  Eigen::Array2d vertex(Eigen::Index i) const { return {position[i], position[size() + i]}; }

  /// Calls visit(coordinate) for every place where the contour crosses the line on which coordinate `axis` is
  /// `value`, with the place's other coordinate.
  template <class Visit>
  void visit_crossings(int axis, double value, Visit visit) const {
    for (Eigen::Index i = 0; i < size(); ++i) {
      const Eigen::Array2d a = vertex(i), b = vertex(next(i));
      if ((a[axis] > value) == (b[axis] > value)) continue;
      visit(a[1 - axis] + (value - a[axis]) / (b[axis] - a[axis]) * (b[1 - axis] - a[1 - axis]));
    }
  }
};

/// An obstacle: a circle, or several that are one post.
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

/// Does the droplet hang over a post? Its interface covers the upstream side, not farther off than the radius
/// there, and reaches beyond the post on both sides.
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

/// A touched post. The support is the force that the overlaps of all edges exert on the droplet against
/// the flow, over the contact's stiffness [sigma].
struct Touched {
  double support = 0;
  bool is_wrapped = false;
  double longest_link = 0;  ///< that touches it, over the radius at which it lies
};

/// Which post each edge touches, the one that it overlaps most; -1 for none.
struct Contacts {
  std::vector<Touched> posts;
  std::vector<int> of_edge;
};

Contacts find_contacts(const Polygon& polygon, std::span<const Obstacle> obstacles, double contact_range) {
  Contacts contacts{{}, std::vector<int>(static_cast<std::size_t>(polygon.size()), -1)};
  std::vector<double> deepest(contacts.of_edge.size(), 0);
  for (const Post& post : posts_of(obstacles)) {
    Touched touched;
    bool is_touched = false;
    for (const Obstacle& circle : post.circles) {
      const Eigen::Array2d centre{circle.x, circle.y};
      for (Eigen::Index i = 0; i < polygon.size(); ++i) {
        const Eigen::Array2d away =
            nearest_on_segment(centre, polygon.vertex(i), polygon.vertex(polygon.next(i))) - centre;
        const double distance = away.matrix().norm();
        const double overlap = contact_range + circle.radius - distance;
        if (overlap <= 0) continue;
        is_touched = true;
        touched.support -= overlap * away[0] / distance;
        const double length = (polygon.vertex(polygon.next(i)) - polygon.vertex(i)).matrix().norm();
        touched.longest_link = std::max(touched.longest_link, length / (contact_range + circle.radius));
        if (overlap <= deepest[i]) continue;
        deepest[i] = overlap;
        contacts.of_edge[i] = static_cast<int>(contacts.posts.size());
      }
    }
    if (!is_touched) continue;
    touched.is_wrapped = hangs_over(polygon, post);
    contacts.posts.push_back(touched);
  }
  return contacts;
}

/// A run of successive edges that touch the same post, counter-clockwise.
struct Arc {
  int post;
  Eigen::Index first_edge, last_edge;
};

std::vector<Arc> find_arcs(const Polygon& polygon, const std::vector<int>& of_edge) {
  std::vector<Arc> arcs;
  for (Eigen::Index i = 0; i < polygon.size(); ++i) {
    const Eigen::Index before = i > 0 ? i - 1 : polygon.size() - 1;
    if (of_edge[i] < 0 || of_edge[before] == of_edge[i]) continue;
    Eigen::Index last = i;
    while (of_edge[polygon.next(last)] == of_edge[i]) last = polygon.next(last);
    arcs.push_back({of_edge[i], i, last});
  }
  return arcs;
}

}  // namespace

ClogGeometry clog_geometry(const Eigen::ArrayXd& position, std::span<const Obstacle> obstacles,
                           double contact_range, int links_per_edge) {
  const Polygon polygon{position};
  const Contacts contacts = find_contacts(polygon, obstacles, contact_range);
  ClogGeometry geometry;
  double support = 0, wrapped_support = 0, mesh_hold = 0;
  for (const Touched& touched : contacts.posts) {
    support += std::max(0.0, touched.support);
    if (!touched.is_wrapped) continue;
    ++geometry.num_wrapped;
    wrapped_support += std::max(0.0, touched.support);
    const double edge = links_per_edge * touched.longest_link;
    mesh_hold += std::max(0.0, touched.support) * edge * edge / 16;
  }
  if (support > 0) geometry.wrapped_support = wrapped_support / support;
  if (support > 0) geometry.mesh_hold = mesh_hold / support;

  const std::vector<Arc> arcs = find_arcs(polygon, contacts.of_edge);
  geometry.num_arcs = static_cast<int>(arcs.size());
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const Arc& from = arcs[i];
    const Arc& to = arcs[(i + 1) % arcs.size()];
    if (from.post == to.post) continue;
    // One side may push across the flow only, or a little downstream, and is a side of the gap all the same.
    if (std::max(contacts.posts[from.post].support, contacts.posts[to.post].support) <= 0) continue;
    // The outward normal of a counter-clockwise contour points downstream where y grows.
    const double begin_y = polygon.vertex(polygon.next(from.last_edge))[1];
    const double end_y = polygon.vertex(to.first_edge)[1];
    geometry.num_gaps += end_y > begin_y;
  }
  return geometry;
}

ClogGeometry clog_geometry(const DropletState& state, const ObstacleArray& array, const DpParameters& dp) {
  const double contact_range = dp.contact_range.value();
  const bool meets_edges = dp.wall_contact == WallContact::edge;
  const Eigen::ArrayXd interface = meets_edges ? refined(state.position) : state.position;
  const Eigen::Index n = interface.size() / 2;
  std::vector<Obstacle> obstacles;
  array.gather({state.frame.origin[0], state.frame.origin[1], interface.head(n).minCoeff(),
                interface.head(n).maxCoeff(), interface.tail(n).minCoeff(), interface.tail(n).maxCoeff(),
                contact_range},
               obstacles);
  return clog_geometry(interface, obstacles, contact_range, meets_edges ? 2 : 1);
}

}  // namespace clog
