#include "row_layout.hpp"

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

namespace clog::store {

using sweep::FixedText;
using sweep::RunRow;

namespace {

template <class T>
struct IsFixedText : std::false_type {};
template <std::size_t N>
struct IsFixedText<FixedText<N>> : std::true_type {};

template <class T>
Type hdf5_type() {
  if constexpr (std::is_same_v<T, double>)
    return Type(H5Tcopy(H5T_NATIVE_DOUBLE));
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return Type(H5Tcopy(H5T_NATIVE_INT64));
  else {
    static_assert(IsFixedText<T>::value);
    return text_type(sizeof(T));
  }
}

template <class T>
Column column(const char* name, const char* meaning, std::size_t offset) {
  return {name, meaning, offset, sizeof(T), hdf5_type<T>()};
}

std::vector<Column> columns() {
  std::vector<Column> all;
#define CLOG_COLUMN(field, meaning) \
  all.push_back(column<decltype(RunRow::field)>(#field, meaning, offsetof(RunRow, field)))
  CLOG_COLUMN(task, "number of the task in its sweep");
  CLOG_COLUMN(model, "dp: deformable polygon, sp: soft disk");
  CLOG_COLUMN(line_tension, "Gamma [g rho sigma^2]; NaN for sp");
  CLOG_COLUMN(wall_stiffness, "E_w [g rho sigma^3]");
  CLOG_COLUMN(obstacle_gap, "w_ob, smallest distance between obstacle surfaces [sigma]");
  CLOG_COLUMN(obstacle_diameter, "sigma_ob [sigma]");
  CLOG_COLUMN(obstacle_diameter_spread, "diameters arrive uniform in sigma_ob (1 -+ spread)");
  CLOG_COLUMN(obstacle_density,
              "obstacles per area [1/sigma^2]; for a saturated array the jamming limit "
              "0.6966/(w_ob+sigma_ob)^2, NaN for "
              "a saturated mixture");
  CLOG_COLUMN(obstacle_filling, "saturated, or filled to a given density; lattice; file");
  CLOG_COLUMN(lattice_angle, "of the lattice's rows from +x to +y [degrees]; NaN unless a lattice");
  CLOG_COLUMN(box, "period of the obstacle array across the flow [sigma]");
  CLOG_COLUMN(boxes, "period along the flow over that across it");
  CLOG_COLUMN(seed, "seed of obstacle array and release");
  CLOG_COLUMN(vertices, "N_v of the polygon; 1 for sp");
  CLOG_COLUMN(time_step, "[t0]");
  CLOG_COLUMN(max_time, "time at which a run that did not clog ends [t0]");
  CLOG_COLUMN(terminal_speed, "V_t [sqrt(sigma g)]");
  CLOG_COLUMN(near_wall_drag, "b_0/b_inf");
  CLOG_COLUMN(near_wall_exponent, "alpha of the near-wall drag; NaN for sp");
  CLOG_COLUMN(near_wall_cutoff, "distances of the near-wall drag count as no less [sigma]; NaN for sp");
  CLOG_COLUMN(relative_drag, "c, drag of motion relative to the centre of mass over b_inf");
  CLOG_COLUMN(area_stiffness, "K_a [g rho/sigma]; NaN for sp");
  CLOG_COLUMN(preset, "name of the set of interface keys that was used, or custom");
  CLOG_COLUMN(perimeter_spring,
              "springs pull edges to their rest length, to the mean length, or along the interface only");
  CLOG_COLUMN(perimeter_stiffness, "K_l [g rho sigma]; NaN for sp");
  CLOG_COLUMN(wall_contact, "a wall pushes edges or vertices");
  CLOG_COLUMN(contact_range, "distance from a wall at which contact begins [sigma]; NaN for sp");
  CLOG_COLUMN(wall_tension, "tension at walls over Gamma, -cos of the contact angle; NaN for sp");
  CLOG_COLUMN(self_contact, "does the interface repel itself");
  CLOG_COLUMN(self_contact_range, "distance below which the interface repels itself [sigma]; NaN for sp");
  CLOG_COLUMN(gravity, "the weight acts on the vertices or on the area");
  CLOG_COLUMN(clog_energy, "clogged when E_k/E_t stays below this");
  CLOG_COLUMN(clog_detection,
              "certified: also by a proved equilibrium at hand; threshold: by clog_energy only");
  CLOG_COLUMN(model_version, "runs of different versions differ though their parameters agree");
  CLOG_COLUMN(status,
              "clogged; flowing: max_time reached; running, interrupted: so far; failed: see message");
  CLOG_COLUMN(clogged_by, "certified (distance and shape_parameter are those at rest), threshold; none");
  CLOG_COLUMN(distance, "displacement of the centre of mass along the flow since release [sigma]");
  CLOG_COLUMN(lateral_displacement, "displacement across the flow [sigma]");
  CLOG_COLUMN(time, "time since release [t0]");
  CLOG_COLUMN(
      mean_speed,
      "way over time after the transient and before the arrest [sqrt(sigma g)]; NaN if it moved less than "
      "half a diameter in that time, or the transient was not over in half the run");
  CLOG_COLUMN(
      mean_speed_error,
      "standard error of mean_speed from its course in this run [sqrt(sigma g)]; NaN for too short a run");
  CLOG_COLUMN(transient, "time at which the transient ends [t0]");
  CLOG_COLUMN(travel_time, "time that mean_speed is taken over [t0]");
  CLOG_COLUMN(kinetic_energy_ratio, "E_k/E_t at the end; E_t: kinetic energy at terminal speed");
  CLOG_COLUMN(shape_parameter, "A = perimeter^2/(4 pi area) at the end; 1 for a circle");
  CLOG_COLUMN(mechanism,
              "wrapped around obstacles, squeezed in gaps, hybrid; none unless clogged, empty: not known");
  CLOG_COLUMN(
      wrapped_support,
      "part of the support against the flow that wrapped obstacles give; NaN unless a clogged polygon");
  CLOG_COLUMN(num_wrapped, "touched obstacles that the clogged polygon hangs over; -1: not known");
  CLOG_COLUMN(num_gaps, "gaps between supporting obstacles that it looks into; -1: not known");
  CLOG_COLUMN(num_arcs, "arcs of contact; -1: not known");
  CLOG_COLUMN(steps, "integrated steps");
  CLOG_COLUMN(wall_seconds, "time spent on the run [s]");
  CLOG_COLUMN(rank, "MPI rank that did the run");
  CLOG_COLUMN(instruction_set,
              "instruction set of the polygon's step, or none; mixed: it went on under another one");
  CLOG_COLUMN(host, "host of that rank");
  CLOG_COLUMN(attempt, "1 for the first try");
  CLOG_COLUMN(message, "why the run failed");
#undef CLOG_COLUMN
  return all;
}

/// Those that a stored row has, in its order; none for names that are not ours.
std::vector<Column> columns_of(hid_t stored) {
  std::vector<Column> all = columns();
  std::vector<Column> found;
  const int num_members = H5Tget_nmembers(stored);
  for (int i = 0; i < num_members; ++i) {
    const std::string name = member_name(stored, static_cast<unsigned>(i));
    for (Column& column : all)
      if (column.name == name && column.type.valid()) found.push_back(std::move(column));
  }
  return found;
}

}  // namespace

RowLayout::RowLayout(std::vector<Column> columns) : columns_(std::move(columns)) {
  for (const Column& column : columns_) size_ += column.size;
  type_ = Type(H5Tcreate(H5T_COMPOUND, size_));
  std::size_t place = 0;
  for (const Column& column : columns_) {
    H5Tinsert(type_, column.name.c_str(), place, column.type);
    place += column.size;
  }
}

RowLayout RowLayout::present() { return RowLayout(columns()); }

std::optional<RowLayout> RowLayout::of(hid_t stored, Columns expected) {
  if (H5Tget_class(stored) != H5T_COMPOUND) return std::nullopt;
  std::vector<Column> found = columns_of(stored);
  if (found.empty() || (expected == Columns::all && found.size() < columns().size())) return std::nullopt;
  RowLayout layout(std::move(found));
  if (H5Tequal(layout.type_, stored) <= 0) return std::nullopt;
  return layout;
}

void RowLayout::describe(hid_t table) const {
  for (const Column& column : columns_) write_attribute(table, column.name, column.meaning);
}

void RowLayout::pack(const RunRow& row, std::byte* packed) const {
  for (const Column& column : columns_) {
    std::memcpy(packed, reinterpret_cast<const std::byte*>(&row) + column.offset, column.size);
    packed += column.size;
  }
}

RunRow RowLayout::unpack(const std::byte* packed) const {
  RunRow row;
  for (const Column& column : columns_) {
    std::memcpy(reinterpret_cast<std::byte*>(&row) + column.offset, packed, column.size);
    packed += column.size;
  }
  return row;
}

}  // namespace clog::store
