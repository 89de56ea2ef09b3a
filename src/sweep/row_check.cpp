#include "clog/sweep/row_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numbers>
#include <string_view>

#include "clog/core/droplet/droplet.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/parameters/schema.hpp"
#include "clog/core/polygon/forces/stability.hpp"
#include "clog/core/run/dwell_record.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::sweep {
namespace {

/// Round-off of a sum of time steps, and of a polygon's perimeter and area.
constexpr double round_off = 1e-9;

/// The largest shape parameter of a polygon that has neither burst nor lost its area.
constexpr double most_shape =
    burst_perimeter * burst_perimeter / (4 * std::numbers::pi * units::rest_area * (1 - diverged_area_error));

/// No run takes longer than a hundred years [s].
constexpr double longest_patience = 3.2e9;

/// Largest number of obstacles, gaps or arcs of a droplet.
constexpr std::int64_t most_contacts = 1'000'000;

/// Largest fraction of the weight that corners may hold, x^2/16. The bound assumes an edge as long as the
/// droplet, on an obstacle as thin as a needle.
constexpr double most_mesh_hold = 1e6;

/// Friction may hold droplets that have almost come to rest with slightly more than its limit.
constexpr double most_friction_use = 1 + 1e-6;

bool is_number_below(double value, double bound) { return std::isfinite(value) && std::abs(value) <= bound; }

std::string named(std::string_view column, double value) {
  return fmt::format("{}={}", column, shortest(value));
}
std::string named(std::string_view column, std::string_view word) {
  return fmt::format("{}='{}'", column, word);
}

/// Checks the parameters by the rules of this program's model.
std::string parameter_fault(const RunRow& row) {
  const RunParameters& run = row.parameters;
  for (const auto& [name, value] : {std::pair{"time_step", run.time_step.value_or(RunRow::not_known)},
                                    {"max_time", run.max_time},
                                    {"terminal_speed", run.drag.terminal_speed},
                                    {"wall_stiffness", run.wall_stiffness.value_or(RunRow::not_known)}})
    if (!(std::isfinite(value) && value > 0)) return named(name, value) + " is not positive";
  if (row.model_version != model_version) return "";
  if (!row.unknown_parameters.empty())
    return std::string((*row.unknown_parameters.begin())->column) + " is not known";
  try {
    const Scene& scene = scene_of(run);
    if (scene.walls_from == WallsFrom::circles) {
      check_each(run);  // the row has only the checksum of its circles
      return "";
    }
    const double density = scene.density(resolve(run).obstacles);
    const bool agrees = is_known(density) ? std::abs(row.obstacle_density - density) <= round_off * density
                                          : !is_known(row.obstacle_density);
    return agrees ? "" : named("obstacle_density", row.obstacle_density) + " is not that of its array";
  } catch (const Error& error) {
    return error.what();
  }
}

std::string bookkeeping_fault(const RunRow& row) {
  if (row.task < 0) return "a negative task";
  if (row.rank < 0) return "a negative rank";
  if (row.attempt < 1) return "an attempt before the first";
  if (row.model_version < 1) return fmt::format("model_version={} is none", row.model_version);
  if (!(row.wall_seconds >= 0 && row.wall_seconds <= longest_patience))
    return named("wall_seconds", row.wall_seconds) + " is no time";
  if (is_known(row.processor_seconds) &&
      !(row.processor_seconds >= 0 && row.processor_seconds <= longest_patience))
    return named("processor_seconds", row.processor_seconds) + " is no time";
  return "";
}

double time_step_of(const RunRow& row) { return row.parameters.time_step.value(); }

std::string duration_fault(const RunRow& row) {
  if (row.time >= 0 && row.time <= (1 + round_off) * row.parameters.max_time + time_step_of(row)) return "";
  return named("time", row.time) + " is not between 0 and " + named("max_time", row.parameters.max_time);
}

/// Checks that the run ended after a whole number of steps.
std::string time_fault(const RunRow& row) {
  if (std::string fault = duration_fault(row); !fault.empty()) return fault;
  if (row.status == RunStatus::flowing &&
      row.time < (1 - round_off) * row.parameters.max_time - time_step_of(row))
    return "flowing, but " + named("time", row.time) + " is before " +
           named("max_time", row.parameters.max_time);
  const double steps = row.time / time_step_of(row);
  const auto integrated = static_cast<double>(row.steps);
  if (!(integrated >= (1 - round_off) * steps - 0.5 &&
        integrated <= most_substeps * ((1 + round_off) * steps + 0.5)))
    return fmt::format("{} steps do not make {}", row.steps, named("time", row.time));
  return "";
}

std::string motion_fault(const RunRow& row) {
  const double farthest = farthest_distance(row);
  if (!is_number_below(std::hypot(row.distance, row.lateral), farthest))
    return fmt::format("{}, {}: no droplet gets farther than {} in {}", named("distance", row.distance),
                       named("lateral_displacement", row.lateral), shortest(farthest),
                       named("time", row.time));
  const double slightly_more = (1 + round_off) * row.time;
  if (is_known(row.speed.transient) && !(row.speed.transient >= 0 && row.speed.transient <= slightly_more))
    return named("transient", row.speed.transient) + " is not within the run";
  if (is_known(row.speed.time) && !(row.speed.time > 0 && row.speed.time <= slightly_more))
    return named("travel_time", row.speed.time) + " is not within the run";
  // Older files do not contain the time over which the speed was averaged; it was at least one step.
  const double travel_time = is_known(row.speed.time) ? row.speed.time : time_step_of(row);
  if (is_known(row.speed.mean) && !is_number_below(row.speed.mean * travel_time, 2 * farthest))
    return named("mean_speed", row.speed.mean) + " is faster than a droplet can be";
  const double fastest = std::sqrt(diverged_energy_ratio) * row.parameters.drag.terminal_speed;
  if (is_known(row.speed.error) && !(row.speed.error >= 0 && row.speed.error <= fastest))
    return named("mean_speed_error", row.speed.error) + " is no error";
  return "";
}

/// Checks the travel from the fixed time at which the steady speed begins. Older files do not contain this
/// travel.
std::string steady_fault(const RunRow& row) {
  const auto [distance, time] = row.steady;
  if (is_known(distance) != is_known(time)) return "steady_distance, steady_time: only one is known";
  if (!is_known(time)) return "";
  const double longest = row.time - SteadyRecord::free_fall / row.parameters.drag.terminal_speed;
  if (!(time > 0 && time <= longest + round_off * row.time))
    return named("steady_time", time) + " is not within the run";
  // When the steady speed began, the droplet may have been upstream or downstream of its release.
  if (!is_number_below(distance, 2 * farthest_distance(row)))
    return named("steady_distance", distance) + " is not on the droplet's way";
  return "";
}

/// Checks that a dwell begins within the path and the time of the run.
std::string dwell_begin_fault(const RunRow& row, const std::string& column, double distance, double begin) {
  if (distance < 0 || distance > farthest_distance(row))
    return named(column + "_at", distance) + " is not on the droplet's way";
  if (begin < 0 || begin > (1 + round_off) * row.time)
    return named(column + "_from", begin) + " is not within the run";
  return "";
}

/// @param next  the next longer dwell; the run's end if no dwell was longer
std::string dwell_fault(const RunRow& row, const std::string& column, const Dwell& dwell, const Dwell& next) {
  if (std::string fault = dwell_begin_fault(row, column, dwell.distance, dwell.begin); !fault.empty())
    return fault;
  if (!(dwell.length > row.dwells.known_from && dwell.length < next.length))
    return named(column, dwell.length) + " is not among those that are kept";
  if (!(dwell.distance <= next.distance && dwell.begin + dwell.length <= (1 + round_off) * next.begin))
    return named(column, dwell.length) + " does not end before what comes next";
  return "";
}

std::string dwells_fault(const RunRow& row) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Dwells& dwells = row.dwells;
  const bool are_known = is_known(dwells.known_from);
  if (is_known(dwells.last_distance) != are_known || is_known(dwells.last_begin) != are_known)
    return "dwells_known_from, last_dwell_at, last_dwell_from: only some are known";
  // A run that ended before this time cannot have a recorded dwell.
  const RunParameters& run = row.parameters;
  const double first = DwellRecord::shortest * run.dwell_length / run.drag.terminal_speed;
  if (are_known &&
      !(dwells.known_from > 0 && dwells.known_from <= (1 + round_off) * std::max(first, row.time)))
    return named("dwells_known_from", dwells.known_from) + " is no time";
  if (std::string fault = dwell_begin_fault(row, "last_dwell", dwells.last_distance, dwells.last_begin);
      !fault.empty())
    return fault;
  Dwell next = {.length = infinity, .distance = infinity, .begin = row.time};
  for (std::size_t i = 0; i < Dwells::most; ++i) {
    const Dwell& dwell = dwells.longest[i];
    if (!is_known(dwell.length) && !is_known(dwell.distance) && !is_known(dwell.begin)) {
      next.length = -infinity;  // the file lists fewer dwells, so all later entries must be empty, too
      continue;
    }
    if (std::string fault = dwell_fault(row, dwell_column(i), dwell, next); !fault.empty()) return fault;
    next = dwell;
  }
  return "";
}

