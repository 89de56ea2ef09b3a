#pragma once

#include <string>
#include <vector>

#include "clog/core/obstacle_array.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/run_row.hpp"

namespace clog::store {

/// One moment of a run. Columns of /trajectory.
struct TrajectorySample {
  double time;                  ///< [t0]
  double distance;              ///< along the flow since release [sigma]
  double lateral_displacement;  ///< across the flow [sigma]
  double speed;                 ///< of the centre of mass along the flow [sqrt(sigma g)]
  double kinetic_energy_ratio;  ///< E_k/E_t
  double area;                  ///< [sigma^2]
  double perimeter;             ///< [sigma]
  double shape_parameter;       ///< A
};

/// The polygon at one moment, all x then all y, in coordinates that go on across box borders [sigma].
struct PolygonFrame {
  double time;
  std::vector<double> position;
};

struct Trajectory {
  std::vector<TrajectorySample> samples;
  std::vector<PolygonFrame> polygons;  ///< may be empty; all of the same size
  std::vector<Obstacle> obstacles;     ///< along the way, in the polygons' coordinates; may be empty
  sweep::RunRow row;                   ///< what a sweep would have stored for this run
  Provenance provenance;
};

/// Writes a new file, whole or not at all. @throws Error if it exists or cannot be written
void write_trajectory(const std::string& path, const Trajectory& trajectory);

}  // namespace clog::store
