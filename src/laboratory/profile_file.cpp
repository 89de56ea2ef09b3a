#include "clog/laboratory/profile_file.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "clog/campaign/stored_sweep.hpp"
#include "clog/console/csv.hpp"
#include "clog/console/rounded.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/laboratory/experiment.hpp"
#include "clog/store/trajectory_file.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::laboratory {
namespace {

using console::trimmed;

/// The column of a quantity, and the factor to multiply it with.
struct Column {
  std::size_t index;
  double factor;
};

/// "h [mm]" is the name h and the unit mm.
std::pair<std::string, std::string> name_and_unit(const std::string& cell) {
  const auto bracket = cell.find('[');
  if (bracket == std::string::npos) return {cell, ""};
  return {trimmed(cell.substr(0, bracket)), trimmed(cell.substr(bracket + 1, cell.find(']') - bracket - 1))};
}

double factor(const std::string& unit, const std::string& reduced, const std::string& units, double scale,
              const char* option) {
  if (unit == reduced) return 1;
  if (unit.empty())
    throw Error("a column has no unit; write " + reduced + " or a laboratory unit in brackets");
  const double in_si = si_factor(unit, units);
  if (scale == 0) throw Error("is in " + unit + " and needs " + option);
  return in_si / scale;
}

/// The columns of a length and a speed, and of the shape if the file has it.
class Columns {
 public:
  /// @param cells  of the header
  Columns(const std::string& length_name, const std::vector<std::string>& cells,
          const ProfileScales& scales) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto [name, unit] = name_and_unit(cells[i]);
      if (name == length_name)
        length_ = Column{i, factor(unit, "sigma", "length", scales.diameter, "--diameter")};
      if (name == "v") speed_ = Column{i, factor(unit, "v_t", "speed", scales.terminal_speed, "--speed")};
      if (name == "A") shape_ = Column{i, 1};
    }
    if (!length_ || !speed_)
      throw Error("needs a header that names the columns " + length_name + " and v, e.g. " + length_name +
                  " [mm], v [mm/s]");
  }

  double length(const std::vector<std::string>& cells) const { return number(cells, *length_); }
  double speed(const std::vector<std::string>& cells) const { return number(cells, *speed_); }
  /// NaN if it is not there
  double shape(const std::vector<std::string>& cells) const {
    const bool is_there = shape_ && shape_->index < cells.size() && !cells[shape_->index].empty();
    return is_there ? number(cells, *shape_) : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  static double number(const std::vector<std::string>& cells, const Column& column) {
    if (column.index >= cells.size()) throw Error("has too few columns");
    return column.factor * sweep::to_number(cells[column.index]);
  }

  std::optional<Column> length_, speed_, shape_;
};

/// @param add  called with the columns and the cells of every line
template <typename Add>
void read_lines(const std::string& path, const std::string& length_name, const ProfileScales& scales,
                Add add) {
  std::optional<Columns> columns;
  console::read_table(path, [&](const console::TableLine& line) {
    if (columns)
      add(*columns, line.cells);
    else
      columns.emplace(length_name, line.cells, scales);
  });
}

store::TrajectoryTable read_passage(const std::string& path) {
  store::TrajectoryTable table = store::read_trajectory(path);
  if (!table.is_checked)
    console::say(path + " was copied or changed by another program: damage to it may go unnoticed");
  return table;
}

/// Every sample of a simulated passage.
fit::Profile samples(const std::string& path, const store::TrajectoryTable& table) {
  try {
    const std::vector<double>& h = table.column("h");
    const std::vector<double>& speed = table.column("speed_ratio");
    const std::vector<double>& shape = table.column("shape_parameter");
    fit::Profile profile;
    for (std::size_t i = 0; i < h.size(); ++i) profile.push_back({h[i], speed[i], shape[i]});
    return profile;
  } catch (const std::out_of_range&) {
    throw Error("cannot read " + path +
                " (not a passage through a channel); give a file written by clogrun channel");
  }
}

constexpr double farthest_frame = 1.5;  // on both sides of the orifice [sigma]

fit::Profile frames_of_camera(const fit::Profile& profile) {
  constexpr int frames_per_diameter = 20;
  constexpr int last = static_cast<int>(farthest_frame * frames_per_diameter);
  fit::Profile frames;
  for (int i = -last; i <= last; ++i)
    if (const auto frame = fit::frame_at(profile, static_cast<double>(i) / frames_per_diameter))
      frames.push_back(*frame);
  return frames;
}

/// @throws Error if the droplet did not come as far as the frames go, or to the end of its channel
void refuse_unfinished(const std::string& path, const fit::Profile& profile,
                       const store::Provenance& origin) {
  const double farthest = profile.empty() ? 0 : profile.back().h;
  const double end = std::min(sweep::to_number(campaign::attribute(origin, "end_h")), farthest_frame);
  if (farthest >= end) return;
  throw Error("cannot calibrate with " + path + " (its droplet was at h = " + console::plain(farthest) +
              " when the run ended: it clogged, or was stopped); give a droplet that passed");
}

fit::Profile profile_from_csv(const std::string& path, const ProfileScales& scales) {
  fit::Profile profile;
  read_lines(path, "h", scales, [&](const Columns& columns, const std::vector<std::string>& cells) {
    profile.push_back({columns.length(cells), columns.speed(cells), columns.shape(cells)});
  });
  return profile;
}

void require_frames(const std::string& path, const fit::Profile& profile) {
  if (profile.size() < 3) throw Error(path + " holds fewer than three frames");
}

}  // namespace

fit::Profile read_profile(const std::string& path, const ProfileScales& scales) {
  fit::Profile profile =
      store::looks_like_hdf5(path) ? samples(path, read_passage(path)) : profile_from_csv(path, scales);
  require_frames(path, profile);
  return profile;
}

MeasuredProfile read_measured_profile(const std::string& path, const ProfileScales& scales) {
  MeasuredProfile measured;
  if (store::looks_like_hdf5(path)) {
    store::TrajectoryTable table = read_passage(path);
    const fit::Profile passage = samples(path, table);
    refuse_unfinished(path, passage, table.provenance);
    measured = {frames_of_camera(passage), std::move(table.provenance)};
  } else {
    measured.frames = profile_from_csv(path, scales);
  }
  require_frames(path, measured.frames);
  return measured;
}

std::vector<fit::NearWallSpeed> read_near_wall_speeds(const std::string& path, const ProfileScales& scales) {
  std::vector<fit::NearWallSpeed> speeds;
  read_lines(path, "d", scales, [&](const Columns& columns, const std::vector<std::string>& cells) {
    speeds.push_back({columns.length(cells), columns.speed(cells)});
  });
  return speeds;
}

}  // namespace clog::laboratory
