#include <fmt/core.h>
#include "clog/core/droplet/release.hpp"
#include "clog/core/model/model.hpp"
#include "core/parameters/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/portable_math.hpp"
#include "clog/core/tools/units.hpp"
#include "core/scene/open_box.hpp"

namespace clog {

namespace {

/// The largest h at which the free droplet is upstream of the channel and touches nothing [sigma]; infinite
/// if the droplet never touches the channel.
/// @param run  resolved
double last_free_start(const RunParameters& run) {
  const ChannelParameters& channel = run.channel;
  const double droplet_reach = model_of(run).reach(run);
  constexpr double everywhere = std::numeric_limits<double>::infinity();
  if (channel.wedge_angle == 0) return everywhere;
  const double angle = channel.wedge_angle * std::numbers::pi / 180;
  const double last = ((channel.orifice / 2 + channel.tip_radius) * portable::cos(angle) -
                       channel.tip_radius - droplet_reach) /
                      portable::sin(angle);
  if (last > 0) return everywhere;
  return last;
}

void check_no_obstacles(const RunParameters&) {}

void check_clearance(RunParameters& run) {
  const ChannelParameters& channel = run.channel;
  const double droplet_reach = model_of(run).reach(run);
  const double narrowest = 2 * model_of(run).narrowest(run);
  if (!(channel.orifice > narrowest))
    refuse("orifice", channel.orifice,
           fmt::format("not wider than two vertex diameters, {:.3g} sigma) try 0.7", narrowest));
  const bool is_parallel = channel.wedge_angle == 0;
  if (!is_parallel && !(channel.wedge_angle >= 5))
    refuse("wedge-angle", channel.wedge_angle,
           "the wedges would be too slender to be met) use 5..85 degrees, or 0 for parallel walls");
  if (is_parallel && !(channel.orifice / 2 > droplet_reach))
    refuse(
        "orifice", channel.orifice,
        fmt::format("parallel walls must leave the droplet free) use more than {:.3g}", 2 * droplet_reach));
  const double last_start = last_free_start(run);
  const bool is_free = std::isinf(last_start) ? channel.start < 100 : channel.start <= last_start;
  if (!is_free)
    refuse("start", channel.start,
           fmt::format("the droplet must be upstream, clear of the wedges) use at most {:.3g}", last_start));
  if (channel.end == ChannelParameters{}.end && channel.start >= channel.end)
    refuse("start", channel.start,
           fmt::format("must lie upstream of the end, {:.3g} by default) give end, too", channel.end));
  if (!(channel.end > channel.start)) refuse("end", channel.end, "must lie downstream of the start) try 3");
}

/// Diameter of the sharpest bend of the interface, around the tips.
double tip_diameter(const RunParameters& run) {
  constexpr double sharpest = 1e-3;
  return std::max(2 * run.channel.tip_radius, sharpest);
}

ObstacleArray wedges(const RunParameters& run) {
  const ChannelParameters& channel = run.channel;
  const double half_angle = std::numbers::pi / 2 - channel.wedge_angle * std::numbers::pi / 180;
  std::vector<Wedge> both;
  for (const double side : {-1.0, 1.0})
    both.push_back({.tip = middle_of_open_box() + Eigen::Array2d(0, side * channel.orifice / 2),
                    .axis = {0, side},
                    .half_angle = half_angle,
                    .radius = channel.tip_radius});
  return {open_box, {}, std::move(both)};
}

/// Releases the droplet on the channel's axis.
DropletState release_upstream(const RunParameters& run, const ObstacleArray&) {
  return state_at_rest(model_of(run).free_shape(run),
                       middle_of_open_box() + Eigen::Array2d(run.channel.start, 0), period_of_open_box());
}

double distance_to_end(const RunParameters& run, const Eigen::Array2d&) {
  return run.channel.end - run.channel.start;
}

}  // namespace

const Scene channel_scene = {.finding = Finding::passage,
                             .walls_from = WallsFrom::droplet,
                             .is_random = false,
                             .gap_key = "orifice",
                             .check = check_no_obstacles,
                             .resolve = check_clearance,
                             .sharpest_bend = tip_diameter,
                             .density = no_density,
                             .walls = wedges,
                             .release = release_upstream,
                             .passing_distance = distance_to_end};

}  // namespace clog
