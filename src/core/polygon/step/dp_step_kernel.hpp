#pragma once

#include <cstddef>
#include <cstdint>

#include "clog/core/polygon/contact/self_contacts.hpp"
#include "clog/core/polygon/contact/wall_contacts.hpp"
#include "core/polygon/contact/wedge_place.hpp"

/// The step of a deformable polygon as two passes over its vertices, written with vector types and compiled
/// for several instruction sets. Tests compare it with plain loops (polygon/forces/reference_forces.hpp). A
/// pass does not branch at each vertex, and makes no call and no allocation. Square roots are computed by
/// Newton iterations if the instruction set has an instruction for the first guess.
namespace clog::kernel {

/// Number of consecutive edges that are tested for contact at once, for any instruction set.
inline constexpr int edges_per_group = WallContacts::edges_per_group;

/// An array with an entry for each vertex or edge. Entry 0 begins a cache line. Entries from [-1] to [n +
/// edges_per_group - 1] are valid: the passes repeat the contour beyond its ends.
struct ContourArray {
  double* first;

  double* operator+(std::ptrdiff_t i) const { return first + i; }
  double& operator[](std::ptrdiff_t i) const { return first[i]; }
};
struct ContourPair {
  ContourArray x, y;
};
struct StepArrays {
  ContourPair position, velocity;
  ContourPair tangent;         ///< unit vectors along the edges
  ContourArray length;         ///< lengths of the edges
  ContourPair push;            ///< kick of the vertices by contact
  ContourPair wetting;         ///< part of the kick by wetted walls that derives from no energy
  ContourPair grad_x, grad_y;  ///< gradients of the centroid's x and of its y, times 6 a
  ContourArray rate;           ///< drag rate of a vertex [1/t0], if the rates differ
  ContourArray damping,
      kept;            ///< s and s (1 - h2 r) of KickCoefficients
  ContourPair kicked;  ///< w of KickCoefficients, if keeps_kicked
  ContourPair chord;   ///< vector between a vertex's neighbours, for an implicit pressure
};

/// Sums over the edges.
struct Sums {
  double area;
  double perimeter;
  double moment_x;  ///< first moment of the area: the area times its centroid [sigma^3]
  double moment_y;
};

/// A kick is the change of a vertex's velocity by a force in half a time step h. In the comments below, F is
/// a force times h/(M/N_v).
struct InterfaceKick {
  double line_tension;  ///< tension of the interface at zero length of the springs
  double spring;        ///< stiffness of springs that carry tension
  double spreading;     ///< stiffness of springs along the interface
  double half_pressure;
  double vertex_weight;  ///< weight, along +x
};
/// A force on the area, spread over the vertices by the gradient of the area's centroid.
struct AreaForce {
  double area;                ///< [sigma^2]
  double centre_x, centre_y;  ///< centroid of the area [sigma]
  double x, y;                ///< kick, without the reaction to the springs along the interface
};
/// Coefficients of one kick. With r the drag rate of a vertex and s = 1/(1 + h1 r), w = s (v + closing_ratio
/// F),   q = w (1 - h2 r) + F,   v' = q + weight s (c - G^T a). Here w is the velocity after the kick by the
/// force and the vertex's own drag, and v' is the next velocity. c and a are known only after the sums over
/// all vertices (see Coupling). Until then, q is stored in place of the velocity. One kick of this form ends
/// a time step and begins the next.
struct KickCoefficients {
  double closing_ratio;  ///< h1 / half_step. Here h1 is the half step that ends a time step, and half_step is
                         ///< that of the forces
  double h1, h2;         ///< [t0]
  double weight;         ///< (h1 + h2) / half_step, or h1 / half_step if no time step begins
  double half_step;      ///< the half step of the forces [t0]
  bool keeps_kicked;     ///< whether the kick stores w for power()
  /// For an implicit pressure: K_a half_step^2/(M/N_v), with K_a the area stiffness. If a half kick ends a
  /// step and the next step has another length, `softening` is that of the next step.
  double softening = 0;
};
/// The terms of a kick. Each combination is compiled separately.
struct KickTerms {
  bool elastic;            ///< whether springs carry tension; otherwise they act along the interface
  bool on_area;            ///< whether weight and mean drag act on the area; the vertices are then coupled
  bool varying_rate;       ///< whether vertices have different drag rates (StepArrays::rate); otherwise all
                           ///< vertices have the drag rate `rate`
  bool coupled;            ///< whether the force on a vertex depends on the velocities of all vertices
  bool implicit_pressure;  ///< see Coupling
  double rate;             ///< drag rate of all vertices [1/t0]
  double relative_rate, area_rate;  ///< rates of the drag by the mean velocities of vertices and area [1/t0]
};
/// Mean velocities, and their contributions to the velocities of the vertices.
///
/// An implicit pressure is the pressure at the area A + dt^2 d^2A/dt^2, which the droplet would have if its
/// present acceleration lasted for a time step. The acceleration contains all forces on vertices and area,
/// including the added pressure, and the drag on the area. It neglects the vertices' own drag and the change
/// of the area's gradient. For the area mode this is Newmark's method with beta = 1; all other modes move by
/// velocity Verlet. The mode's frequency omega becomes omega/sqrt(1 + (omega dt)^2), so the mode is stable
/// for every step. If the area is not accelerated, as at rest and in steady fall, the added pressure is 0.
struct Coupling {
  double mean_x = 0, mean_y = 0;  ///< mean velocity of the vertices
  double area_x = 0, area_y = 0;  ///< velocity of the area's centroid
  double c_x = 0, c_y = 0;
  double a_x = 0, a_y = 0;   ///< a of KickCoefficients, with the force on the area; divided by 6 areas
  double half_pressure = 0;  ///< difference between the implicit pressure and the present pressure, as a kick
};
/// Powers in units in which M/N_v = 1.
struct Power {
  double drag;       ///< dissipation by the vertices' own drag, sum r_i v_i^2
  double spreading;  ///< power of the kicks F_i that spread vertices along the interface, sum F_i v_i
  double spread_x, spread_y;  ///< sum of the kicks F_i
};
/// A circle and the edges_per_group edges from `first` on; the bits of `edges` mark the edges that may touch
/// the circle.
struct WallWindow {
  double x, y;   ///< circle's centre [sigma]
  double reach;  ///< radius + range, for the layer [sigma]
  int first;
  std::uint8_t edges;
  std::uint8_t layer;  ///< see WallContacts
};
/// Forces of edges on their vertices, as windows store them, in six arrays. The first three arrays contain
/// the x components of three forces: the force on an edge's first vertex, the force on its second vertex, and
/// the force on each of the two neighbouring vertices. The other three arrays contain the y components. All
/// entries outside the windows are zero.
struct WindowPushArrays {
  double* first;  ///< entry of edge 0; entries from two groups before the windows to two groups behind them
                  ///< are readable
  std::ptrdiff_t stride;
};
inline constexpr int num_window_push_arrays = 6;
/// Repulsion by circles; see WallPlan.
struct WallWindows {
  const WallWindow* all;
  int num_own;  ///< number of leading windows; no two of them share an edge
  int num_all;
  /// Groups of vertices that windows may push. Group -1 and the group behind the last one belong to the
  /// contour's other end.
  const int* groups;
  int num_groups;
  WindowPushArrays pushes;
};
/// A circle that pushes vertices of one layer and holds them by friction.
struct HoldingCircle {
  double x, y, radius;  ///< [sigma]
  int layer;            ///< see WallContacts
  int first_window, end_window;
  int first_group, end_group;  ///< groups of vertices that the circle may push
  /// Whether the circle pushes vertices -1, n or n + 1, which belong to the contour's other end.
  bool wraps;
  WindowPushArrays pushes;  ///< forces of this circle
};
/// Repulsion and friction of circles; see WallHold. Every group of vertices that a circle may push has
/// edges_per_group entries in each of anchor_x, anchor_y and slip, and one entry in holds.
struct HoldingCircles {
  const HoldingCircle* all;
  std::size_t num;
  const WallWindow* windows;
  const int* groups;
  double *anchor_x, *anchor_y;  ///< place relative to the circle's centre [sigma]
  double* slip;                 ///< distance along the wall from the anchor to its vertex [sigma]
  std::uint8_t* holds;          ///< vertices that have an anchor, as bits
  ContourPair push;             ///< push on the vertices, by one circle; working memory
  ContourArray wetted;          ///< length of the interface on one circle [sigma]; working memory
};
struct Held {
  double nearest_pair;  ///< smallest distance of a listed pair of self-contact [sigma]
  double taken;         ///< energy lost to walls, divided by k_t [sigma^2]
};
/// Limits of friction, converted to kicks.
struct WallGrip {
  double coefficient;            ///< coefficient of friction, for the layer next to the wall
  double coefficient_of_layers;  ///< coefficient of friction, for the layers above
  double traction;               ///< yield traction for each sigma of wetted length, next to the wall
  double stiffness;              ///< k_t of the springs between interface and wall
};
struct Contact {
  double stiffness;   ///< k_c as a kick
  double span;        ///< 1: walls push edges, 0: they push only the first vertex of each edge
  double self_range;  ///< distance below which the interface repels itself [sigma]
};
/// Obstacles that may be nearest to the vertices.
struct NearWalls {
  const WallContacts::Item* items;  ///< circles, by group
  std::size_t num_items;
  double range;   ///< range that the items' reach includes [sigma]
  bool alike;     ///< whether all circles have the same radius
  double radius;  ///< [sigma]
  const WedgePlace* wedges;
  std::size_t num_wedges;
};
struct NearWallDrag {
  double shortest;  ///< smaller distances count as this distance [sigma]
  double relative, near_wall, exponent;
  double far_rate;  ///< [1/t0]
};

/// Results of a survey between steps.
struct Survey {
  double perimeter, shortest;  ///< perimeter, and length of the shortest edge [sigma]
  /// Largest speed of a vertex, and largest speed of a vertex relative to the mean velocity [sqrt(sigma g)].
  double speed, relative_speed;
  double moved, moved_relative;  ///< largest displacement of a vertex from the earlier positions, see
                                 ///< StepKernel::survey [sigma]
};

/// The passes, compiled for one instruction set.
struct StepKernel {
  /// Computes the edges, and sums over them.
  Sums (*measure)(int n, const StepArrays& arrays);
  /// @param walls, self  earlier positions of the vertices, all x then all y; the positions in `self` are
  /// relative to their mean. Either may be null
  Survey (*survey)(int n, const double* walls, const double* self, const StepArrays& arrays);
  /// Computes the gap between every edge of every item and the contact range of the item's circle:
  /// edges_per_group gaps for each item, negative in contact [sigma]. Returns the smallest gap, or 0 if all
  /// gaps are positive.
  double (*circle_gaps)(const WallContacts::Item* items, std::size_t num_items, const Contact& contact,
                        const StepArrays& arrays, double* gaps);
  /// The edges of one item with a gap of at most `way`, as bits.
  std::uint8_t (*edges_within)(const double* gaps, double way);
  /// Computes the gap of the closest pair of every item. Returns the smallest gap, or 0 if all gaps are
  /// positive.
  double (*pair_gaps)(const SelfContacts::Item* items, std::size_t num_items, const Contact& contact,
                      const StepArrays& arrays, double* gaps);
  /// clear_pushes() sets the pushes on all vertices to zero. push() computes the pushes of circles on the
  /// groups of vertices listed in `walls`, and the pushes of the droplet on itself. It returns the smallest
  /// distance of a listed pair [sigma].
  void (*clear_pushes)(int n, const StepArrays& arrays);
  double (*push)(int n, const WallWindows& walls, const SelfContacts::Item* self, std::size_t num_self,
                 const Contact& contact, const StepArrays& arrays);
  /// Like push(), but for all groups, and with the circles' friction.
  Held (*push_and_hold)(int n, const HoldingCircles& walls, const WallGrip& grip,
                        const SelfContacts::Item* self, std::size_t num_self, const Contact& contact,
                        const StepArrays& arrays);
  /// Adds the forces of wedges on vertices that are nearer to a wedge's surface than `range` [sigma]. Edges
  /// need no test, because an edge touches the tip of a wedge before its flank, and the tip is listed as a
  /// circle.
  void (*push_off_wedges)(int n, const WedgePlace* wedges, std::size_t num_wedges, double range,
                          double stiffness, const StepArrays& arrays);
  /// Computes rate = far_rate (relative + near_wall (sigma/d)^exponent), where d is a vertex's distance from
  /// the nearest wall. Also computes the coefficients of a kick that follow from the rate.
  void (*near_wall_rates)(int n, const NearWalls& walls, const NearWallDrag& drag,
                          const KickCoefficients& coefficients, const StepArrays& arrays);
  /// First pass: forces and velocities.
  Coupling (*kick)(int n, const KickTerms& terms, const InterfaceKick& interface, const AreaForce& force,
                   const KickCoefficients& coefficients, const StepArrays& arrays);
  /// Powers at the end of a time step, from the velocities w that the kick stored in `kicked`. Call this
  /// between the passes.
  Power (*power)(int n, const KickTerms& terms, const InterfaceKick& interface,
                 const KickCoefficients& coefficients, const Coupling& coupling, const StepArrays& arrays);
  /// Second pass: v = q + weight s (c - G^T a), x += dt v, and the edges of the new positions. The sums
  /// include the perimeter only if springs carry tension (`elastic`), and moments only if forces act on the
  /// area.
  Sums (*drift)(int n, const KickTerms& terms, const KickCoefficients& coefficients, const Coupling& coupling,
                double dt, const StepArrays& arrays);
};

/// The kernel for these terms. Its instruction set is the widest of this processor, or the set that
/// use_instruction_set() has selected.
StepKernel step_kernel(const KickTerms& terms);

}  // namespace clog::kernel
