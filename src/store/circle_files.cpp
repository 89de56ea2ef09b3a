#include "circle_files.hpp"

#include <cstddef>
#include <optional>
#include <utility>

#include "file_io.hpp"

namespace clog::store {
namespace {

constexpr const char* group_name = "obstacles";

Type circle_type() {
  Type type(H5Tcreate(H5T_COMPOUND, sizeof(Obstacle)));
  H5Tinsert(type, "x", offsetof(Obstacle, x), H5T_NATIVE_DOUBLE);
  H5Tinsert(type, "y", offsetof(Obstacle, y), H5T_NATIVE_DOUBLE);
  H5Tinsert(type, "radius", offsetof(Obstacle, radius), H5T_NATIVE_DOUBLE);
  return type;
}

/// Chunks, so that other programs notice damage by the library's own checksum.
PropertyList checked_chunks(hsize_t size) {
  PropertyList properties(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_chunk(properties, 1, &size);
  H5Pset_fletcher32(properties);
  return properties;
}

void write_one(hid_t group, const CircleFile& file, const std::string& path) {
  const std::vector<Obstacle>& circles = file.circles.circles();
  const hsize_t size = circles.size();
  const Space space(H5Screate_simple(1, &size, nullptr));
  const Type type = circle_type();
  const PropertyList properties = checked_chunks(size);
  const Dataset table(
      H5Dcreate2(group, file.circles.check_sum().c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  check(table.valid() && H5Dwrite(table, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, circles.data()) >= 0,
        "write the obstacles to", path);
  write_attribute(table, "file", file.name);
  write_attribute(table, "meaning",
                  "centres and radii [sigma]; radius 0: half of the row's obstacle_diameter");
}

/// Nothing if it is not one that write_one() has written.
std::optional<CircleFile> read_one(hid_t group, const std::string& name) {
  const Dataset table(H5Dopen2(group, name.c_str(), H5P_DEFAULT));
  if (!table.valid()) return std::nullopt;
  const Type stored(H5Dget_type(table));
  const Type type = circle_type();
  const Space space(H5Dget_space(table));
  hsize_t size = 0;
  if (H5Tequal(stored, type) <= 0 || H5Sget_simple_extent_ndims(space) != 1 ||
      H5Sget_simple_extent_dims(space, &size, nullptr) != 1)
    return std::nullopt;
  constexpr hsize_t most_compressed = 1100;  // h5repack's zlib does not exceed 1032
  if (size / most_compressed > H5Dget_storage_size(table) / sizeof(Obstacle)) return std::nullopt;
  std::vector<Obstacle> circles(size);
  if (size == 0 || H5Dread(table, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, circles.data()) < 0)
    return std::nullopt;
  CircleFile file{read_attribute(table, "file"), OwnCircles(std::move(circles))};
  if (file.circles.check_sum() != name) return std::nullopt;
  return file;
}

}  // namespace

void write_circles(hid_t file, std::span<const CircleFile> circles, const std::string& path) {
  if (circles.empty()) return;
  const Group group(H5Gcreate2(file, group_name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  check(group.valid(), "create the obstacles in", path);
  for (const CircleFile& one : circles) write_one(group, one, path);
}

void read_circles(hid_t file, std::vector<CircleFile>& whole, std::vector<std::string>& damage) {
  if (H5Lexists(file, group_name, H5P_DEFAULT) <= 0) return;
  const Group group(H5Gopen2(file, group_name, H5P_DEFAULT));
  if (!group.valid()) {
    damage.emplace_back("its obstacles cannot be opened");
    return;
  }
  for (const std::string& name : names_in(group)) {
    std::optional<CircleFile> one = read_one(group, name);
    if (one)
      whole.push_back(std::move(*one));
    else
      damage.push_back("its obstacles " + name + " are not as they were written");
  }
}

}  // namespace clog::store