/// Checks the values that readers also use if the run failed.
std::string soundness_fault(const RunRow& row) {
  if (row.failed_by && (*row.failed_by != FailedBy::none) != (row.status == RunStatus::failed))
    return named("failed_by", name(*row.failed_by)) + ", but " + named("status", name(row.status));
  if (is_known(row.sound_distance) && !is_number_below(row.sound_distance, farthest_distance(row)))
    return named("sound_distance", row.sound_distance) + " is not on the droplet's way";
  if (row.status == RunStatus::failed && !is_number_below(*observed_distance(row), farthest_distance(row)))
    return named("distance", row.distance) + " is not on the droplet's way";
  if (row.healed_crossings < RunRow::not_counted) return "a negative number of healed crossings";
  return "";
}

/// Checks the shape of a droplet that has moved. Before it moves, its shape is unknown.
std::string shape_fault(const RunRow& row) {
  if (row.steps == 0) return "";
  if (!(row.kinetic_energy_ratio >= 0 && row.kinetic_energy_ratio < diverged_energy_ratio))
    return named("kinetic_energy_ratio", row.kinetic_energy_ratio) + " is that of no run that is whole";
  if (!(row.shape_parameter >= 1 - round_off && row.shape_parameter < most_shape))
    return named("shape_parameter", row.shape_parameter) + " is that of no droplet";
  return "";
}

