#include "clog/core/polygon/contact/crossing_depth.hpp"

#include <algorithm>
#include <cmath>

namespace clog {
namespace {

/// `v` turned by 90 degrees to the left.
Eigen::Array2d turned(const Eigen::Array2d& v) { return {-v[1], v[0]}; }

}  // namespace

CrossingDepth::CrossingDepth(const Contour& contour, const CrossingPlace& place)
    : vertex_(place.vertex), begin_(place.edge), end_((place.edge + 1) % contour.size) {
  const Eigen::Array2d from = contour.place(begin_), edge = contour.place(end_) - from;
  length_ = edge.matrix().norm();
  tangent_ = edge / length_;
  const Eigen::Array2d to_vertex = contour.place(vertex_) - from;
  const double along = (to_vertex * tangent_).sum() / length_;
  fraction_ = std::clamp(along, 0.0, 1.0);
  is_beside_ = fraction_ == along;
  vector_to_edge_ = fraction_ * edge - to_vertex;
  distance_ = vector_to_edge_.matrix().norm();
  for (const int end : place.ends)
    if (end >= 0) limit_by(contour, end, place.own);
}

void CrossingDepth::limit_by(const Contour& contour, int end,
                             const std::array<CrossingPlace::OwnEdge, 2>& own) {
  Slip last{.distance = 0};
  for (const CrossingPlace::OwnEdge& one : own) {
    if (!one.crosses) continue;
    const Eigen::Array2d from = contour.place(one.begin), edge = contour.place(one.end) - from;
    const Eigen::Array2d to_end = contour.place(end) - from, normal = turned(edge) / edge.matrix().norm();
    const double off = (to_end * normal).sum();
    if (std::abs(off) > last.distance)
      last = {.distance = std::abs(off),
              .end = end,
              .own_begin = one.begin,
              .own_end = one.end,
              .fraction = (to_end * edge).sum() / edge.square().sum(),
              .direction = off > 0 ? normal : -normal};
  }
  if (last.distance < slip_.distance) slip_ = last;
}

void CrossingDepth::add_gradient(double factor, std::vector<VertexPush>& to) const {
  if (is_limited())
    add_gradient_of_slip(factor, to);
  else
    add_gradient_of_vector_to_edge(factor * to_edge(), to);
}

void CrossingDepth::add_gradient_of_shift(const Eigen::Array2d& factor, std::vector<VertexPush>& to) const {
  if (!is_limited()) {
    add_gradient_of_vector_to_edge(factor, to);
    return;
  }
  const double part = (factor * to_edge()).sum();
  add_gradient_of_slip(part, to);
  add_gradient_of_vector_to_edge(slip_.distance / distance_ * (factor - part * to_edge()), to);
}

void CrossingDepth::add_gradient_of_slip(double factor, std::vector<VertexPush>& to) const {
  to.push_back({slip_.end, factor * slip_.direction});
  to.push_back({slip_.own_begin, (slip_.fraction - 1) * factor * slip_.direction});
  to.push_back({slip_.own_end, -slip_.fraction * factor * slip_.direction});
}

/// Adds the gradient of the scalar product of `factor` and the vector from the vertex to the nearest point of
/// the edge.
void CrossingDepth::add_gradient_of_vector_to_edge(const Eigen::Array2d& factor,
                                                   std::vector<VertexPush>& to) const {
  if (!is_beside_) {
    to.push_back({vertex_, -factor});
    to.push_back({fraction_ > 0 ? end_ : begin_, factor});
    return;
  }
  // The nearest point slides along the edge with the vertex, so the vector from the vertex to this point is
  // always normal to the edge.
  const Eigen::Array2d normal = turned(tangent_);
  const double along = (factor * tangent_).sum(), across = (factor * normal).sum();
  const double on_end = fraction_ * across - along * (vector_to_edge_ * normal).sum() / length_;
  to.push_back({vertex_, -across * normal});
  to.push_back({begin_, (across - on_end) * normal});
  to.push_back({end_, on_end * normal});
}

}  // namespace clog
