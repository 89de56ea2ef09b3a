#include "clog/store/run_table.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

#include "clog/core/error.hpp"
#include "draft.hpp"
#include "hdf5.hpp"
#include "run_rows.hpp"

namespace clog::store {
namespace {

using sweep::FixedText;
using sweep::RunRow;

constexpr const char* table_name = "runs";
constexpr const char* file_kind = "clogsweep sweep";
constexpr hsize_t rows_per_chunk = 64;

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

/// One column: how it is called in the file, what it means, where it is in a row.
struct Column {
  const char* name;
  const char* meaning;
  std::size_t offset;
  Type type;
};

std::vector<Column> columns() {
  std::vector<Column> all;
#define CLOG_COLUMN(field, meaning) \
  all.push_back({#field, meaning, offsetof(RunRow, field), hdf5_type<decltype(RunRow::field)>()})
  CLOG_COLUMN(task, "number of the task in its sweep");
  CLOG_COLUMN(model, "dp: deformable polygon, sp: soft disk");
  CLOG_COLUMN(line_tension, "Gamma [g rho sigma^2]; NaN for sp");
  CLOG_COLUMN(wall_stiffness, "E_w [g rho sigma^3]");
  CLOG_COLUMN(obstacle_gap, "w_ob, smallest distance between obstacle surfaces [sigma]");
  CLOG_COLUMN(obstacle_diameter, "sigma_ob [sigma]");
  CLOG_COLUMN(obstacle_diameter_spread, "diameters arrive uniform in sigma_ob (1 -+ spread)");
  CLOG_COLUMN(
      obstacle_density,
      "obstacles per sigma^2; for a saturated array the jamming limit 0.6966/(w_ob+sigma_ob)^2, NaN for "
      "a saturated mixture");
  CLOG_COLUMN(obstacle_filling, "saturated, or filled to a given density; lattice; file");
  CLOG_COLUMN(lattice_angle, "of the lattice's rows from +x to +y [degrees]; NaN unless a lattice");
  CLOG_COLUMN(box, "period of the obstacle array [sigma]");
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
  CLOG_COLUMN(mean_speed_error,
              "standard error of mean_speed from its course in this run; NaN for too short a run");
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

/// The compound type of a row in memory, with its gaps.
Type memory_type(const std::vector<Column>& all) {
  Type type(H5Tcreate(H5T_COMPOUND, sizeof(RunRow)));
  for (const Column& column : all) H5Tinsert(type, column.name, column.offset, column.type);
  return type;
}

Type disk_type(const std::vector<Column>& all) {
  Type type(H5Tcopy(memory_type(all)));
  H5Tpack(type);
  return type;
}

}  // namespace

void write_rows(hid_t file, std::span<const RunRow> rows, const std::string& path) {
  const std::vector<Column> all = columns();
  const hsize_t size = rows.size();
  const hsize_t unlimited = H5S_UNLIMITED;
  const Space space(H5Screate_simple(1, &size, &unlimited));
  const PropertyList layout(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_chunk(layout, 1, &rows_per_chunk);
  const Dataset table(H5Dcreate2(file, table_name, disk_type(all), space, H5P_DEFAULT, layout, H5P_DEFAULT));
  check(table.valid(), "create the table of runs in", path);
  for (const Column& column : all) write_attribute(table, column.name, column.meaning);
  if (!rows.empty())
    check(H5Dwrite(table, memory_type(all), H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) >= 0, "write", path);
  check(H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0, "write", path);
}

std::string library_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(release);
}

void publish_sweep(const std::string& path, std::span<const RunRow> rows, const Provenance& provenance) {
  replace_whole(path, [&](hid_t file) {
    write_rows(file, rows, path);
    write_attribute(file, "kind", file_kind);
    write_attribute(file, "format_version", format_version);
    for (const auto& [name, text] : provenance) write_attribute(file, name, text);
  });
}

namespace {

/// Columns were added in 3, those of the clog's mechanism and of the speed's error, and in 4, the ranges of
/// contact and the near-wall drag's cutoff.
constexpr std::array<std::string_view, 3> readable_versions = {"2", "3", format_version};

bool is_readable(std::string_view version) {
  return std::find(readable_versions.begin(), readable_versions.end(), version) != readable_versions.end();
}

/// Columns that the table does not have keep the values of a new row.
void read_columns(hid_t table, std::vector<RunRow>& rows, const std::string& path) {
  if (rows.empty()) return;
  const Type stored(H5Dget_type(table));
  std::vector<Column> known, missing;
  for (Column& column : columns())
    (H5Tget_member_index(stored, column.name) >= 0 ? known : missing).push_back(std::move(column));
  check(H5Dread(table, memory_type(known), H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) >= 0,
        "read the table of", path);
  const RunRow unknown;
  for (RunRow& row : rows)
    for (const Column& column : missing)
      std::memcpy(reinterpret_cast<char*>(&row) + column.offset,
                  reinterpret_cast<const char*>(&unknown) + column.offset, H5Tget_size(column.type));
}

}  // namespace

SweepFile read_sweep(const std::string& path) {
  const File file = open_file(path, H5F_ACC_RDONLY);
  if (read_attribute(file, "kind") != file_kind || H5Lexists(file, table_name, H5P_DEFAULT) <= 0)
    throw Error("cannot read " + path +
                " (an HDF5 file, but not one of clogsweep's tables of runs); give a file written "
                "by clogsweep --output");
  if (const std::string version = read_attribute(file, "format_version"); !is_readable(version))
    throw Error("cannot read " + path + " (format version " + version + ", this program reads " +
                std::string(readable_versions.front()) + " to " + format_version +
                "); use the program that wrote it");

  const Dataset table(H5Dopen2(file, table_name, H5P_DEFAULT));
  check(table.valid(), "read the table of", path);
  const Space space(H5Dget_space(table));
  SweepFile sweep;
  sweep.rows.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  read_columns(table, sweep.rows, path);
  H5O_info_t root;
  check(H5Oget_info2(file, &root, H5O_INFO_NUM_ATTRS) >= 0, "read the attributes of", path);
  for (hsize_t i = 0; i < root.num_attrs; ++i) {
    const Attribute attribute(
        H5Aopen_by_idx(file, ".", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT));
    char name[256];
    H5Aget_name(attribute, sizeof name, name);
    sweep.provenance.emplace_back(name, read_attribute(file, name));
  }
  return sweep;
}

}  // namespace clog::store
