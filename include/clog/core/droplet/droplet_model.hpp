#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>

#include "clog/core/droplet/droplet.hpp"
#include "clog/core/droplet/equilibrium.hpp"
#include "clog/core/droplet/hold.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

inline constexpr double no_neck = std::numeric_limits<double>::infinity();

/// The points of a droplet that walls push, and the distance at which they begin to push.
struct ContactReach {
  double range;   ///< distance from a wall's surface at which contact begins [sigma]
  bool by_edges;  ///< whether walls push edges as well as the points that move
};

/// The operations and properties of a droplet model; there is one object for each Model. A new model needs an
/// enumerator of Model, a folder beside `polygon` and `disk` that defines its DropletModel, a line in
/// model.cpp, and the steps of docs/developer/add-a-model.md.
struct DropletModel {
  /// Key of the parameter that is the droplet's stiffness.
  const char* stiffness_key;

  /// Chooses the number of moving points, unless the user has given this number.
  /// @param obstacle_diameter  diameter of the smallest obstacle over which the droplet can hang; infinite if
  /// there is none [sigma]
  void (*choose_points)(RunParameters& run, double obstacle_diameter);
  /// Width of the narrowest passage that the droplet's points resolve [sigma].
  double (*narrowest)(const RunParameters& run);
  /// Computes the automatic values. Refuses given values that contradict the automatic ones.
  /// @param sharpest_bend  see Scene
  /// @throws Error
  void (*resolve)(RunParameters& run, double sharpest_bend);

  // The functions from here on take resolved parameters.
  /// Number of moving points.
  int (*num_points)(const RunParameters& run);
  /// The droplet without walls and weight, around the origin: all x, then all y [sigma].
  Eigen::ArrayXd (*free_shape)(const RunParameters& run);
  /// Distance from the centre of a free droplet at which a wall begins to push the droplet [sigma].
  double (*reach)(const RunParameters& run);
  ContactReach (*contact_reach)(const RunParameters& run);
  /// A droplet at rest, without weight, near the centre of the box.
  /// @throws Error if there is no room for the droplet, or if it does not come to rest
  DropletState (*release)(const RunParameters& run, const ObstacleArray& obstacles);
  /// Largest energy that a droplet may have at its release, minus the energy of a free droplet [g rho
  /// sigma^3].
  double (*most_energy_at_release)(const RunParameters& run);
  /// A moving droplet. The obstacles must outlive this droplet.
  std::unique_ptr<Droplet> (*make)(const RunParameters& run, const ObstacleArray& obstacles,
                                   DropletState initial);
  /// The equilibrium that the droplet approaches, see find_equilibrium().
  std::optional<DropletState> (*equilibrium)(const RunParameters& run, const ObstacleArray& obstacles,
                                             const DropletState& state);
  /// The stability of a droplet that has stopped, see stability_of().
  Stability (*stability)(const RunParameters& run, const ObstacleArray& obstacles, const DropletState& state);
  /// The mechanism that holds a clogged droplet.
  Hold (*hold)(const RunParameters& run, const ObstacleArray& obstacles, const DropletState& state);
  /// Width of the droplet's thinnest neck; no_neck if none is narrower than `below` [sigma].
  double (*neck)(const DropletState& state, double below);
};

extern const DropletModel deformable_polygon, soft_disk;

}  // namespace clog