std::string contacts_fault(const RunRow& row) {
  const std::int64_t contacts = is_known(row.contacts.number) ? row.contacts.number : 0;
  if (contacts < 0) return "a negative number of contacts";
  if (is_known(row.contacts.first_distance) != (contacts > 0))
    return fmt::format("{}, but contacts={}", named("first_contact_at", row.contacts.first_distance),
                       contacts);
  if (is_known(row.contacts.first_distance) &&
      !is_number_below(row.contacts.first_distance, farthest_distance(row)))
    return named("first_contact_at", row.contacts.first_distance) + " is not on the droplet's way";
  return "";
}

std::string clog_fault(const RunRow& row) {
  const bool is_clogged = row.status == RunStatus::clogged;
  if (row.clogged_by) {
    const std::string by = named("clogged_by", name(*row.clogged_by));
    if (is_clogged != (row.clogged_by != FoundBy::not_clogged))
      return is_clogged ? "clogged, but " + by : by + ", but it is not clogged";
    if (row.clogged_by == FoundBy::certified && row.parameters.clog_detection == ClogDetection::threshold)
      return by + ", but clog_detection='threshold'";
    if (row.clogged_by == FoundBy::threshold && row.kinetic_energy_ratio >= row.parameters.clog_energy)
      return by + ", but " + named("kinetic_energy_ratio", row.kinetic_energy_ratio);
  }
  if (row.stability) {
    const bool is_held = row.stability == Stability::stable || row.stability == Stability::unknown;
    if (is_clogged != is_held || (!is_clogged && row.stability != Stability::none))
      return named("stability", name(*row.stability)) + ", but " + named("status", name(row.status));
    if (row.clogged_by == FoundBy::certified && row.stability != Stability::stable)
      return "certified, but " + named("stability", name(*row.stability));
  }
  if (!is_clogged && row.hold.mechanism.value_or(ClogMechanism::none) != ClogMechanism::none)
    return named("mechanism", name(*row.hold.mechanism)) + ", but it is not clogged";
  if (is_known(row.hold.geometry.wrapped_support) && !(is_clogged && row.hold.geometry.wrapped_support >= 0 &&
                                                       row.hold.geometry.wrapped_support <= 1 + round_off))
    return named("wrapped_support", row.hold.geometry.wrapped_support) + " is no share of a clog's support";
  if (is_known(row.hold.geometry.mesh_hold) &&
      !(is_clogged && row.hold.geometry.mesh_hold >= 0 && row.hold.geometry.mesh_hold <= most_mesh_hold))
    return named("mesh_hold", row.hold.geometry.mesh_hold) + " is no part of a clogged droplet's weight";
  if (is_known(row.hold.friction_use) &&
      !(is_clogged && row.hold.friction_use >= 0 && row.hold.friction_use <= most_friction_use))
    return named("friction_use", row.hold.friction_use) + " is no fraction of what friction can bear";
  const auto [fewest, most] =
      std::minmax({row.hold.geometry.num_wrapped, row.hold.geometry.num_gaps, row.hold.geometry.num_arcs});
  if (fewest < RunRow::not_counted) return "a negative number of contacts";
  if (most > most_contacts) return fmt::format("{} contacts are more than a droplet has", most);
  return "";
}

