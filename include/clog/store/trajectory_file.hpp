#pragma once

#include <string>
#include <vector>

#include "clog/core/world/obstacle_array.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/run_row.hpp"

namespace clog::store {

/// One column of /trajectory: a number per moment.
struct TrajectoryColumn {
  std::string name;
  std::string meaning;  ///< the meaning with its unit
  std::vector<double> values;
};

/// The polygon at one moment, all x then all y, in coordinates that are continuous across box borders
/// [sigma].
struct PolygonFrame {
  double time;
  std::vector<double> position;
};

struct Trajectory {
  std::vector<TrajectoryColumn> columns;  ///< columns, all of the same size
  std::vector<PolygonFrame> polygons;     ///< polygons, all of the same size; may be empty
  std::vector<Obstacle> obstacles;  ///< obstacles near the path, in the polygons' coordinates; may be empty
  std::vector<Wedge> wedges;        ///< wedges near the path, in the same coordinates; may be empty
  sweep::RunRow row;                ///< the row that a sweep would have stored for this run
  Provenance provenance;
};

/// Writes a new file. A failure leaves no file behind. @throws Error if the file exists or cannot be written
void write_trajectory(const std::string& path, const Trajectory& trajectory);

}  // namespace clog::store
