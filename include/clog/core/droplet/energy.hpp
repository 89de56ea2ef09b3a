#pragma once

namespace clog {

/// Terms of a droplet's potential energy [g rho sigma^3], Cheng et al. Eqs. 1-5. A soft disk has two of them,
/// `gravity` and `wall`.
struct PotentialEnergy {
  double area = 0;          ///< changes of the area: (k_a/2)(a - a0)^2
  double spring = 0;        ///< springs of the edges: (k_l N_v/2) sum (l_i - l_ref)^2
  double line_tension = 0;  ///< sum of tension times length over the edges; gamma P unless walls are wetted
  double gravity = 0;  ///< -M g h; in a Droplet, h counts from the frame's origin, in a DropletRun from the
                       ///< place of release
  double wall = 0;     ///< contact with obstacles: (k_c/2) sum overlap^2 over edges (or vertices)
  double self_contact = 0;  ///< contact with itself: (k_c/2) sum overlap^2 over vertices and edges
  double anchors = 0;       ///< energy of the springs by which walls hold the interface

  double total() const { return area + spring + line_tension + gravity + wall + self_contact + anchors; }
};

}  // namespace clog
