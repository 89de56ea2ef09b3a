#include "clog/core/polygon/neck.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace clog {
namespace {

/// A part of the droplet is a lobe if a circle of equal area is at least this many times as wide as the neck.
/// So a circle has no neck: a chord cuts off at most half the area of the circle with this chord as its
/// diameter.
constexpr double lobe_width = 2;
/// A lobe also has at least this fraction of the droplet's area. Smaller parts do not count, because
/// retracting films end in beads with a thousandth of the area.
constexpr double lobe_share = 0.02;

/// Largest cosine of an angle that counts as a right angle. All segments across a bridge with straight sides
/// are equally long. Without this tolerance, round-off would decide which of these segments is the shortest.
constexpr double round_off = 1e-9;
/// Whether `value` is at most its round-off. The value is the product of a cosine or sine and two lengths.
/// The function takes the squared lengths, so that no root is needed.
bool is_hardly_positive(double value, double squared_lengths) {
  return value <= 0 || value * value <= round_off * round_off * squared_lengths;
}

using Eigen::Array2d;

double dot(const Array2d& a, const Array2d& b) { return a[0] * b[0] + a[1] * b[1]; }
double cross(const Array2d& a, const Array2d& b) { return a[0] * b[1] - a[1] * b[0]; }
double length(const Array2d& a) { return std::sqrt(dot(a, a)); }

/// Whether a segment does not get shorter when its end moves a little along this edge.
bool leads_away(const Array2d& segment, const Array2d& edge) {
  return is_hardly_positive(dot(segment, edge), dot(segment, segment) * dot(edge, edge));
}

class Outline {
 public:
  explicit Outline(const Eigen::ArrayXd& position) : n_(position.size() / 2), position_(position) {
    sectors_.reserve(n_ + 1);
    sectors_.push_back(0);
    for (Eigen::Index i = 0; i < n_; ++i)
      sectors_.push_back(sectors_.back() + 0.5 * cross(vertex(i), vertex(next(i))));
  }

  Eigen::Index size() const { return n_; }
  Eigen::Index next(Eigen::Index i) const { return i + 1 < n_ ? i + 1 : 0; }
  Eigen::Index before(Eigen::Index i) const { return i > 0 ? i - 1 : n_ - 1; }
  Array2d vertex(Eigen::Index i) const { return {position_[i], position_[n_ + i]}; }
  /// Edge i leads from vertex i to the next.
  Array2d edge(Eigen::Index i) const { return vertex(next(i)) - vertex(i); }

  /// Whether the outline is concave or straight at this vertex.
  bool turns_inwards(Eigen::Index i) const {
    const Array2d come = edge(before(i)), go = edge(i);
    return is_hardly_positive(cross(come, go), dot(come, come) * dot(go, go));
  }

  /// Points to the outside.
  Array2d normal_of_edge(Eigen::Index i) const {
    const Array2d along = edge(i);
    return Array2d(along[1], -along[0]) / length(along);
  }
  Array2d normal_at_vertex(Eigen::Index i) const { return normal_of_edge(before(i)) + normal_of_edge(i); }

  /// Area enclosed by the outline from vertex `from` to a point of edge `to`, and by the segment from this
  /// point back to the vertex.
  double area_behind(Eigen::Index from, Eigen::Index to, const Array2d& point) const {
    const double way = sectors_[to] - sectors_[from] + (to < from ? sectors_[n_] : 0);
    return way + 0.5 * (cross(vertex(to), point) + cross(point, vertex(from)));
  }
  double area() const { return sectors_[n_]; }

  /// Whether no other part of the outline is between a vertex and a point of an edge.
  bool is_clear(Eigen::Index from, Eigen::Index to, const Array2d& point) const {
    const Array2d begin = vertex(from), segment = point - begin;
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (i == from || next(i) == from || i == to || next(i) == to || i == next(to)) continue;
      const Array2d a = vertex(i), b = vertex(next(i));
      if (cross(segment, a - begin) * cross(segment, b - begin) < 0 &&
          cross(b - a, begin - a) * cross(b - a, point - a) < 0)
        return false;
    }
    return true;
  }

 private:
  Eigen::Index n_;
  const Eigen::ArrayXd& position_;
  std::vector<double> sectors_;  // area between the origin and the outline from vertex 0 to vertex i
};

/// The point of an edge that is closest to another point.
struct Foot {
  Eigen::Index edge;
  double place;  ///< place on the edge: 0 at its first vertex, 1 at its second
  Array2d point;
};
Foot foot_on(const Outline& outline, Eigen::Index edge, const Array2d& from) {
  const Array2d begin = outline.vertex(edge), along = outline.edge(edge);
  const double place = std::clamp(dot(from - begin, along) / dot(along, along), 0.0, 1.0);
  return {edge, place, begin + place * along};
}

