#include "clog/store/trajectory_file.hpp"

#include <algorithm>
#include <cstddef>

#include "hdf5.hpp"
#include "run_rows.hpp"

namespace clog::store {
namespace {

void write_columns(hid_t file, const std::vector<TrajectoryColumn>& columns) {
  const std::size_t num_samples = columns.front().values.size();
  std::vector<double> rows;
  rows.reserve(num_samples * columns.size());
  for (std::size_t sample = 0; sample < num_samples; ++sample)
    for (const TrajectoryColumn& column : columns) rows.push_back(column.values[sample]);

  const Type type(H5Tcreate(H5T_COMPOUND, columns.size() * sizeof(double)));
  for (std::size_t i = 0; i < columns.size(); ++i)
    H5Tinsert(type, columns[i].name.c_str(), i * sizeof(double), H5T_NATIVE_DOUBLE);
  const hsize_t samples_per_chunk = std::min<hsize_t>(1024, num_samples);
  const PropertyList layout(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_chunk(layout, 1, &samples_per_chunk);  // pandas reads chunked tables only
  const Dataset table = write_dataset(file, "trajectory", type, space_of({num_samples}), rows.data(), layout);
  for (const TrajectoryColumn& column : columns) write_attribute(table, column.name, column.meaning);
}

/// Numbers of any shape.
void write_numbers(hid_t file, const char* name, std::initializer_list<hsize_t> shape,
                   const std::vector<double>& numbers, const char* meaning) {
  write_attribute(write_dataset(file, name, H5T_NATIVE_DOUBLE, space_of(shape), numbers.data()), "meaning",
                  meaning);
}

void write_polygons(hid_t file, const std::vector<PolygonFrame>& frames) {
  const hsize_t num_frames = frames.size();
  const hsize_t num_vertices = frames.front().position.size() / 2;
  std::vector<double> times;
  std::vector<double> positions;
  for (const PolygonFrame& frame : frames) {
    times.push_back(frame.time);
    positions.insert(positions.end(), frame.position.begin(), frame.position.end());
  }
  write_numbers(file, "polygon_times", {num_frames}, times, "[t0]");
  write_numbers(file, "polygons", {num_frames, 2, num_vertices}, positions,
                "vertices: frame, x or y, vertex; coordinates go on across box borders [sigma]");
}

void write_obstacles(hid_t file, const std::vector<Obstacle>& obstacles) {
  std::vector<double> values;
  for (const Obstacle& obstacle : obstacles)
    values.insert(values.end(), {obstacle.x, obstacle.y, 2 * obstacle.radius});
  write_numbers(file, "obstacles", {obstacles.size(), 3}, values,
                "along the droplet's way: x, y, diameter, in the polygons' coordinates [sigma]");
}

void write_wedges(hid_t file, const std::vector<Wedge>& wedges) {
  std::vector<double> values;
  for (const Wedge& wedge : wedges)
    values.insert(values.end(), {wedge.tip[0], wedge.tip[1], wedge.axis[0], wedge.axis[1],
                                 wedge.half_angle.radians, wedge.radius});
  write_numbers(file, "wedges", {wedges.size(), 6}, values,
                "walls: x, y of the tip [sigma], x, y of the unit vector into the wall, half angle [rad], "
                "radius of the tip [sigma]");
}

}  // namespace

void write_trajectory(const std::string& path, const Trajectory& trajectory) {
  std::size_t numbers = 3 * trajectory.obstacles.size();
  for (const TrajectoryColumn& column : trajectory.columns) numbers += column.values.size();
  for (const PolygonFrame& frame : trajectory.polygons) numbers += frame.position.size() + 1;
  require_memory_of_file("write " + path, numbers * sizeof(double));
  refuse_existing(path);
  const auto written = write_whole(OutputPath::resolve(path), "", [&](hid_t file) {
    write_columns(file, trajectory.columns);
    if (!trajectory.polygons.empty()) write_polygons(file, trajectory.polygons);
    if (!trajectory.obstacles.empty()) write_obstacles(file, trajectory.obstacles);
    if (!trajectory.wedges.empty()) write_wedges(file, trajectory.wedges);
    write_runs(file, trajectory_kind, Rows::of({&trajectory.row, 1}), trajectory.provenance);
  });
  if (!written) refuse_to_overwrite(path);
}

}  // namespace clog::store
