#include "clog/store/trajectory_file.hpp"

#include <algorithm>
#include <cstddef>

#include "file_io.hpp"
#include "hdf5.hpp"
#include "run_rows.hpp"

namespace clog::store {
namespace {

constexpr const char* trajectory_name = "trajectory";

/// Creates and fills a dataset; attributes can be added to what is returned.
Dataset write_dataset(hid_t file, const char* name, hid_t type, std::initializer_list<hsize_t> shape,
                      const void* data) {
  const Space space(H5Screate_simple(static_cast<int>(shape.size()), std::data(shape), nullptr));
  Dataset dataset(H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  check(dataset.valid() && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0 &&
            H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0,
        "write", std::string("dataset ") + name);
  return dataset;
}

void write_columns(hid_t file, const std::vector<TrajectoryColumn>& columns) {
  const std::size_t num_samples = columns.front().values.size();
  std::vector<double> rows;
  rows.reserve(num_samples * columns.size());
  for (std::size_t sample = 0; sample < num_samples; ++sample)
    for (const TrajectoryColumn& column : columns) rows.push_back(column.values[sample]);

  const Type type(H5Tcreate(H5T_COMPOUND, columns.size() * sizeof(double)));
  for (std::size_t i = 0; i < columns.size(); ++i)
    H5Tinsert(type, columns[i].name.c_str(), i * sizeof(double), H5T_NATIVE_DOUBLE);
  const hsize_t size = num_samples;
  const hsize_t samples_per_chunk = std::min<hsize_t>(1024, size);
  const Space space(H5Screate_simple(1, &size, nullptr));
  const PropertyList layout(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_chunk(layout, 1, &samples_per_chunk);  // pandas reads chunked tables only
  const Dataset table(H5Dcreate2(file, trajectory_name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT));
  check(table.valid() && H5Dwrite(table, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) >= 0 &&
            H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0,
        "write", "dataset trajectory");
  for (const TrajectoryColumn& column : columns) write_attribute(table, column.name, column.meaning);
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
  write_attribute(write_dataset(file, "polygon_times", H5T_NATIVE_DOUBLE, {num_frames}, times.data()),
                  "meaning", "[t0]");
  write_attribute(
      write_dataset(file, "polygons", H5T_NATIVE_DOUBLE, {num_frames, 2, num_vertices}, positions.data()),
      "meaning", "vertices: frame, x or y, vertex; coordinates go on across box borders [sigma]");
}

void write_obstacles(hid_t file, const std::vector<Obstacle>& obstacles) {
  std::vector<double> values;
  for (const Obstacle& obstacle : obstacles)
    values.insert(values.end(), {obstacle.x, obstacle.y, 2 * obstacle.radius});
  write_attribute(write_dataset(file, "obstacles", H5T_NATIVE_DOUBLE, {obstacles.size(), 3}, values.data()),
                  "meaning", "along the droplet's way: x, y, diameter, in the polygons' coordinates [sigma]");
}

void write_wedges(hid_t file, const std::vector<Wedge>& wedges) {
  std::vector<double> values;
  for (const Wedge& wedge : wedges)
    values.insert(values.end(), {wedge.tip[0], wedge.tip[1], wedge.axis[0], wedge.axis[1],
                                 wedge.half_angle.radians, wedge.radius});
  write_attribute(write_dataset(file, "wedges", H5T_NATIVE_DOUBLE, {wedges.size(), 6}, values.data()),
                  "meaning",
                  "walls: x, y of the tip [sigma], x, y of the unit vector into the wall, half angle [rad], "
                  "radius of the tip [sigma]");
}

}  // namespace

void write_trajectory(const std::string& path, const Trajectory& trajectory) {
  std::size_t numbers = 3 * trajectory.obstacles.size();
  for (const TrajectoryColumn& column : trajectory.columns) numbers += column.values.size();
  for (const PolygonFrame& frame : trajectory.polygons) numbers += frame.position.size() + 1;
  require_memory_of_file("write " + path, numbers * sizeof(double));
  create_whole(path, [&](hid_t file) {
    write_columns(file, trajectory.columns);
    if (!trajectory.polygons.empty()) write_polygons(file, trajectory.polygons);
    if (!trajectory.obstacles.empty()) write_obstacles(file, trajectory.obstacles);
    if (!trajectory.wedges.empty()) write_wedges(file, trajectory.wedges);
    write_runs(file, trajectory_kind, {&trajectory.row, 1}, trajectory.provenance, path);
  });
}

}  // namespace clog::store