/// Whether the segment does not get shorter when either of its ends moves along the outline.
bool is_local_minimum(const Outline& outline, Eigen::Index vertex, const Foot& foot) {
  const Array2d there = foot.point - outline.vertex(vertex), back = -there;
  return leads_away(there, outline.edge(vertex)) &&
         leads_away(there, -outline.edge(outline.before(vertex))) &&
         (foot.place > 0 || leads_away(back, -outline.edge(outline.before(foot.edge)))) &&
         (foot.place < 1 || leads_away(back, outline.edge(outline.next(foot.edge))));
}

bool lies_inside(const Outline& outline, Eigen::Index vertex, const Foot& foot) {
  const Array2d there = foot.point - outline.vertex(vertex);
  const Array2d normal = foot.place <= 0   ? outline.normal_at_vertex(foot.edge)
                         : foot.place >= 1 ? outline.normal_at_vertex(outline.next(foot.edge))
                                           : outline.normal_of_edge(foot.edge);
  return dot(there, outline.normal_at_vertex(vertex)) < 0 && dot(there, normal) > 0 &&
         outline.is_clear(vertex, foot.edge, foot.point);
}

bool parts_are_lobes(const Outline& outline, Eigen::Index vertex, const Foot& foot, double width) {
  const double least = std::max(lobe_share * outline.area(),
                                std::numbers::pi / 4 * (lobe_width * width) * (lobe_width * width));
  const double part = outline.area_behind(vertex, foot.edge, foot.point);
  return part >= least && outline.area() - part >= least;
}

/// Width of the widest possible neck, which divides the droplet into two equal areas.
double widest_neck(const Outline& outline) {
  return std::sqrt(outline.area() / 2 / (std::numbers::pi / 4)) / lobe_width;
}

/// The edges from `first` to `last` - 1, and their bounding rectangle.
struct Run {
  Eigen::Index first, last;
  Array2d low, high;

  double squared_distance(const Array2d& point) const {
    const Array2d away = (low - point).max(point - high).max(0);
    return dot(away, away);
  }
  /// Whether the rectangle contains a place such that the segment from `point` to this place makes no acute
  /// angle with `edge`.
  /// @param tolerance  round-off times the edge's length
  bool reaches_behind(const Array2d& point, const Array2d& edge, double tolerance) const {
    const double x = edge[0] > 0 ? low[0] : high[0];
    const double y = edge[1] > 0 ? low[1] : high[1];
    return (x - point[0]) * edge[0] + (y - point[1]) * edge[1] <= tolerance;
  }
};

std::vector<Run> runs_of_edges(const Outline& outline) {
  constexpr Eigen::Index most = 16;
  std::vector<Run> runs;
  for (Eigen::Index first = 0; first < outline.size(); first += most) {
    Run run{first, std::min(first + most, outline.size()), outline.vertex(first), outline.vertex(first)};
    for (Eigen::Index i = first; i < run.last; ++i) {
      const Array2d end = outline.vertex(outline.next(i));
      run.low = run.low.min(end);
      run.high = run.high.max(end);
    }
    runs.push_back(run);
  }
  return runs;
}

/// Searches the edges of `run` for a neck that begins at `vertex` and is thinner than `thinnest`. If there is
/// such a neck, stores it in `thinnest`.
void look_for_neck(const Outline& outline, Eigen::Index vertex, const Run& run, Neck& thinnest) {
  const Array2d from = outline.vertex(vertex);
  for (Eigen::Index edge = run.first; edge < run.last; ++edge) {
    if (edge == vertex || outline.next(edge) == vertex) continue;
    const Foot foot = foot_on(outline, edge, from);
    const Array2d there = foot.point - from;
    if (dot(there, there) >= thinnest.width * thinnest.width || !is_local_minimum(outline, vertex, foot))
      continue;
    const double width = length(there);
    if (parts_are_lobes(outline, vertex, foot, width) && lies_inside(outline, vertex, foot))
      thinnest = {.width = width, .vertex = vertex, .edge = edge, .place = foot.place};
  }
}

}  // namespace

Neck thinnest_neck(const Eigen::ArrayXd& position, double below) {
  const Outline outline(position);
  const std::vector<Run> runs = runs_of_edges(outline);
  const double bound = std::min(below, (1 + round_off) * widest_neck(outline));
  Neck thinnest{.width = bound};
  for (Eigen::Index vertex = 0; vertex < outline.size(); ++vertex) {
    if (!outline.turns_inwards(vertex)) continue;
    const Array2d from = outline.vertex(vertex);
    const Array2d go = outline.edge(vertex), come = -outline.edge(outline.before(vertex));
    const double tolerance = round_off * std::max(length(go), length(come));
    for (const Run& run : runs)
      if (run.squared_distance(from) < thinnest.width * thinnest.width &&
          run.reaches_behind(from, go, tolerance) && run.reaches_behind(from, come, tolerance))
        look_for_neck(outline, vertex, run, thinnest);
  }
  return thinnest.width < bound ? thinnest : Neck();
}

}  // namespace clog