/// Checks the results that exist only in a channel or on a wall.
std::string passage_fault(const RunRow& row) {
  const Finding finding = scene_of(row.parameters).finding;
  const double fastest = std::sqrt(diverged_energy_ratio);
  const double way = std::abs(row.parameters.channel.start) + farthest_distance(row);
  struct Place {
    const char* column;
    double value;
    Finding finding;
    double least, most;
  };
  using enum Finding;
  for (const Place& place :
       {Place{"largest_shape_parameter", row.passage.largest_shape_parameter.value, passage, 1 - round_off,
              most_shape},
        Place{"largest_shape_parameter_at", row.passage.largest_shape_parameter.place, passage, -way, way},
        Place{"largest_relative_speed", row.passage.largest_speed.value, passage, -fastest, fastest},
        Place{"largest_relative_speed_at", row.passage.largest_speed.place, passage, -way, way},
        Place{"smallest_relative_speed", row.passage.smallest_speed.value, passage, -fastest, fastest},
        Place{"smallest_relative_speed_at", row.passage.smallest_speed.place, passage, -way, way},
        Place{"sag", row.sag.centre, Finding::sag, -units::droplet_diameter, farthest_distance(row)},
        Place{"top_sag", row.sag.top, Finding::sag, -units::droplet_diameter, farthest_distance(row)}}) {
    if (!is_known(place.value)) continue;
    if (finding != place.finding)
      return named(place.column, place.value) + ", but there is no " +
             (place.finding == passage ? "channel" : "wall");
    if (!(place.value >= place.least && place.value <= place.most))
      return named(place.column, place.value) + " is that of no droplet";
  }
  if (row.passage.smallest_speed.value > row.passage.largest_speed.value)
    return named("smallest_relative_speed", row.passage.smallest_speed.value) + " is above " +
           named("largest_relative_speed", row.passage.largest_speed.value);
  return "";
}

/// Checks that a broken droplet has a neck thinner than break-up-neck. No other droplet may have such a neck,
/// except the ancestor of a family that is still in progress.
std::string neck_fault(const RunRow& row) {
  const double width = row.neck.width, least = row.parameters.dp.break_up_neck;
  if (is_known(width) != is_known(row.neck.distance))
    return "thinnest_neck, thinnest_neck_at: only one is known";
  if (row.status == RunStatus::broken && !(width < least))
    return "broken, but " + named("thinnest_neck", width) + " is not below " + named("break_up_neck", least);
  if (!is_known(width)) return "";
  const bool may_have_daughters = row.parameters.dp.break_up == BreakUp::daughters && !is_final(row);
  if (row.status != RunStatus::broken && width < least && !may_have_daughters)
    return named("thinnest_neck", width) + " is below " + named("break_up_neck", least) +
           ", but it has not broken";
  if (!(width > 0 && width < burst_perimeter) || least == 0)
    return named("thinnest_neck", width) + " is that of no droplet in which necks are looked for";
  if (!is_number_below(row.neck.distance, farthest_distance(row)))
    return named("thinnest_neck_at", row.neck.distance) + " is not on the droplet's way";
  return "";
}

