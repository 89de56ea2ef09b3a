#pragma once

#include <memory>

#include "clog/core/run/droplet_run.hpp"

namespace clog {

/// A droplet released in the periodic array that its parameters and seed describe.
/// @param run  resolved parameters, here and below
DropletRun run_in_array(const RunParameters& run);
/// The same in an array given otherwise, e.g. one at hand or a user's own.
DropletRun run_in_array(const RunParameters& run, std::shared_ptr<const ObstacleArray> obstacles);

/// Two wedges, tip to tip across the flow (Cheng et al., Fig. 1a). h is the distance of the centre of mass
/// from the line through the tips, positive downstream.
struct ChannelParameters {
  double orifice = 0.7;     ///< w, distance between the tips [sigma]
  double wedge_angle = 45;  ///< of the wedges' flanks against the flow direction [degrees]; 0: parallel walls
  double tip_radius = 0.03;  ///< of the wedges' rounded tips [sigma]
  double start = -10;        ///< h at release [sigma]
  double end = 3;            ///< h at which the run is over [sigma]
};
/// The largest h at which the free droplet is upstream and clear of the channel [sigma]; infinite if it
/// touches nothing anywhere.
double last_free_start(const RunParameters& run, const ChannelParameters& channel);
/// A circular droplet, at rest, on the channel's axis.
/// @throws Error if the channel is too narrow for vertices, or the droplet would touch it at the start
DropletRun run_in_channel(const RunParameters& run, const ChannelParameters& channel);

/// A circular droplet that touches a flat wall, under no weight so far: its way to rest under gravity is the
/// sag delta_s (Cheng et al., Fig. 7b).
DropletRun run_onto_wall(const RunParameters& run);

/// The droplet without walls and weight, around the origin: the regular polygon in which area pressure
/// balances line tension and springs, a little smaller than a_0 (for sp, the point).
Eigen::ArrayXd free_droplet(const RunParameters& run);

}  // namespace clog
