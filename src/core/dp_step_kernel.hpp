#pragma once

#include <cstddef>
#include <cstdint>

#include "clog/core/self_contacts.hpp"
#include "clog/core/wall_contacts.hpp"
#include "dp_kernel.hpp"

/// The step of a deformable polygon as three passes over its vertices, written with vector types and compiled
/// for several instruction sets. Same equations as dp_kernel.hpp, which stays readable and is what tests
/// compare this with. In a pass there is no branch per vertex, no call and no allocation; square roots and
/// divisions are Newton iterations where the instruction set has a first guess for them.
namespace clog::kernel {

/// Contacts are tested for this many consecutive edges at once, whatever the instruction set.
inline constexpr int edges_per_group = WallContacts::edges_per_group;

/// Arrays of one entry per vertex or edge. Readable from [-1] to [n + edges_per_group - 1]: entries beyond
/// the ends repeat the contour, the passes see to that.
struct StepArrays {
  double *x, *y, *vx, *vy;
  double *tangent_x, *tangent_y, *length;         ///< of the edges
  double *push_x, *push_y;                        ///< contact force on the vertices
  double *grad_xx, *grad_xy, *grad_yx, *grad_yy;  ///< 6 a times the centroid's gradient
  double* rate;                                   ///< drag rate of a vertex [1/t0], if it differs
  double* damping;                                ///< s of a vertex, with the rate; see KickSums
  double *kicked_x, *kicked_y;                    ///< w, if it is wanted; see KickCoefficients
};
inline constexpr int num_step_arrays = 17;

/// Coefficients of one kick, all in the units of dp_kernel.hpp. With r a vertex's drag rate,
///   w = (v + m1 F)/(1 + h1 r),   q = w (1 - h2 r) + m2 F,   v' = q + weight/(1 + h1 r) (c - G^T A):
/// w is the velocity kicked by force and own drag, v' the next velocity once the coupled drag (c, A; see
/// drift()) is known. One kick thereby ends a time step and begins the next. q takes the place of the
/// velocity.
struct KickCoefficients {
  double h1, m1, h2, m2;
  double weight;
};
struct InterfaceCoefficients {
  double line_tension;  ///< tension where the spring is at length 0
  double spring;        ///< k_l N_v of springs that carry tension
  double spreading;     ///< k_l N_v of springs along the interface
  double half_pressure;
  double vertex_weight;       ///< M g/N_v along +x
  double body_force;          ///< on the area, over 6 a
  double centre_x, centre_y;  ///< of the area
};
struct Contact {
  double stiffness;  ///< k_c
  double span;       ///< of walls; 1: edges, 0: their first vertices alone
  double diameter;   ///< of the self-contact [sigma]
};
/// What the coupled drag needs of a kick, G being 6 a times the centroid's gradient and s = 1/(1 + h1 r).
struct KickSums {
  double spread_x, spread_y;      ///< net force of the springs along the interface
  double w_x, w_y;                ///< sum w
  double gw_x, gw_y;              ///< sum G w
  double gg_xx, gg_xy, gg_yy;     ///< sum s G G^T
  double s;                       ///< sum s
  double g_xx, g_xy, g_yx, g_yy;  ///< sum s G
};
/// Which terms a kick has. The combinations are compiled apart.
struct KickTerms {
  bool elastic;       ///< springs that carry tension; otherwise those along the interface
  bool on_area;       ///< weight and mean drag act on the area
  bool varying_rate;  ///< drag rates are those of the array; otherwise `rate`
  double rate;        ///< [1/t0]
  bool keeps_kicked;  ///< is w wanted afterwards?
};
/// What may be nearest to the vertices.
struct NearWalls {
  const WallContacts::Item* items;  ///< circles, by group
  std::size_t num_items;
  double range;                  ///< of the items' reach [sigma]
  bool alike;                    ///< have all circles this radius?
  double radius;                 ///< [sigma]
  const double* other_distance;  ///< to anything that is no circle [sigma]
};
struct NearWallDrag {
  double shortest;  ///< distances count as no less [sigma]
  double relative, near_wall, exponent;
  double far_rate;  ///< [1/t0]
};

/// One instruction set's versions of the passes.
struct StepKernel {
  const char* name;  ///< of the instruction set
  /// First pass: edges and sums over them; moments of the area only if they are wanted.
  Sums (*measure)(int n, bool with_moments, const StepArrays& arrays);
  /// Then contacts, on the groups that the lists name. `clear` empties all groups.
  void (*clear_pushes)(int n, const StepArrays& arrays);
  void (*push)(int n, const WallContacts::Item* walls, std::size_t num_walls, const SelfContacts::Item* self,
               std::size_t num_self, const Contact& contact, const StepArrays& arrays);
  /// Second pass: forces and velocities.
  KickSums (*kick)(int n, const KickTerms& terms, const InterfaceCoefficients& interface,
                   const KickCoefficients& coefficients, const StepArrays& arrays);
  /// Third pass: v = q + weight s (c - G^T A), x += dt v. With `coupled` false, v = q.
  void (*drift)(int n, const KickTerms& terms, bool coupled, const KickCoefficients& coefficients,
                const double (&c)[2], const double (&a)[2], double dt, const StepArrays& arrays);
  /// rate = far_rate (relative + near_wall (sigma/d)^exponent), d a vertex' distance to the nearest wall.
  void (*near_wall_rates)(int n, const NearWalls& walls, const NearWallDrag& drag, const StepArrays& arrays);
};

/// The kernel of the widest instruction set of this processor, or of the one that use_instruction_set() asks
/// for.
StepKernel step_kernel();

}  // namespace clog::kernel
