#include "clog/core/run/systems.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <utility>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/run/release.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/portable_math.hpp"
#include "clog/core/tools/units.hpp"

namespace clog {
namespace {

/// Channels and walls have no periodic images: the box is only where their coordinates live.
constexpr double open_box = 256;

/// Distance from a free droplet's centre at which a wall begins to push it.
double reach(const RunParameters& run, const Eigen::ArrayXd& droplet) {
  if (run.model == Model::sp) return units::droplet_diameter / 2;
  return droplet.head(droplet.size() / 2).maxCoeff() + run.dp.contact_range.value();
}

/// In a lattice all voids are alike, so where in one a droplet starts is up to the seed (lattice_obstacles):
/// if it touches nothing at the box's centre it starts right there, as if there were no obstacles.
bool starts_free(const RunParameters& run, const ObstacleArray& obstacles) {
  if (run.obstacles.layout != ObstacleLayout::lattice) return false;
  const double centre = obstacles.period().box / 2;
  return clearance(obstacles, centre, centre, 2 * units::droplet_diameter) > reach(run, free_droplet(run));
}

double vertex_diameter(const RunParameters& run) {
  return run.model == Model::dp ? units::regular_edge_length(run.dp.vertices) : 0;
}

/// A free droplet at rest with its centre at the given place of the open box.
DropletState state_at(Eigen::ArrayXd droplet, const Eigen::Array2d& place) {
  DropletState state;
  state.position = std::move(droplet);
  state.velocity = Eigen::ArrayXd::Zero(state.position.size());
  state.frame.period = {open_box, open_box};
  state.frame.shift(place.floor());
  state.x() += place[0] - state.frame.origin[0];
  state.y() += place[1] - state.frame.origin[1];
  return state;
}

[[noreturn]] void refuse(const char* option, double value, const std::string& reason_and_remedy) {
  std::ostringstream message;
  message << "invalid --" << option << '=' << value << " (" << reason_and_remedy;
  throw Error(message.str());
}

std::string text(double value) {
  std::ostringstream out;
  out.precision(3);
  out << value;
  return out.str();
}

double last_free_start(const ChannelParameters& channel, double reach) {
  constexpr double everywhere = std::numeric_limits<double>::infinity();
  if (channel.wedge_angle == 0) return everywhere;
  const double angle = channel.wedge_angle * std::numbers::pi / 180;
  const double last =
      ((channel.orifice / 2 + channel.tip_radius) * portable::cos(angle) - channel.tip_radius - reach) /
      portable::sin(angle);
  if (last > 0) return everywhere;
  return last;
}

void validate(const RunParameters& run, const ChannelParameters& channel, double reach) {
  const double narrowest = 2 * vertex_diameter(run);
  if (!(channel.orifice > narrowest && channel.orifice <= 20))
    refuse("orifice", channel.orifice,
           "must lie between two vertex diameters, " + text(narrowest) + ", and 20 sigma) try 0.7");
  const bool is_parallel = channel.wedge_angle == 0;
  if (!is_parallel && !(channel.wedge_angle >= 5 && channel.wedge_angle <= 85))
    refuse("wedge-angle", channel.wedge_angle,
           "degrees against the flow, must lie in 5..85, or be 0 for parallel walls) try 45");
  if (!(channel.tip_radius >= 0 && channel.tip_radius <= 10))
    refuse("tip-radius", channel.tip_radius, "must lie in 0..10 sigma) try 0.03");
  if (is_parallel && !(channel.orifice / 2 > reach))
    refuse("orifice", channel.orifice,
           "parallel walls must leave the droplet free) use more than " + text(2 * reach));
  const double last_start = last_free_start(channel, reach);
  const bool is_free = std::isinf(last_start) ? channel.start < 100 : channel.start <= last_start;
  if (!(channel.start >= -100 && is_free))
    refuse("start", channel.start,
           "the droplet must be upstream, clear of the wedges, within 100 sigma) use at most " +
               text(last_start));
  if (channel.end == ChannelParameters{}.end && channel.start >= channel.end)
    refuse("start", channel.start,
           "must lie upstream of the end, " + text(channel.end) + " by default) give --end, too");
  if (!(std::abs(channel.end) <= 100 && channel.end > channel.start))
    refuse("end", channel.end, "must lie downstream of the start and within 100 sigma of the orifice) try 3");
}

}  // namespace

double last_free_start(const RunParameters& run, const ChannelParameters& channel) {
  return last_free_start(channel, reach(run, free_droplet(run)));
}

Eigen::ArrayXd free_droplet(const RunParameters& run) {
  if (run.model == Model::sp) return Eigen::ArrayXd::Zero(2);
  const int n = run.dp.vertices;
  const double spring =
      run.dp.perimeter_spring == PerimeterSpring::rest ? run.dp.perimeter_stiffness.value() * n : 0;
  const double rest_edge = units::regular_edge_length(n);
  // K_a (a_0 - a) = T dP/da, T the tension of an edge; dP/da = P/(2a). The correction is small, so iterating
  // converges at once; a droplet that is no stiffer than its tension has no such state, and keeps half of
  // a_0.
  double area = units::rest_area;
  for (int i = 0; i < 50; ++i) {
    const double edge = units::regular_edge_length(n, area);
    const double tension = run.dp.line_tension + spring * (edge - rest_edge);
    area = std::max(units::rest_area / 2,
                    units::rest_area - tension * n * edge / (2 * area) / *run.dp.area_stiffness);
  }
  return regular_polygon(n, area);
}

DropletRun run_in_array(const RunParameters& run) {
  return run_in_array(run, std::make_shared<ObstacleArray>(sample_obstacles(run.obstacles, run.seed)));
}

DropletRun run_in_array(const RunParameters& run, std::shared_ptr<const ObstacleArray> obstacles) {
  DropletState released = starts_free(run, *obstacles)
                              ? release_droplet(run, ObstacleArray(obstacles->period(), {}))
                              : release_droplet(run, *obstacles);
  return {run, std::move(obstacles), std::move(released)};
}

DropletRun run_in_channel(const RunParameters& run, const ChannelParameters& channel) {
  Eigen::ArrayXd droplet = free_droplet(run);
  validate(run, channel, reach(run, droplet));
  const Eigen::Array2d middle{open_box / 2, open_box / 2};
  const double half_angle = std::numbers::pi / 2 - channel.wedge_angle * std::numbers::pi / 180;
  std::vector<Wedge> wedges;
  for (const double side : {-1.0, 1.0})
    wedges.push_back({.tip = middle + Eigen::Array2d(0, side * channel.orifice / 2),
                      .axis = {0, side},
                      .half_angle = half_angle,
                      .radius = channel.tip_radius});
  auto walls = std::make_shared<ObstacleArray>(open_box, std::vector<Obstacle>{}, std::move(wedges));
  return {run, std::move(walls), state_at(std::move(droplet), middle + Eigen::Array2d(channel.start, 0)),
          channel.end - channel.start};
}

DropletRun run_onto_wall(const RunParameters& run) {
  Eigen::ArrayXd droplet = free_droplet(run);
  const Eigen::Array2d middle{open_box / 2, open_box / 2};
  const Wedge wall{.tip = middle + Eigen::Array2d(reach(run, droplet), 0), .axis = {1, 0}};
  auto walls = std::make_shared<ObstacleArray>(open_box, std::vector<Obstacle>{}, std::vector<Wedge>{wall});
  return {run, std::move(walls), state_at(std::move(droplet), middle)};
}

}  // namespace clog
