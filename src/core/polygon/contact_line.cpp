#include "clog/core/polygon/contact_line.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "clog/core/tools/portable_math.hpp"
#include "clog/core/tools/units.hpp"
#include "dp_kernel.hpp"

namespace clog {
namespace {

using Eigen::Index;
using std::numbers::pi;

double cosine(double degrees) { return portable::cos(degrees * pi / 180); }

/// Where a vertex is, seen from a wall.
struct Beside {
  double distance;         // [sigma]
  Eigen::Array2d normal;   // away from the wall
  double place;            // u, against the sense of the contour [sigma]
  Eigen::Array2d forward;  // its gradient
};

Beside beside_circle(const WallPlace& wall, const Eigen::Array2d& from_centre) {
  const double r = from_centre.matrix().norm();
  const Eigen::Array2d normal = from_centre / r;
  return {.distance = r - wall.radius,
          .normal = normal,
          .place = wall.radius * portable::atan2(normal[1], normal[0]),
          .forward = wall.radius / r * Eigen::Array2d(-normal[1], normal[0])};
}

/// u is 0 on the axis; from the tip's circle it goes on along the flanks.
Beside beside_wedge(const Wedge& wedge, const Eigen::Array2d& from_centre) {
  const auto [distance, normal] = distance_to(wedge, from_centre);
  const Eigen::Array2d across_axis{-wedge.axis[1], wedge.axis[0]};
  const double across = (from_centre * across_axis).sum();
  const double along = (from_centre * wedge.axis).sum();
  const double c = wedge.half_angle.cos;
  const double s = wedge.half_angle.sin;
  Beside beside{.distance = distance, .normal = normal, .place = 0, .forward = {-normal[1], normal[0]}};
  if (along * c + std::abs(across) * s < 0) {
    // The angle from minus the axis, counter-clockwise around the centre.
    beside.place = wedge.radius * portable::atan2(-across, -along);
    beside.forward *= wedge.radius / (distance + wedge.radius);
  } else {
    const double on_tip = wedge.radius * (pi / 2 - wedge.half_angle.radians);
    const double on_flank = along * c + std::abs(across) * s;
    beside.place = (across < 0 ? 1 : -1) * (on_tip + on_flank);
  }
  return beside;
}

/// From one place along a wall to another: around a circle the shorter way.
double way(const WallPlace& wall, double from, double to) {
  const double turn = 2 * pi * wall.radius;
  return wall.wedge >= 0 ? to - from : std::remainder(to - from, turn);
}

/// Vertices that a contact lets hover, or that bounce, still lie on the wall up to this distance, over the
/// vertex diameter: an end that is held must not be lost with them.
constexpr double hovering = 0.25;

}  // namespace

bool has_hysteresis(const DpParameters& dp) {
  const double young = young_angle(dp);
  return dp.receding_angle.value_or(young) < young || dp.advancing_angle.value_or(young) > young;
}

/// A wall near the interface, and the vertices near it in the order of their numbers.
struct ContactLine::Zone {
  WallPlace wall;
  struct Vertex {
    Index vertex;
    double share, slope;
    Eigen::Array2d normal;
  };
  std::vector<Vertex> vertices;

