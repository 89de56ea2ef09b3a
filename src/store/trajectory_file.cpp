#include "clog/store/trajectory_file.hpp"

#include <cstddef>

#include "hdf5.hpp"
#include "run_rows.hpp"

namespace clog::store {
namespace {

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

void write_samples(hid_t file, const std::vector<TrajectorySample>& samples) {
  struct Column {
    const char* name;
    const char* meaning;
    std::size_t offset;
  };
  const Column columns[] = {
      {"time", "[t0]", offsetof(TrajectorySample, time)},
      {"distance", "displacement of the centre of mass along the flow since release [sigma]",
       offsetof(TrajectorySample, distance)},
      {"lateral_displacement", "displacement across the flow [sigma]",
       offsetof(TrajectorySample, lateral_displacement)},
      {"speed", "of the centre of mass along the flow [sqrt(sigma g)]", offsetof(TrajectorySample, speed)},
      {"kinetic_energy_ratio", "E_k/E_t", offsetof(TrajectorySample, kinetic_energy_ratio)},
      {"area", "[sigma^2]", offsetof(TrajectorySample, area)},
      {"perimeter", "[sigma]", offsetof(TrajectorySample, perimeter)},
      {"shape_parameter", "A = perimeter^2/(4 pi area)", offsetof(TrajectorySample, shape_parameter)},
  };
  const Type type(H5Tcreate(H5T_COMPOUND, sizeof(TrajectorySample)));
  for (const Column& column : columns) H5Tinsert(type, column.name, column.offset, H5T_NATIVE_DOUBLE);
  const hsize_t size = samples.size();
  const hsize_t rows_per_chunk = 1024;
  const Space space(H5Screate_simple(1, &size, nullptr));
  const PropertyList layout(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_chunk(layout, 1, &rows_per_chunk);  // pandas reads chunked tables only
  if (size < rows_per_chunk) H5Pset_chunk(layout, 1, &size);
  const Dataset table(H5Dcreate2(file, "trajectory", type, space, H5P_DEFAULT, layout, H5P_DEFAULT));
  check(table.valid() && H5Dwrite(table, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, samples.data()) >= 0 &&
            H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0,
        "write", "dataset trajectory");
  for (const Column& column : columns) write_attribute(table, column.name, column.meaning);
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

}  // namespace

void write_trajectory(const std::string& path, const Trajectory& trajectory) {
  create_whole(path, [&](hid_t file) {
    write_samples(file, trajectory.samples);
    if (!trajectory.polygons.empty()) write_polygons(file, trajectory.polygons);
    if (!trajectory.obstacles.empty()) write_obstacles(file, trajectory.obstacles);
    write_rows(file, {&trajectory.row, 1});
    write_attribute(file, "kind", "clogsweep trajectory");
    write_attribute(file, "format_version", format_version);
    for (const auto& [name, text] : trajectory.provenance) write_attribute(file, name, text);
  });
}

}  // namespace clog::store
