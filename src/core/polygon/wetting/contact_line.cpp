#include "clog/core/polygon/wetting/contact_line.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "clog/core/tools/portable_math.hpp"
#include "clog/core/tools/units.hpp"
#include "core/polygon/contact/wedge_place.hpp"

namespace clog {
namespace {

using Eigen::Index;
using std::numbers::pi;

double cosine(double degrees) { return portable::cos(degrees * pi / 180); }

/// The angle from one direction to another, by their cross and dot products.
double turn_between(double cross, double dot) {
  // For the small angles between adjacent vertices, the series of the arc tangent takes a tenth of the time.
  // The first omitted term is at most 0.3^29/29 = 2e-17.
  constexpr double small = 0.3;
  constexpr int last_power = 27;
  if (!(std::abs(cross) < small * dot)) return portable::atan2(cross, dot);
  const double t = cross / dot, square = t * t;
  double series = 0;
  for (int power = last_power; power >= 1; power -= 2) series = 1.0 / power - square * series;
  return t * series;
}

/// Distance along a wall from one place to another. Around a circle it is the shorter of the two distances.
double way(const WallPlace& wall, double from, double to) {
  const double turn = 2 * pi * wall.radius;
  const bool is_short = std::abs(to - from) < turn / 2;
  return wall.wedge >= 0 || is_short ? to - from : std::remainder(to - from, turn);
}

/// @param k  from -size to 2 size - 1
Index around(Index k, Index size) { return k < 0 ? k + size : k < size ? k : k - size; }

/// Distance beyond the range of contact, in vertex diameters, up to which a vertex counts as on the wall.
/// With this tolerance, a held end is not lost when its vertex hovers or bounces.
constexpr double hovering = 0.25;

}  // namespace

bool has_hysteresis(const DpParameters& dp) {
  const double young = young_angle(dp);
  return dp.receding_angle.value_or(young) < young || dp.advancing_angle.value_or(young) > young;
}

/// Position of a vertex relative to a wall.
struct ContactLine::Beside {
  Eigen::Array2d normal;   // unit vector away from the wall
  Eigen::Array2d forward;  // gradient of the coordinate u along the wall; u decreases along the contour
  double on_wedge;         // u on a wedge, measured along its surface from the axis [sigma]
};

namespace {

/// The coordinate u of a point on the surface of a wedge, see Beside.
double place_on(const Wedge& wedge, const Eigen::Array2d& from_centre) {
  const Eigen::Array2d across_axis{-wedge.axis[1], wedge.axis[0]};
  const double across = (from_centre * across_axis).sum();
  const double along = (from_centre * wedge.axis).sum();
  const double c = wedge.half_angle.cos, s = wedge.half_angle.sin;
  // The angle from the negative axis, counter-clockwise around the centre.
  if (along * c + std::abs(across) * s < 0) return wedge.radius * portable::atan2(-across, -along);
  const double on_tip = wedge.radius * (pi / 2 - wedge.half_angle.radians);
  return (across < 0 ? 1 : -1) * (on_tip + along * c + std::abs(across) * s);
}

}  // namespace

ContactLine::Beside ContactLine::beside(const WallPlace& wall, const VertexPlaces& vertices,
                                        Eigen::Index vertex) const {
  const Eigen::Array2d from_centre{vertices.x[vertex] - wall.x, vertices.y[vertex] - wall.y};
  const auto [distance, normal] = distance_to(wall, wedges_, from_centre);
  const Eigen::Array2d along{-normal[1], normal[0]};
  const double on_circle = wall.radius / (distance + wall.radius);
  if (wall.wedge < 0) return {normal, on_circle * along, 0};
  const Wedge& wedge = wedges_[static_cast<std::size_t>(wall.wedge)];
  const double on_axis = (from_centre * wedge.axis).sum();
  const double across = std::abs(from_centre[1] * wedge.axis[0] - from_centre[0] * wedge.axis[1]);
  const bool is_at_tip = on_axis * wedge.half_angle.cos + across * wedge.half_angle.sin < 0;
  return {normal, (is_at_tip ? on_circle : 1) * along, place_on(wedge, from_centre)};
}

ContactLine::Zone& ContactLine::Ends::add_zone(const WallPlace& wall) {
  if (num_zones_ == zones_.size()) zones_.emplace_back();
  Zone& zone = zones_[num_zones_++];
  zone.wall = wall;
  zone.vertices.clear();
  return zone;
}

ContactLine::ContactLine(const RunParameters& run, std::span<const Wedge> wedges)
    : is_on_(has_hysteresis(run.dp)),
      contact_range_(run.dp.contact_range.value()),
      width_(wetting_width * units::regular_edge_length(*run.dp.vertices)),
      wedges_(wedges) {
  const double young = young_angle(run.dp);
  stiffness_ = pinning_stiffness * run.dp.line_tension / units::regular_edge_length(*run.dp.vertices);
  most_outwards_ = run.dp.line_tension * (cosine(run.dp.receding_angle.value_or(young)) - cosine(young));
  most_inwards_ = run.dp.line_tension * (cosine(young) - cosine(run.dp.advancing_angle.value_or(young)));
}

void ContactLine::add_to(Zone& zone, const VertexPlaces& vertices, Index vertex) const {
  const Eigen::Array2d from_centre{vertices.x[vertex] - zone.wall.x, vertices.y[vertex] - zone.wall.y};
  const WedgeDistance at = distance_to(zone.wall, wedges_, from_centre);
  const double on_wall = width_ * hovering / wetting_width;
  const WettedShare share = wetted_share(at.distance, contact_range_ + on_wall, width_ - on_wall);
  if (share.share > 0) zone.vertices.push_back({vertex, share.share, share.slope, at.normal});
}

void ContactLine::find_ends(const VertexPlaces& vertices, const LocalFrame& frame,
                            std::span<const WallContacts::Item> circles, Ends& ends) const {
  ends.num_zones_ = 0;
  for (const WallContacts::Item& item : circles) {
    const WallPlace circle{item.x, item.y, item.reach - contact_range_ - width_};
    const auto end = ends.zones_.begin() + static_cast<std::ptrdiff_t>(ends.num_zones_);
    const auto known = std::find_if(ends.zones_.begin(), end, [&](const Zone& one) {
      return one.wall.x == circle.x && one.wall.y == circle.y;
    });
    Zone& zone = known == end ? ends.add_zone(circle) : *known;
    for (unsigned bits = item.edges; bits != 0; bits &= bits - 1) {
      const Index i = Index{item.group} * WallContacts::edges_per_group + std::countr_zero(bits);
      const Eigen::Vector2d away{vertices.x[i] - item.x, vertices.y[i] - item.y};
      if (away.squaredNorm() < item.reach * item.reach) add_to(zone, vertices, i);
    }
  }
  for (std::size_t k = 0; k < wedges_.size(); ++k) {
    const kernel::WedgePlace place = kernel::place_in(frame, wedges_[k]);
    Zone& zone = ends.add_zone({place.x, place.y, place.radius, static_cast<Index>(k)});
    for (Index i = 0; i < vertices.size; ++i) add_to(zone, vertices, i);
  }
  ends.all_.clear();
  ends.gradients_.clear();
  for (std::size_t k = 0; k < ends.num_zones_; ++k) add_ends(ends.zones_[k], vertices, ends);
}

void ContactLine::add_ends(const Zone& zone, const VertexPlaces& vertices, Ends& ends) const {
  assert(std::ranges::is_sorted(zone.vertices, {}, &Zone::Vertex::vertex));
  const Index n = vertices.size;
  const auto num = static_cast<Index>(zone.vertices.size());
  const auto vertex = [&](Index k) -> const Zone::Vertex& {
    return zone.vertices[static_cast<std::size_t>(around(k, num))];
  };
  const auto follows = [&](Index k) { return around(vertex(k).vertex + 1, n) == vertex(k + 1).vertex; };
  const auto further_on_wall = [&](const Beside& from, const Beside& to) {
    if (zone.wall.wedge >= 0) return to.on_wedge - from.on_wedge;
    return zone.wall.radius * turn_between(from.normal[0] * to.normal[1] - from.normal[1] * to.normal[0],
                                           (from.normal * to.normal).sum());
  };
  // A wetted vertex gives an end if no other wetted vertex follows in the sum over the edges outwards from
  // it.
  for (Index k = 0; k < num; ++k) {
    if (vertex(k).share < 1) continue;
    for (const Index side : {Index{0}, Index{1}}) {
      const Index step = side == 1 ? 1 : -1;
      Index last = k;  // last vertex of the arc
      const auto goes_on = [&] { return step > 0 ? follows(last) : follows(last - 1); };
      while (last - k < num && k - last < num && goes_on() && vertex(last + step).share < 1) last += step;
      if (goes_on() && vertex(last + step).share >= 1) continue;

      // u decreases along the contour, so at the last end of an arc the outward coordinate is -u.
      const double outwards = side == 1 ? -1 : 1;
      End end{zone.wall, side, 0, ends.gradients_.size(), 0};
      Beside here = beside(zone.wall, vertices, vertex(k).vertex);
      double sum = zone.wall.wedge >= 0 ? here.on_wedge
                                        : zone.wall.radius * portable::atan2(here.normal[1], here.normal[0]);
      double way_before = 0;
      Eigen::Array2d carried = here.forward;  // `forward` times the coefficient of the vertex's u in `sum`
      for (Index j = k;; j += step) {
        const bool is_last = j == last;
        const Index next = around(vertex(j).vertex + step, n);
        const Beside there = beside(zone.wall, vertices, next);
        const double share = (vertex(j).share + (is_last ? 0 : vertex(j + step).share)) / 2;
        const double further = further_on_wall(here, there);
        sum += share * further;
        ends.gradients_.push_back(
            {vertex(j).vertex, outwards * (carried - share * here.forward +
                                           vertex(j).slope * (way_before + further) / 2 * vertex(j).normal)});
        carried = share * there.forward;
        way_before = further;
        here = there;
        if (!is_last) continue;
        ends.gradients_.push_back({next, outwards * carried});
        break;
      }
      end.place = outwards * sum;
      end.num_gradients = ends.gradients_.size() - end.first_gradient;
      ends.all_.push_back(end);
    }
  }
}

const std::vector<Index>& ContactLine::matched(std::span<const WallAnchor> anchors, const Ends& ends) {
  auto& matches = ends.matches_;
  matches.clear();
  for (std::size_t e = 0; e < ends.all_.size(); ++e)
    for (std::size_t a = 0; a < anchors.size(); ++a) {
      const WallAnchor& anchor = anchors[a];
      const End& end = ends.all_[e];
      if (anchor.holder == end.side && anchor.wall.is(end.wall))
        matches.push_back({std::abs(way(end.wall, anchor.x, end.place)), e, a});
    }
  std::ranges::sort(matches, {},
                    [](const auto& match) { return std::tuple(match.way, match.end, match.anchor); });
  ends.anchor_of_.assign(ends.all_.size(), -1);
  ends.is_taken_.assign(anchors.size(), 0);
  for (const auto& [distance, e, a] : matches) {
    if (ends.anchor_of_[e] >= 0 || ends.is_taken_[a] != 0) continue;
    ends.anchor_of_[e] = static_cast<Index>(a);
    ends.is_taken_[a] = 1;
  }
  return ends.anchor_of_;
}

void ContactLine::add_forces(std::span<const WallAnchor> anchors, const Ends& ends,
                             Eigen::ArrayXd& force) const {
  const std::vector<Index>& anchor_of = matched(anchors, ends);
  for (std::size_t e = 0; e < ends.all_.size(); ++e) {
    if (anchor_of[e] < 0) continue;
    const End& end = ends.all_[e];
    const WallAnchor& anchor = anchors[static_cast<std::size_t>(anchor_of[e])];
    const double pull = -stiffness_ * anchor.slip_of_force(way(end.wall, anchor.x, end.place));
    for (const auto& [vertex, gradient] : ends.gradients(end)) {
      force[vertex] += pull * gradient[0];
      force[force.size() / 2 + vertex] += pull * gradient[1];
    }
  }
}

double ContactLine::energy(std::span<const WallAnchor> anchors, const Ends& ends) const {
  const std::vector<Index>& anchor_of = matched(anchors, ends);
  double energy = 0;
  for (std::size_t e = 0; e < ends.all_.size(); ++e) {
    if (anchor_of[e] < 0) continue;
    const End& end = ends.all_[e];
    const double slip = way(end.wall, anchors[static_cast<std::size_t>(anchor_of[e])].x, end.place);
    energy += 0.5 * stiffness_ * slip * slip;
  }
  return energy;
}

WallYield ContactLine::follow(std::vector<WallAnchor>& anchors, const Ends& ends, Purpose purpose) const {
  const std::vector<Index>& anchor_of = matched(anchors, ends);
  WallYield yield;
  ends.after_.clear();
  for (std::size_t e = 0; e < ends.all_.size(); ++e) {
    const End& end = ends.all_[e];
    if (anchor_of[e] < 0) {
      ends.after_.push_back({end.side, end.wall, end.place, 0});
      continue;
    }
    WallAnchor anchor = anchors[static_cast<std::size_t>(anchor_of[e])];
    const double slip = way(end.wall, anchor.x, end.place);
    const double held = yield.hold(anchor, slip, -most_outwards_ / stiffness_, most_inwards_ / stiffness_,
                                   stiffness_, purpose);
    if (held != slip) anchor.x = end.place - held;
    ends.after_.push_back(anchor);
  }
  for (std::size_t a = 0; a < anchors.size(); ++a)
    if (ends.is_taken_[a] == 0) yield.forget(anchors[a], stiffness_);
  std::swap(anchors, ends.after_);
  return yield;
}

}  // namespace clog
