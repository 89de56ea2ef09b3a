#pragma once

/// The loops over vertices that a DP step consists of. Plain arrays of length n (one entry per vertex or
/// edge), no branch, no allocation; each is compiled for several instruction sets and chosen when the program
/// starts. Edge i joins vertices i and i + 1, the last one closes the contour.
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

struct Interface {
  double line_tension;   ///< gamma
  double spring;         ///< k_l N_v
  double spring_length;  ///< l0 or the mean edge length
  double spreading;      ///< k_l N_v of springs that act along the interface only
  double pressure;       ///< inside, at the coordinates' origin
  double pressure_x;     ///< its gradient
  double pressure_y;
  double vertex_x;  ///< force on every vertex
  double vertex_y;
};
/// Overwrites fx, fy with tension, spring, pressure and the vertices' own force. `pull` is scratch of length n.
void interface_forces(int n, const double* x, const double* y, const Interface& interface, EdgeArrays edges,
                      double* pull, double* fx, double* fy);

struct WallSlot {
  const double* x;
  const double* y;
  const double* radius;
};
/// Adds k_c (range - d) away from the wall where d < range, d the distance of an edge's nearest point to the
/// slot's circle; the edge's two vertices share the push as the point divides it. `end_x`, `end_y` are
/// scratch of length n.
void add_wall_forces(int n, const double* x, const double* y, EdgeArrays edges, WallSlot slot, double range,
                     double stiffness, double* end_x, double* end_y, double* fx, double* fy);
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
/// The same with every vertex against a wedge's surface. Edges need not be tested: they meet a wedge's tip
/// first, which is in a slot of its own, as a circle.
void add_wedge_forces(int n, const double* x, const double* y, const WedgePlace& wedge, double range,
                      double stiffness, double* fx, double* fy);
/// distance[i] = min(distance[i], distance of vertex i to the wedge).
void shrink_to_wedge_distance(int n, const double* x, const double* y, const WedgePlace& wedge,
                              double* distance);
/// distance[i] = min(distance[i], distance of vertex i to the slot's circle).
void shrink_to_wall_distance(int n, const double* x, const double* y, WallSlot slot, double* distance);

/// v (1 - damping) + f half_dt_over_m, then x + dt v, over n numbers; damping = zeta dt/(2m).
void kick_and_drift(int n, double damping, double half_dt_over_m, double dt, const double* f, double* v,
                    double* x);
/// (v + f half_dt_over_m)/(1 + damping).
void kick(int n, double damping, double half_dt_over_m, const double* f, double* v);
/// The same two with a drag of its own for every number, rate = zeta/m, and a drag of the motion relative to
/// a common velocity, whose part of `rate` is `relative_rate`.
struct OwnDrag {
  const double* rate;    ///< [1/t0], the relative part included
  double relative_rate;  ///< [1/t0]
};
void kick_and_drift(int n, OwnDrag drag, double half_dt_over_m, double dt, const double* f, double* v,
                    double* x);
void kick(int n, OwnDrag drag, double half_dt_over_m, double dt, const double* f, double* v);

}  // namespace clog::kernel
