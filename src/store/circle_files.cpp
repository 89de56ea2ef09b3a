#include "circle_files.hpp"

#include <cstddef>
#include <optional>
#include <utility>

namespace clog::store {
namespace {

Type circle_type() {
  Type type(H5Tcreate(H5T_COMPOUND, sizeof(Obstacle)));
  H5Tinsert(type, "x", offsetof(Obstacle, x), H5T_NATIVE_DOUBLE);
  H5Tinsert(type, "y", offsetof(Obstacle, y), H5T_NATIVE_DOUBLE);
  H5Tinsert(type, "radius", offsetof(Obstacle, radius), H5T_NATIVE_DOUBLE);
  return type;
}

void write_one(hid_t group, const CircleFile& file) {
  const std::vector<Obstacle>& circles = file.circles.circles();
  const Dataset table =
      write_dataset(group, file.circles.check_sum(), circle_type(), space_of({circles.size()}),
                    circles.data(), checked_chunks(circles.size()));
  write_attribute(table, "file", file.name);
  write_attribute(table, "meaning",
                  "centres and radii [sigma]; radius 0: half of the row's obstacle_diameter");
}

/// Reads circles. Returns nullopt if the table cannot be read, or does not have the form that write_one()
/// writes.
std::optional<CircleFile> read_one(hid_t group, const std::string& name) {
  const Dataset table(H5Dopen2(group, name.c_str(), H5P_DEFAULT));
  if (!table.valid()) return std::nullopt;
  const Type stored(H5Dget_type(table));
  const Type type = circle_type();
  const hsize_t size = length_of(table).value_or(0);
  if (H5Tequal(stored, type) <= 0 || size == 0 || !can_hold(table, size, sizeof(Obstacle)))
    return std::nullopt;
  std::vector<Obstacle> circles(size);
  if (H5Dread(table, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, circles.data()) < 0) return std::nullopt;
  CircleFile file{read_attribute(table, "file"), OwnCircles(std::move(circles))};
  if (file.circles.check_sum() != name) return std::nullopt;
  return file;
}

}  // namespace

void write_circles(hid_t file, std::span<const CircleFile> circles) {
  if (circles.empty()) return;
  const Group group(H5Gcreate2(file, circles_name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  if (!group.valid()) throw LibraryError("create the obstacles");
  for (const CircleFile& one : circles) write_one(group, one);
}

void read_circles(hid_t file, std::vector<CircleFile>& whole, std::vector<std::string>& damage) {
  if (H5Lexists(file, circles_name, H5P_DEFAULT) <= 0) return;
  const Group group(H5Gopen2(file, circles_name, H5P_DEFAULT));
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