/// Checks that the members of a family are an ancestor and the daughters of all its break-ups.
std::string family_fault(const RunRow& row) {
  const bool has_family = row.parameters.dp.break_up == BreakUp::daughters && is_final(row);
  if (has_family != !row.family.empty())
    return has_family ? "its droplets are missing" : "it has droplets, but no family";
  if (!has_family) return "";
  std::map<std::string, const Member*> members;
  for (const Member& member : row.family)
    if (!members.emplace(member.path, &member).second) return "its droplet " + member.path + " occurs twice";
  double area = 0;  // area of the droplets that have not broken up, relative to the ancestor's area
  for (const Member& member : row.family) {
    const std::string who = "its droplet " + (member.path.empty() ? "(ancestor)" : member.path);
    if (!(member.diameter > 0 && member.diameter <= 1) || !(member.end.time >= member.birth.time))
      return who + " is that of no family";
    const bool has_mother =
        member.path.empty() || members.contains(member.path.substr(0, member.path.size() - 1));
    const bool has_broken = member.status == MemberEnd::broken;
    if (!has_mother || has_broken != members.contains(member.path + '0') ||
        has_broken != members.contains(member.path + '1'))
      return who + " is not connected to the others";
    if (!has_broken) area += member.diameter * member.diameter;
  }
  return std::abs(area - 1) < round_off
             ? ""
             : named("area of its droplets", area) + " is not that of the ancestor";
}

/// Checks the place of release, which is known only among user-supplied circles: it must be in the array.
///
/// Model versions before 12 stored other places. If a droplet was released a little across the border of the
/// array, the stored place is a little outside. If a droplet started outside the first period of the shifted
/// array (see own_circles.cpp), the stored place is wrong by half a period or more, and so is the distance to
/// the exit.
std::string release_fault(const RunRow& row) {
  if (!is_known(row.release[0]) && !is_known(row.release[1])) return "";
  const ObstacleParameters& obstacles = row.parameters.obstacles;
  const std::string place = named("release_x", row.release[0]) + ", " + named("release_y", row.release[1]);
  if (obstacles.layout != ObstacleLayout::file) return place + ", but there are no user-supplied circles";
  const Period period = obstacles.period();
  constexpr std::int64_t first_model_with_places_inside = 12;
  const double margin = row.model_version < first_model_with_places_inside ? 0.5 : 0;  // in periods
  const auto is_inside = [margin](double value, double edge) {
    return value >= -margin * edge && value < (1 + margin) * edge;
  };
  if (is_inside(row.release[0], period.along()) && is_inside(row.release[1], period.across())) return "";
  return margin == 0 ? place + " is not in the array"
                     : place +
                           " is a period away from where the droplet started, an error of clogsweep 1.0; "
                           "compute the sweep anew";
}

std::string result_fault(const RunRow& row) {
  if (row.status == RunStatus::failed) {
    if (row.message.empty()) return "failed without a reason";
    if (!observed_distance(row)) return "";  // readers use no other results of this row
    for (const auto check : {duration_fault, soundness_fault, dwells_fault, contacts_fault})
      if (std::string fault = check(row); !fault.empty()) return fault;
    return "";
  }
  for (const auto check :
       {time_fault, motion_fault, steady_fault, soundness_fault, dwells_fault, contacts_fault, shape_fault,
        clog_fault, passage_fault, neck_fault, family_fault, release_fault})
    if (std::string fault = check(row); !fault.empty()) return fault;
  return "";
}

}  // namespace

double farthest_distance(const RunRow& row) {
  // The energy at the release does not include springs along the interface, because they have no energy. The
  // margin allows for the work of these springs.
  constexpr double margin = 1.1;
  const double weight = units::droplet_mass * units::gravity;
  const RunParameters& run = row.parameters;
  return margin * (run.drag.terminal_speed * row.time + model_of(run).most_energy_at_release(run) / weight);
}

std::string fault_of(const RunRow& row) {
  for (const auto check : {bookkeeping_fault, parameter_fault, result_fault})
    if (std::string fault = check(row); !fault.empty()) return fault;
  return "";
}

}  // namespace clog::sweep
