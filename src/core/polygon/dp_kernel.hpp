#pragma once

#include <cstddef>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/droplet/shape.hpp"
#include "clog/core/world/wedge.hpp"

/// The loops over vertices behind DpForces, in readable form; the step has passes of its own
/// (dp_step_kernel.hpp). Plain arrays of length n (one entry per vertex or
/// edge), no branch, no allocation. Each is compiled for several instruction sets, and use_instruction_set()
/// chooses. Edge i joins vertices i and i + 1, the last one closes the contour.
namespace clog::kernel {

struct EdgeArrays {
  double* x;  ///< edge vectors [sigma]
  double* y;
  double* length;  ///< [sigma]
};
struct Sums {
  double area;
  double perimeter;
  double moment_x;  ///< of the area, area times its centroid [sigma^3]
  double moment_y;
};
/// Fills the edges; returns sums over them.
Sums measure_edges(int n, const double* x, const double* y, EdgeArrays edges);

/// Derivative of the area's centroid by the vertices, d(X, Y)/d(x_i, y_i): the force on the vertices of a
/// body force (W_x, W_y) on the area is (W_x xx + W_y yx, W_x xy + W_y yy), and the centroid's velocity is
/// (sum xx v_x + xy v_y, sum yx v_x + yy v_y).
struct CentroidGradient {
  double* xx;
  double* xy;
  double* yx;
  double* yy;
};
inline CentroidGradient centroid_gradient(std::ptrdiff_t n, double* four_arrays) {
  return {four_arrays, four_arrays + n, four_arrays + 2 * n, four_arrays + 3 * n};
}
void measure_centroid_gradient(int n, const double* x, const double* y, EdgeArrays edges, const Sums& sums,
                               CentroidGradient gradient);
/// Adds a body force on the area.
void add_body_force(int n, double force_x, double force_y, CentroidGradient gradient, double* fx, double* fy);

struct Interface {
  double line_tension;   ///< gamma
  double spring;         ///< k_l N_v
  double spring_length;  ///< l0 or the mean edge length
  double spreading;      ///< k_l N_v of springs that act along the interface only
  double pressure;       ///< -k_a (a - a0)
  double vertex_weight;  ///< M g / N_v along +x
};
/// Overwrites fx, fy with tension, springs, pressure and weight. `pull` is scratch of length n.
void interface_forces(int n, const Interface& interface, EdgeArrays edges, double* pull, double* fx,
                      double* fy);

struct WallSlot {
  const double* x;
  const double* y;
  const double* radius;
};
/// Middles of the edges, and the pushes that walls give their beginnings, middles and ends. Arrays of length
/// n.
struct RefinedEdges {
  double* middle_x;
  double* middle_y;
  double *begin_push_x, *begin_push_y;
  double *middle_push_x, *middle_push_y;
  double *end_push_x, *end_push_y;
};
inline RefinedEdges refined_edges(std::ptrdiff_t n, double* eight_arrays) {
  const auto array = [=](int k) { return eight_arrays + k * n; };
  return {array(0), array(1), array(2), array(3), array(4), array(5), array(6), array(7)};
}
/// Finds the middles, and clears the pushes.
void refine_edges(int n, const double* x, const double* y, RefinedEdges edges);
/// A circle and consecutive edges.
struct CircleAtEdges {
  double x, y;
  double reach;    ///< radius + range [sigma]
  int first, end;  ///< of the edges; those behind the last one are none
};
/// Adds k_c (reach - d) away from the circle where d < reach, d the distance of the nearest point of half an
/// edge to its centre; the half's two ends share the push as the point divides it.
void push_off_circle(int n, const double* x, const double* y, RefinedEdges edges, const CircleAtEdges& circle,
                     double stiffness);
/// Adds the pushes to the forces on the vertices: a middle's goes to the four vertices that decide where it
/// is.
void hand_out_pushes(int n, RefinedEdges edges, double* fx, double* fy);
/// The same with the vertices alone: the published contact.
void add_vertex_wall_forces(int n, const double* x, const double* y, WallSlot slot, double range,
                            double stiffness, double* fx, double* fy);
/// A wedge (see wedge.hpp) in the coordinates of the vertices.
struct WedgePlace {
  double x, y;  ///< its centre()
  double radius;
  double axis_x, axis_y;
  double cos, sin;  ///< of the half angle
};
WedgePlace place_in(const LocalFrame& frame, const Wedge& wedge);
/// The same with every vertex against a wedge's surface. Edges need not be tested: they meet a wedge's tip
/// first, which is in a slot of its own, as a circle.
void add_wedge_forces(int n, const double* x, const double* y, const WedgePlace& wedge, double range,
                      double stiffness, double* fx, double* fy);
/// distance[i] = min(distance[i], distance of vertex i to the wedge).
void shrink_to_wedge_distance(int n, const double* x, const double* y, const WedgePlace& wedge,
                              double* distance);
/// distance[i] = min(distance[i], distance of vertex i to the slot's circle).
void shrink_to_wall_distance(int n, const double* x, const double* y, WallSlot slot, double* distance);

}  // namespace clog::kernel
