#include "clog/store/trajectory_file.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/sweep/value_list.hpp"
#include "file_io.hpp"
#include "hdf5.hpp"
#include "run_rows.hpp"
#include "seal.hpp"
#include "trial_read.hpp"

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

/// Its members must be doubles, packed as they are written.
std::vector<std::string> column_names(hid_t type) {
  std::vector<std::string> names;
  const int num_members = H5Tget_class(type) == H5T_COMPOUND ? H5Tget_nmembers(type) : 0;
  for (int i = 0; i < num_members; ++i) {
    const auto index = static_cast<unsigned>(i);
    const Type member(H5Tget_member_type(type, index));
    if (H5Tequal(member, H5T_NATIVE_DOUBLE) <= 0) return {};
    names.push_back(member_name(type, index));
  }
  return names.size() * sizeof(double) == H5Tget_size(type) ? names : std::vector<std::string>();
}

/// Columns without their values.
std::vector<TrajectoryColumn> described_columns(hid_t table, hid_t type) {
  std::vector<TrajectoryColumn> columns;
  for (std::string& name : column_names(type)) {
    std::string meaning = read_attribute(table, name);
    columns.push_back({std::move(name), std::move(meaning), {}});
  }
  return columns;
}

std::vector<TrajectoryColumn> read_columns(hid_t file, const std::string& path) {
  const Dataset table(H5Dopen2(file, trajectory_name, H5P_DEFAULT));
  const Type type(table.valid() ? H5Dget_type(table) : hid_t{-1});
  std::vector<TrajectoryColumn> columns =
      type.valid() ? described_columns(table, type) : std::vector<TrajectoryColumn>();
  const Space space(table.valid() ? H5Dget_space(table) : hid_t{-1});
  const hssize_t num_samples = space.valid() ? H5Sget_simple_extent_npoints(space) : -1;
  const std::string damaged = "cannot read " + path + " (damaged: its table of the trajectory ";
  if (columns.empty() || num_samples < 0) throw Error(damaged + "is not as it was written); run it again");
  // It is not compressed.
  if (H5Dget_storage_size(table) / H5Tget_size(type) < static_cast<hsize_t>(num_samples))
    throw Error(damaged + "cannot hold " + sweep::counted(num_samples, "sample") + "); run it again");
  std::vector<double> rows(columns.size() * static_cast<std::size_t>(num_samples));
  if (H5Dread(table, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) < 0)
    throw Error(damaged + "cannot be read); run it again");
  for (std::size_t i = 0; i < rows.size(); ++i) columns[i % columns.size()].values.push_back(rows[i]);
  return columns;
}

TrajectoryTable read_image(std::vector<std::byte>& image, Seal seal, const std::string& path) {
  const File file = open_image(image, path);
  if (read_attribute(file, "kind") != trajectory_kind || H5Lexists(file, trajectory_name, H5P_DEFAULT) <= 0)
    throw Error("cannot read " + path +
                " (an HDF5 file, but not a trajectory); give a file written by clogrun --output");
  require_readable_version(file, path);
  return {read_columns(file, path), read_attributes(file, path), seal == Seal::whole};
}

}  // namespace

const std::vector<double>& TrajectoryTable::column(const std::string& name) const {
  const auto found = std::ranges::find(columns, name, &TrajectoryColumn::name);
  if (found == columns.end()) throw std::out_of_range("the trajectory has no column " + name);
  return found->values;
}

TrajectoryTable read_trajectory(const std::string& path) {
  std::vector<std::byte> image = read_file(path);
  const Seal seal = look_at_seal(image);
  if (seal == Seal::broken)
    throw Error("cannot trust " + path + " (damaged: its checksum is not that of its bytes); run it again");
  if (seal == Seal::missing) try_in_child(image, path, [&] { read_image(image, seal, path); });
  return read_image(image, seal, path);
}

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
