#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "clog/core/droplet/droplet_model.hpp"
#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/tools/byte_archive.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// Obstacles that a droplet has met.
struct Contacts {
  /// Number of contacts with a circle, a post of several circles, or a wedge. An obstacle counts again if the
  /// droplet was farther away than ContactRecord::parting in between. Periodic images of an obstacle count as
  /// other obstacles.
  std::int64_t number = 0;
  /// Distance of the droplet at the first contact; NaN if there was none [sigma].
  double first_distance = std::numeric_limits<double>::quiet_NaN();
};

/// Detects at the checks of a run which obstacles touch its droplet. A contact that begins and ends between
/// two checks is missed; the droplet moves only by some thousandths of its diameter between two checks.
class ContactRecord {
 public:
  /// Distance beyond which an obstacle counts as left [sigma].
  static constexpr double parting = 0.1;

  /// @param reach  see DropletModel::contact_reach
  explicit ContactRecord(const ContactReach& reach) : reach_(reach) {}

  /// Call this once per check of a run.
  /// @param release  displacement of the origin of the droplet's frame from the place of release [sigma]
  /// @param distance  displacement of the droplet along the flow since release [sigma]
  void add(const DropletState& state, const ObstacleArray& obstacles, const Eigen::Array2d& release,
           double distance);
  const Contacts& found() const { return contacts_; }

  void save(ByteWriter& bytes) const;
  /// @throws Error if save() cannot have written these bytes
  void restore(ByteReader& bytes);

 private:
  /// Place of a circle's centre or a wedge's tip, from the droplet's place of release [sigma].
  struct Place {
    double x, y;
  };
  /// An obstacle near the droplet.
  struct Seen {
    /// Distance between the surface of the obstacle and the droplet [sigma].
    double gap = std::numeric_limits<double>::infinity();
    Place nearest{0, 0};  ///< the nearest circle of the obstacle
    bool is_met = false;  ///< whether one of the obstacle's circles was in met_
  };
  ContactReach reach_;
  Contacts contacts_;
  std::vector<Place> met_;  // the nearest circle of each obstacle that the droplet has met and not left since
  // Circles near the droplet, in its frame, and their posts; valid while the droplet stays between lower_ and
  // upper_.
  std::vector<Obstacle> near_;
  std::vector<int> post_of_;
  std::size_t num_posts_ = 0;
  std::vector<Seen> seen_;
  Eigen::Array2d origin_{0, 0};
  Eigen::Array2d lower_{1, 1}, upper_{0, 0};

  void look_around(const DropletState& state, const ObstacleArray& obstacles, const Eigen::Array2d& lower,
                   const Eigen::Array2d& upper);
  /// Adds a circle, or a wedge, to the data of its obstacle, and removes it from met_.
  void include(Seen& obstacle, const Place& place, double gap);
  /// Adds the obstacle to met_ again if the droplet touches it, or has not left it since an earlier contact.
  void count(const Seen& obstacle, double distance);
};

}  // namespace clog
