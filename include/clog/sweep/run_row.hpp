#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "clog/core/parameters.hpp"
#include "clog/core/systems.hpp"

namespace clog::sweep {

/// Zero-padded text of fixed length, as HDF5 stores it. Longer text is cut.
template <std::size_t N>
struct FixedText {
  std::array<char, N> bytes{};

  FixedText& operator=(std::string_view text) {
    bytes.fill('\0');
    text.copy(bytes.data(), N);
    return *this;
  }
  std::string_view view() const {
    const std::string_view all(bytes.data(), N);
    return all.substr(0, all.find('\0'));
  }
  bool operator==(const FixedText&) const = default;
};

/// Instruction set of a run that went on from a snapshot of another one.
inline constexpr std::string_view mixed_instruction_sets = "mixed";

/// One row of the table of runs: what was run, what came out, where. Plain bytes, so that it can be sent and
/// stored as it is; the file's columns, units and meanings are listed in store/run_table.cpp.
struct RunRow {
  static constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

  std::int64_t task = -1;
  FixedText<8> model;
  double line_tension = 0;  ///< NaN for sp
  double wall_stiffness = 0;
  double obstacle_gap = 0;
  double obstacle_diameter = 0;
  double obstacle_diameter_spread = 0;
  double obstacle_density = 0;       ///< for a saturated array the jamming limit, see saturated_density()
  FixedText<16> obstacle_filling;    ///< "saturated", "density" or "lattice"
  double lattice_angle = not_known;  ///< NaN unless a lattice
  double box = 0;
  std::int64_t boxes = 1;  ///< as many as files of older versions have
  std::int64_t seed = 0;
  std::int64_t vertices = 0;  ///< 1 for sp
  double time_step = 0;
  double max_time = 0;
  double terminal_speed = 0;
  double near_wall_drag = 0;
  double near_wall_exponent = 0;
  double near_wall_cutoff = not_known;  ///< NaN for sp
  double relative_drag = 1;
  double area_stiffness = 0;  ///< NaN for sp
  FixedText<16> preset;       ///< the one that the interface's columns agree with, or "custom"
  FixedText<8> perimeter_spring;
  double perimeter_stiffness = 0;  ///< NaN for sp
  FixedText<8> wall_contact;
  double contact_range = not_known;  ///< NaN for sp
  double wall_tension = 1;           ///< NaN for sp
  FixedText<8> self_contact;
  double self_contact_range = not_known;  ///< NaN for sp
  FixedText<8> gravity;
  double clog_energy = 0;
  FixedText<16> clog_detection;
  std::int64_t model_version = 0;  ///< see parameters.hpp

  FixedText<16> status;
  FixedText<16> clogged_by;  ///< "certified" or "threshold"; "none" unless clogged
  double distance = 0;
  double lateral_displacement = 0;
  double time = 0;
  double mean_speed = not_known;
  double mean_speed_error = not_known;
  double transient = not_known;
  double travel_time = not_known;
  double kinetic_energy_ratio = 0;
  double shape_parameter = 0;
  FixedText<16> mechanism;  ///< "wrapped", "squeezed", "hybrid", "none"; empty where it is not known
  double wrapped_support = not_known;
  std::int64_t num_wrapped = -1;  ///< -1: not known
  std::int64_t num_gaps = -1;
  std::int64_t num_arcs = -1;
  std::int64_t steps = 0;

  double wall_seconds = 0;
  std::int64_t rank = 0;
  FixedText<16> instruction_set;  ///< of the polygon's step; "none" for sp; or mixed_instruction_sets
  FixedText<64> host;
  std::int64_t attempt = 1;
  FixedText<256> message;
};

/// What was run, seed included, as bytes: equal for equal runs, whatever their place in a sweep.
std::string identity(const RunRow& row);

/// Obstacles per sigma^2; NaN for a saturated mixture, whose jamming limit is not known beforehand.
double density_of(const ObstacleParameters& obstacles);
/// The columns that say what was run.
RunRow describe(const RunParameters& resolved);
/// The way back. Columns that are not known leave their parameter at its default.
/// @throws Error if one holds a word that is unknown, or a number that is out of its parameter's range
RunParameters parameters_of(const RunRow& row);
/// Fills the columns that say what came out.
void record(const RunResult& result, RunRow& row);

}  // namespace clog::sweep