  Beside beside(std::span<const Wedge> wedges, const DropletState& state, Index vertex) const {
    const Eigen::Array2d from_centre{state.x()[vertex] - wall.x, state.y()[vertex] - wall.y};
    return wall.wedge < 0 ? beside_circle(wall, from_centre)
                          : beside_wedge(wedges[static_cast<std::size_t>(wall.wedge)], from_centre);
  }
};

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

void ContactLine::add_to(Zone& zone, const DropletState& state, Index vertex) const {
  const Eigen::Array2d from_centre{state.x()[vertex] - zone.wall.x, state.y()[vertex] - zone.wall.y};
  const WedgeDistance at = distance_to(zone.wall, wedges_, from_centre);
  const double on_wall = width_ * hovering / wetting_width;
  const WettedShare share = wetted_share(at.distance, contact_range_ + on_wall, width_ - on_wall);
  if (share.share > 0) zone.vertices.push_back({vertex, share.share, share.slope, at.normal});
}

std::vector<ContactLine::End> ContactLine::ends(const DropletState& state,
                                                std::span<const WallContacts::Item> circles) const {
  std::vector<Zone> zones;
  for (const WallContacts::Item& item : circles) {
    const WallPlace circle{item.x, item.y, item.reach - contact_range_ - width_};
    auto zone = std::find_if(zones.begin(), zones.end(), [&](const Zone& one) {
      return one.wall.x == circle.x && one.wall.y == circle.y;
    });
    if (zone == zones.end()) zone = zones.insert(zones.end(), Zone{circle, {}});
    for (int bit = 0; bit < WallContacts::edges_per_group; ++bit)
      if ((item.edges >> bit & 1) != 0)
        add_to(*zone, state, Index{item.group} * WallContacts::edges_per_group + bit);
  }
  for (std::size_t k = 0; k < wedges_.size(); ++k) {
    const kernel::WedgePlace place = kernel::place_in(state.frame, wedges_[k]);
    Zone& zone = zones.emplace_back(Zone{{place.x, place.y, place.radius, static_cast<Index>(k)}, {}});
    for (Index i = 0; i < state.size(); ++i) add_to(zone, state, i);
  }
  std::vector<End> ends;
  for (const Zone& zone : zones) add_ends(zone, state, ends);
  return ends;
}

void ContactLine::add_ends(const Zone& zone, const DropletState& state, std::vector<End>& ends) const {
  const Index n = state.size();
  const auto num = static_cast<Index>(zone.vertices.size());
  const auto vertex = [&](Index k) -> const Zone::Vertex& {
    return zone.vertices[static_cast<std::size_t>((k % num + num) % num)];
  };
  const auto follows = [&](Index k) { return (vertex(k).vertex + 1) % n == vertex(k + 1).vertex; };
  // One end for each wetted vertex from which a sum outwards meets no other.
  for (Index k = 0; k < num; ++k) {
    if (vertex(k).share < 1) continue;
    for (const Index side : {Index{0}, Index{1}}) {
      const Index step = side == 1 ? 1 : -1;
      Index last = k;  // of the arc
      const auto goes_on = [&] { return step > 0 ? follows(last) : follows(last - 1); };
      while (last - k < num && k - last < num && goes_on() && vertex(last + step).share < 1) last += step;
      if (goes_on() && vertex(last + step).share >= 1) continue;

      // u falls along the contour: outwards is -u at the last end.
      const double outwards = side == 1 ? -1 : 1;
      End end{zone.wall, side, 0, {}};
      Beside here = zone.beside(wedges_, state, vertex(k).vertex);
      double sum = here.place;
      double way_before = 0;
      Eigen::Array2d carried = here.forward;  // what u of the present vertex weighs so far
      for (Index j = k;; j += step) {
        const bool is_last = j == last;
        const Index next = (vertex(j).vertex + step + n) % n;
        const Beside there = zone.beside(wedges_, state, next);
        const double share = (vertex(j).share + (is_last ? 0 : vertex(j + step).share)) / 2;
        const double further = way(zone.wall, here.place, there.place);
        sum += share * further;
        end.gradient.emplace_back(
            vertex(j).vertex, outwards * (carried - share * here.forward +
                                          vertex(j).slope * (way_before + further) / 2 * vertex(j).normal));
        carried = share * there.forward;
        way_before = further;
        here = there;
        if (!is_last) continue;
        end.gradient.emplace_back(next, outwards * carried);
        break;
      }
      end.place = outwards * sum;
      ends.push_back(std::move(end));
    }
  }
}

std::vector<Index> ContactLine::matched(const DropletState& state, std::span<const End> ends) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // by the way between them
  for (std::size_t e = 0; e < ends.size(); ++e)
    for (std::size_t a = 0; a < state.anchors.size(); ++a) {
      const WallAnchor& anchor = state.anchors[a];
      if (anchor.holder == ends[e].side && anchor.wall.is(ends[e].wall))
        pairs.emplace_back(std::abs(way(ends[e].wall, anchor.x, ends[e].place)), e, a);
    }
  std::sort(pairs.begin(), pairs.end());
  std::vector<Index> anchor_of(ends.size(), -1);
  std::vector<char> is_taken(state.anchors.size(), 0);
  for (const auto& [distance, e, a] : pairs) {
    if (anchor_of[e] >= 0 || is_taken[a] != 0) continue;
    anchor_of[e] = static_cast<Index>(a);
    is_taken[a] = 1;
  }
  return anchor_of;
}

void ContactLine::add_forces(const DropletState& state, std::span<const End> ends,
                             Eigen::ArrayXd& force) const {
  const std::vector<Index> anchor_of = matched(state, ends);
  for (std::size_t e = 0; e < ends.size(); ++e) {
    if (anchor_of[e] < 0) continue;
    const WallAnchor& anchor = state.anchors[static_cast<std::size_t>(anchor_of[e])];
    const double pull = -stiffness_ * anchor.slip_of_force(way(ends[e].wall, anchor.x, ends[e].place));
    for (const auto& [vertex, gradient] : ends[e].gradient) {
      force[vertex] += pull * gradient[0];
      force[state.size() + vertex] += pull * gradient[1];
    }
  }
}

double ContactLine::energy(const DropletState& state, std::span<const End> ends) const {
  const std::vector<Index> anchor_of = matched(state, ends);
  double energy = 0;
  for (std::size_t e = 0; e < ends.size(); ++e) {
    if (anchor_of[e] < 0) continue;
    const double slip =
        way(ends[e].wall, state.anchors[static_cast<std::size_t>(anchor_of[e])].x, ends[e].place);
    energy += 0.5 * stiffness_ * slip * slip;
  }
  return energy;
}

WallYield ContactLine::follow(DropletState& state, std::span<const End> ends, Purpose purpose) const {
  const std::vector<Index> anchor_of = matched(state, ends);
  WallYield yield;
  std::vector<WallAnchor> after;
  std::vector<char> is_kept(state.anchors.size(), 0);
  for (std::size_t e = 0; e < ends.size(); ++e) {
    const End& end = ends[e];
    if (anchor_of[e] < 0) {
      after.push_back({end.side, end.wall, end.place, 0});
      continue;
    }
    is_kept[static_cast<std::size_t>(anchor_of[e])] = 1;
    WallAnchor anchor = state.anchors[static_cast<std::size_t>(anchor_of[e])];
    const double slip = way(end.wall, anchor.x, end.place);
    const double held = yield.hold(anchor, slip, -most_outwards_ / stiffness_, most_inwards_ / stiffness_,
                                   stiffness_, purpose);
    if (held != slip) anchor.x = end.place - held;
    after.push_back(anchor);
  }
  for (std::size_t a = 0; a < state.anchors.size(); ++a)
    if (is_kept[a] == 0) yield.forget(state.anchors[a], stiffness_);
  state.anchors = std::move(after);
  return yield;
}

}  // namespace clog
