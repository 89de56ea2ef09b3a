#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/polygon/contact/wall_contacts.hpp"
#include "clog/core/polygon/wetting/contact_line.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// Walls with a tension that differs from that of the interface, and walls that hold the ends of wetted arcs.
/// Far from a wall the tension is Gamma. Where contact begins, it is the tension of the wetted wall. In
/// between, it changes by a smooth step, which keeps energy and force continuous. The step is so wide that
/// the edges resolve it.
class WettedWalls {
 public:
  /// @param run  resolved parameters  @param obstacles  must outlive this
  WettedWalls(const RunParameters& run, const ObstacleArray& obstacles);

  bool is_on() const { return extra_tension_ != 0 || line_.is_on(); }
  bool hold_ends() const { return line_.is_on(); }

  /// Lists of the obstacles near the vertices, see WallContacts. They are used only if walls are wetted.
  WallContacts& lists() { return lists_; }
  const WallContacts& lists() const { return lists_; }

  /// Forces on the vertices, and memory to find them. All x, then all y [g rho sigma^2].
  struct Forces {
    Eigen::ArrayXd gradient;  ///< minus the gradient of the energy
    /// If springs carry no tension (`along`), these forces cancel the component of `gradient` along the
    /// interface; otherwise they are 0. They derive from no energy.
    Eigen::ArrayXd spreading;
    std::vector<int> vertices;  ///< the vertices on which these forces may differ from 0
    ContactLine::Ends ends;     ///< ends of wetted arcs

    /// The sum of `spreading`. The reaction to these forces acts on the liquid, so this sum is subtracted
    /// from the weight that acts on the area.
    Eigen::Array2d net_spreading{0, 0};

    explicit Forces(int num_vertices);

   private:
    friend class WettedWalls;
    struct Vertex {
      double distance;        // distance from the nearest wall
      Eigen::Array2d normal;  // unit vector away from the nearest wall
      WettedShare share{0, 0};
      bool is_near = false, is_listed = false;
    };
    std::vector<Vertex> of_vertices;
    std::vector<int> near;  // vertices that walls may wet

    void clear();
    void list_vertices();
  };
  /// Finds the forces on the vertices, and the ends of wetted arcs.
  void find_forces(const VertexPlaces& vertices, const LocalFrame& frame, std::span<const WallAnchor> anchors,
                   Forces& forces) const;
  /// Moves the anchors of a moving droplet as follow() does, and then finds the forces and the ends.
  WallYield follow_and_find_forces(const VertexPlaces& vertices, const LocalFrame& frame,
                                   std::vector<WallAnchor>& anchors, Forces& forces) const;
  /// Moves anchors if the forces of their springs exceed their limits, see ContactLine::follow().
  WallYield follow(DropletState& state, Purpose purpose) const;

  /// Energy that comes from the difference of tensions, and energy of the springs that hold ends [g rho
  /// sigma^3].
  double tension_energy(const DropletState& state) const;
  double spring_energy(const DropletState& state) const;

 private:
  double extra_tension_;  // Gamma_wall - Gamma, for a wetted wall [g rho sigma^2]
  bool spreads_;          // whether springs act only along the interface
  double contact_range_, width_;
  const ObstacleArray* obstacles_;
  WallContacts lists_;
  ContactLine line_;

  void add_up(const VertexPlaces& vertices, const LocalFrame& frame, std::span<const WallAnchor> anchors,
              Forces& forces) const;
  void find_near(const VertexPlaces& vertices, const LocalFrame& frame, Forces& forces) const;
  void add_tension(const VertexPlaces& vertices, Forces& forces) const;
  void spread(const VertexPlaces& vertices, Forces& forces) const;
};

}  // namespace clog
