#include "clog/sweep/columns.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/keys.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::sweep {
namespace {

constexpr std::size_t number_size = 8;

/// Size of a column of words: two sizes are enough.
std::size_t text_size(std::size_t longest_word) { return longest_word < 8 ? 8 : 16; }

std::size_t longest(const std::vector<std::string>& words) {
  std::size_t size = std::string_view("none").size();
  for (const std::string& word : words) size = std::max(size, word.size());
  return size;
}

// These functions convert a member of RunRow to a value and back, by the type of the member.

Value outside(double value) { return is_known(value) ? Value(value) : Value(); }
Value outside(std::int64_t value) { return is_known(value) ? Value(value) : Value(); }
Value outside(const std::string& value) { return value; }
template <class Enum>
requires std::is_enum_v<Enum> Value outside(Enum value) { return name(value); }
template <class T>
Value outside(const std::optional<T>& value) {
  return value ? outside(*value) : Value();
}

void take(const Value& value, double& member) {
  const double* number = std::get_if<double>(&value);
  member = number ? *number : RunRow::not_known;
}
void take(const Value& value, std::int64_t& member) {
  const std::int64_t* integer = std::get_if<std::int64_t>(&value);
  member = integer ? *integer : RunRow::not_counted;
}
void take(const Value& value, std::string& member) {
  const std::string* text = std::get_if<std::string>(&value);
  member = text ? *text : "";
}
template <class Enum>
requires std::is_enum_v<Enum>
void take(const Value& value, Enum& member) {
  const std::string* word = std::get_if<std::string>(&value);
  const std::optional<Enum> meant = word ? meant_by<Enum>(*word) : std::nullopt;
  if (!meant) throw Error("is unknown");
  member = *meant;
}
template <class T>
void take(const Value& value, std::optional<T>& member) {
  member.reset();
  if (value != Value()) take(value, member.emplace());
}

template <class T>
constexpr ValueKind kind_of() {
  if constexpr (std::is_same_v<T, double>) return ValueKind::number;
  if constexpr (std::is_same_v<T, std::int64_t>) return ValueKind::integer;
  return ValueKind::word;
}

/// A column that is a member of the row, or a part of a member.
/// @param place  pointer to the member, or a function from a row (const or not) to a reference to the part
template <class Place>
Column member(const std::string& name, Place place, ColumnRole role, const char* unit,
              const std::string& meaning, std::size_t size = number_size) {
  return {.name = name,
          .symbol = "",
          .unit = unit,
          .meaning = meaning,
          .role = role,
          .kind = kind_of<std::remove_cvref_t<decltype(std::invoke(place, std::declval<RunRow&>()))>>(),
          .size = size,
          .parameter = nullptr,
          .shapes_array = false,
          .get = [=](const RunRow& row) { return outside(std::invoke(place, row)); },
          .set = [=](RunRow& row, const Value& value) { take(value, std::invoke(place, row)); },
          .set_unknown =
              [=](RunRow& row) {
                const RunRow unknown{};
                std::invoke(place, row) = std::invoke(place, unknown);
              }};
}

bool is_text(const Parameter& parameter) {
  return parameter.kind == ValueKind::word || parameter.kind == ValueKind::file ||
         parameter.kind == ValueKind::text;
}

Value value_of(const Parameter& parameter, const RunRow& row) {
  if (!parameter.applies_to(row.parameters))
    return parameter.elsewhere == Value() && is_text(parameter) ? Value("none") : parameter.elsewhere;
  return row.unknown_parameters.contains(&parameter) ? Value() : parameter.get(row.parameters);
}

/// Sets a parameter of a row. An unset value means that the file is older than the parameter.
void set_parameter(const Parameter& parameter, RunRow& row, const Value& value) {
  if (!parameter.applies_to(row.parameters)) return;
  row.unknown_parameters.erase(&parameter);
  if (value == Value())
    row.unknown_parameters.insert(&parameter);
  else
    parameter.set(row.parameters, value);
}

/// Number of digits of a checksum. In a column, the checksum stands for the content of a file or text.
constexpr std::size_t check_sum_size = 16;

Column parameter_column(const Parameter& parameter) {
  const std::size_t size = !is_text(parameter)                 ? number_size
                           : parameter.kind == ValueKind::word ? text_size(longest(parameter.words))
                                                               : check_sum_size;
  return {.name = parameter.column,
          .symbol = parameter.symbol,
          .unit = parameter.unit,
          .meaning = parameter.meaning,
          .role = ColumnRole::parameter,
          .kind = is_text(parameter) ? ValueKind::word : parameter.kind,
          .size = size,
          .parameter = &parameter,
          .shapes_array = parameter.shapes_array,
          .scope = parameter.scope,
          .get = [&parameter](const RunRow& row) { return value_of(parameter, row); },
          .set = [&parameter](RunRow& row, const Value& value) { set_parameter(parameter, row, value); },
          .set_unknown = [&parameter](RunRow& row) { set_parameter(parameter, row, parameter.before); }};
}

/// The column of the model, which separates groups, so that every group names its model.
Column model_column(const Parameter& model) {
  Column column = parameter_column(model);
  column.usual = [](const RunRow&) { return Value(); };
  return column;
}

/// How the array was filled: layout and density in one word.
Column filling_column() {
  constexpr const char* to_density = "density";
  constexpr const char* until_full = "saturated";
  return {.name = "obstacle_filling",
          .symbol = "",
          .unit = "",
          .meaning =
              "saturated or density in random arrays; lattice (square), triangular or rhombic in lattices; "
              "otherwise file, channel or wall",
          .role = ColumnRole::parameter,
          .kind = ValueKind::word,
          .size = 16,
          .parameter = nullptr,
          .shapes_array = true,
          .get = [=](const RunRow& row) -> Value {
            const ObstacleParameters& obstacles = row.parameters.obstacles;
            if (obstacles.layout == ObstacleLayout::lattice && obstacles.lattice != LatticeKind::square)
              return name(obstacles.lattice);
            if (obstacles.layout != ObstacleLayout::random) return name(obstacles.layout);
            return obstacles.density.is_saturated() ? until_full : to_density;
          },
          .set =
              [=](RunRow& row, const Value& value) {
                ObstacleParameters& obstacles = row.parameters.obstacles;
                const std::string& word = std::get<std::string>(value);
                const std::optional<LatticeKind> lattice = meant_by<LatticeKind>(word);
                const std::optional<ObstacleLayout> layout = word == to_density || word == until_full
                                                                 ? ObstacleLayout::random
                                                             : lattice ? ObstacleLayout::lattice
                                                                       : meant_by<ObstacleLayout>(word);
                if (!layout || word == name(ObstacleLayout::random) || word == name(LatticeKind::square))
                  throw Error("is unknown");
                obstacles.layout = *layout;
                obstacles.lattice = lattice.value_or(LatticeKind::square);
                obstacles.density = ObstacleParameters().density;
                if (word == until_full) obstacles.density = {};
                if (word == to_density) obstacles.density = RunRow::not_known;  // see density_column()
              },
          .set_unknown = [](RunRow&) {}};
}

Column density_column() {
  Column column = member("obstacle_density", &RunRow::obstacle_density, ColumnRole::parameter, "1/sigma^2",
                         "number of obstacles per area; for saturated arrays the jamming limit "
                         "0.6966/(w_ob+sigma_ob)^2, or NaN if the diameters differ");
  column.symbol = parameter("obstacle-density").symbol;
  column.shapes_array = true;
  column.set = [](RunRow& row, const Value& value) {
    take(value, row.obstacle_density);
    if (row.parameters.obstacles.density.per_area) row.parameters.obstacles.density = row.obstacle_density;
  };
  column.compared = [](const RunRow& row) {
    const ObstacleParameters& obstacles = row.parameters.obstacles;
    const bool is_chosen =
        obstacles.layout == ObstacleLayout::random && (obstacles.density.per_area || obstacles.density.share);
    return is_chosen ? outside(row.obstacle_density) : Value();
  };
  // The default is a share of the saturated density, but the column holds a number per area, so the default
  // depends on the gap.
  column.usual = [](const RunRow& row) -> Value {
    if (!row.parameters.obstacles.density.per_area) return outside(row.obstacle_density);
    RunParameters run = row.parameters;
    run.obstacles.density = ObstacleParameters().density;
    return outside(describe(resolve(run)).obstacle_density);
  };
  return column;
}

/// The column of the preset. It allows any word, because presets of another version may have other names.
Column preset_column() {
  Column column = member(
      "preset", &RunRow::preset, ColumnRole::parameter, "",
      "preset that has the run's values of the interface's keys; custom: no preset has them; none: soft disk",
      16);
  column.scope = parameter("perimeter-spring").scope;
  column.usual = [](const RunRow&) -> Value { return find_key("preset").default_text; };
  return column;
}

std::vector<Column> columns_of_dwells() {
  using enum ColumnRole;
  std::vector<Column> all;
  for (std::size_t i = 0; i < Dwells::most; ++i) {
    const std::string name = dwell_column(i);
    const std::string meaning = i == 0
                                    ? "longest time in which the droplet advanced by at most dwell_length; a "
                                      "dwell cut off by the end of the run counts, but the clog does not; "
                                      "NaN: no dwell was longer than ten times dwell_length/V_t"
                                    : "longest dwell before " + dwell_column(i - 1) + "; NaN: there was none";
    all.push_back(member(
        name, [i](auto& row) -> auto& { return row.dwells.longest[i].length; }, result, "t0", meaning));
    all.push_back(member(
        name + "_at", [i](auto& row) -> auto& { return row.dwells.longest[i].distance; }, result, "sigma",
        "distance at which this dwell began"));
    all.push_back(member(
        name + "_from", [i](auto& row) -> auto& { return row.dwells.longest[i].begin; }, result, "t0",
        "time at which this dwell began"));
  }
  all.push_back(member(
      "dwells_known_from", [](auto& row) -> auto& { return row.dwells.known_from; }, result, "t0",
      "the dwell columns contain the first dwell longer than T, for every T above this value"));
  all.push_back(member(
      "last_dwell_at", [](auto& row) -> auto& { return row.dwells.last_distance; }, result, "sigma",
      "distance at which the last dwell of any duration began; this dwell is the clog or, in other runs, the "
      "one at the end"));
  all.push_back(member(
      "last_dwell_from", [](auto& row) -> auto& { return row.dwells.last_begin; }, result, "t0",
      "time at which this dwell began"));
  return all;
}

std::vector<Column> columns_before_dwells() {
  using enum ColumnRole;
  return {
      preset_column(),
      member("model_version", &RunRow::model_version, parameter, "",
             "version of the model; two versions may give different results for the same parameters"),
      member("status", &RunRow::status, result, "",
             "clogged; broken: a neck of the droplet got thinner than break_up_neck; flowing: the run "
             "reached max_time; passed: the droplet reached the exit or the end of the channel; failed: see "
             "message; running, interrupted: the run is incomplete, and other columns show its state so far",
             16),
      member("clogged_by", &RunRow::clogged_by, result, "",
             "certified: the droplet was proved to be near a stable equilibrium, and distance, "
             "lateral_displacement and shape_parameter are those of this equilibrium; threshold: E_k/E_t "
             "fell below clog_energy; none: not clogged; "
             "empty: unknown",
             16),
      member("stability", &RunRow::stability, result, "",
             "stable: the clogged droplet would return after any small displacement; unknown: numerical "
             "derivatives of the forces cannot decide whether it would; none: not clogged; empty: the "
             "program's version did not compute this",
             16),
      member("failed_by", &RunRow::failed_by, result, "",
             "crossing: the interface crossed itself; divergence: the integration diverged; crash: the "
             "program or its process failed; none: not failed; empty: unknown",
             16),
      member("distance", &RunRow::distance, result, "sigma",
             "displacement of the centre of mass along the flow since release"),
      member("sound_distance", &RunRow::sound_distance, result, "sigma",
             "distance at the last check that found the droplet whole and not crossing itself; failed runs "
             "are censored there; NaN: unknown"),
      member(
          "lateral_displacement", [](auto& row) -> auto& { return row.lateral; }, result, "sigma",
          "displacement across the flow"),
      member("time", &RunRow::time, result, "t0", "time since release"),
      member(
          "mean_speed", [](auto& row) -> auto& { return row.speed.mean; }, result, "sqrt(sigma g)",
          "mean speed from the end of the transient to the arrest; NaN if the droplet moved less than half a "
          "diameter between them, or if the transient took more than half of the run"),
      member(
          "mean_speed_error", [](auto& row) -> auto& { return row.speed.error; }, result, "sqrt(sigma g)",
          "standard error of mean_speed from its variation during the run; NaN if the run was too short"),
      member(
          "transient", [](auto& row) -> auto& { return row.speed.transient; }, result, "t0",
          "time at which the transient ends"),
      member(
          "travel_time", [](auto& row) -> auto& { return row.speed.time; }, result, "t0",
          "time from the end of the transient to the arrest, over which mean_speed is averaged"),
      member(
          "steady_distance", [](auto& row) -> auto& { return row.steady.distance; }, result, "sigma",
          fmt::format(
              "displacement along the flow from the time {:g} sigma/V_t to the end of the run, or to the "
              "last dwell of a clogged run; NaN: the run ended, or its last dwell began, before this time",
              SteadyRecord::free_fall)),
      member(
          "steady_time", [](auto& row) -> auto& { return row.steady.time; }, result, "t0",
          "time that the droplet took for steady_distance"),
  };
}

std::vector<Column> columns_after_dwells() {
  using enum ColumnRole;
  return {
      member(
          "contacts", [](auto& row) -> auto& { return row.contacts.number; }, result, "",
          "number of contacts with obstacles, checked every 64 steps; an obstacle counts again after a "
          "separation of 0.1 sigma; -1: unknown"),
      member(
          "first_contact_at", [](auto& row) -> auto& { return row.contacts.first_distance; }, result, "sigma",
          "distance of the first contact; NaN: none"),
      member("kinetic_energy_ratio", &RunRow::kinetic_energy_ratio, result, "",
             "E_k/E_t at the end; E_t: kinetic energy at terminal speed"),
      member("shape_parameter", &RunRow::shape_parameter, result, "",
             "A = perimeter^2/(4 pi area) at the end; 1 for a circle"),
      member(
          "mechanism", [](auto& row) -> auto& { return row.hold.mechanism; }, result, "",
          "wrapped, squeezed or hybrid (docs/explanation/clogged.md); none: not clogged, or clogged by "
          "another mechanism; empty: unknown",
          16),
      member(
          "wrapped_support", [](auto& row) -> auto& { return row.hold.geometry.wrapped_support; }, result, "",
          "fraction of the upstream support that wrapped obstacles give; NaN unless the droplet is a "
          "clogged polygon"),
      member(
          "num_wrapped", [](auto& row) -> auto& { return row.hold.geometry.num_wrapped; }, result, "",
          "number of obstacles that the clogged polygon touches and over which it hangs; 0 for other "
          "droplets; -1: unknown"),
      member(
          "num_gaps", [](auto& row) -> auto& { return row.hold.geometry.num_gaps; }, result, "",
          "number of gaps that are in front of the clogged polygon and support it on at least one side; -1: "
          "unknown"),
      member(
          "num_arcs", [](auto& row) -> auto& { return row.hold.geometry.num_arcs; }, result, "",
          "number of arcs of contact; -1: unknown"),
      member(
          "mesh_hold", [](auto& row) -> auto& { return row.hold.geometry.mesh_hold; }, result, "",
          "largest fraction of the weight that corners of the mesh can hold where a clogged polygon hangs "
          "over obstacles; NaN for other droplets"),
      member(
          "friction_use", [](auto& row) -> auto& { return row.hold.friction_use; }, result, "",
          "fraction of the largest possible friction that holds the clogged polygon on a post, as moments "
          "about the post's centre; the maximum over all posts that give at least a tenth of its support; "
          "NaN for other droplets"),
      member(
          "largest_shape_parameter",
          [](auto& row) -> auto& { return row.passage.largest_shape_parameter.value; }, result, "",
          "largest A in a channel; this and the next five columns are NaN for other runs"),
      member(
          "largest_shape_parameter_at",
          [](auto& row) -> auto& { return row.passage.largest_shape_parameter.place; }, result, "sigma",
          "h at which A was largest; h counts from the line through the wedges' tips, positive downstream"),
      member(
          "largest_relative_speed", [](auto& row) -> auto& { return row.passage.largest_speed.value; },
          result, "", "largest v_g/v_t in a channel"),
      member(
          "largest_relative_speed_at", [](auto& row) -> auto& { return row.passage.largest_speed.place; },
          result, "sigma", "h at which the droplet had this speed"),
      member(
          "smallest_relative_speed", [](auto& row) -> auto& { return row.passage.smallest_speed.value; },
          result, "", "smallest v_g/v_t in a channel, after ten relaxation times V_t/g"),
      member(
          "smallest_relative_speed_at", [](auto& row) -> auto& { return row.passage.smallest_speed.place; },
          result, "sigma", "h at which the droplet had this speed"),
      member(
          "sag", [](auto& row) -> auto& { return row.sag.centre; }, result, "sigma",
          "delta_s, how far the centroid of a droplet on a flat wall has sunk; NaN for other runs"),
      member(
          "top_sag", [](auto& row) -> auto& { return row.sag.top; }, result, "sigma",
          "how far the highest point of a droplet on a flat wall has sunk; NaN for other runs"),
      member(
          "thinnest_neck", [](auto& row) -> auto& { return row.neck.width; }, result, "sigma",
          "smallest width of a neck between two lobes during the run (docs/explanation/wrapped.md); NaN: no "
          "neck, or break_up_neck is 0"),
      member(
          "thinnest_neck_at", [](auto& row) -> auto& { return row.neck.distance; }, result, "sigma",
          "distance at which the droplet had this neck"),
      member("healed_crossings", &RunRow::healed_crossings, result, "",
             "number of times that a vertex passed through another part of the interface and was pushed "
             "back; -1: unknown"),
      member(
          "release_x", [](auto& row) -> auto& { return row.release[0]; }, result, "sigma",
          "x of the centre of mass at release, in the coordinates of the user-supplied circles; NaN for "
          "other obstacles"),
      member(
          "release_y", [](auto& row) -> auto& { return row.release[1]; }, result, "sigma",
          "y of the centre of mass at release, in these coordinates; NaN for other obstacles"),
      member("steps", &RunRow::steps, result, "",
             "number of integrated steps; each sub-step counts as one step"),
      member("wall_seconds", &RunRow::wall_seconds, circumstance, "s",
             "wall-clock time of the run in all sessions"),
      member("processor_seconds", &RunRow::processor_seconds, circumstance, "s",
             "processor time of the run in all sessions; NaN: unknown"),
      member("rank", &RunRow::rank, circumstance, "", "MPI rank that computed the run"),
      member("instruction_set", &RunRow::instruction_set, circumstance, "",
             "instruction set of the polygon's steps; mixed: several, so no replay reproduces the bits; "
             "none: soft disk",
             16),
      member("host", &RunRow::host, circumstance, "", "host of the rank that computed the run", 64),
      member("attempt", &RunRow::attempt, circumstance, "",
             "number of the attempt that gave this row; interruptions, and failures that may be the rank's "
             "fault, do not count"),
      member("message", &RunRow::message, circumstance, "", "why the run failed", 256),
  };
}

std::vector<Column> make_columns() {
  std::vector<Column> all = {
      member("task", &RunRow::task, ColumnRole::circumstance, "", "number of the task in its sweep")};
  // The columns `model` and `obstacle_filling` come first, because they decide which other parameters a run
  // has.
  for (const Parameter& one : parameter_schema()) {
    const bool is_model = one.key == std::string_view("model");
    if (one.has_own_column) all.push_back(is_model ? model_column(one) : parameter_column(one));
    if (is_model) all.push_back(filling_column());
  }
  all.push_back(density_column());
  for (const auto& columns_of : {columns_before_dwells, columns_of_dwells, columns_after_dwells})
    std::ranges::move(columns_of(), std::back_inserter(all));
  return all;
}

}  // namespace

std::span<const Column> columns() {
  static const std::vector<Column> all = make_columns();
  return all;
}

std::string dwell_column(std::size_t place) {
  return place == 0 ? "longest_dwell" : "earlier_dwell_" + std::to_string(place);
}

const Column& column(std::string_view name) {
  const auto all = columns();
  const auto found = std::ranges::find(all, name, &Column::name);
  if (found == all.end()) throw std::out_of_range("no column " + std::string(name));
  return *found;
}

void Column::pack(const RunRow& row, std::byte* bytes) const {
  const Value value = get(row);
  if (kind == ValueKind::word) {
    const auto* text = std::get_if<std::string>(&value);
    const std::size_t length = text ? std::min(text->size(), size) : 0;
    if (text) std::memcpy(bytes, text->data(), length);
    std::fill(bytes + length, bytes + size, std::byte{0});
  } else if (kind == ValueKind::integer) {
    const auto* integer = std::get_if<std::int64_t>(&value);
    std::memcpy(bytes, integer ? integer : &RunRow::not_counted, number_size);
  } else {
    const auto* number = std::get_if<double>(&value);
    std::memcpy(bytes, number ? number : &RunRow::not_known, number_size);
  }
}

void Column::unpack(const std::byte* bytes, UnpackedRow& unpacked) const {
  Value value;
  if (kind == ValueKind::word) {
    const std::string_view all(reinterpret_cast<const char*>(bytes), size);
    if (const std::string_view text = all.substr(0, all.find('\0')); !text.empty()) value = std::string(text);
  } else if (kind == ValueKind::integer) {
    std::memcpy(&value.emplace<std::int64_t>(), bytes, number_size);
  } else {
    double number;
    std::memcpy(&number, bytes, number_size);
    value = outside(number);
  }
  try {
    set(unpacked.row, value);
  } catch (const std::exception& error) {
    if (!unpacked.fault.empty()) return;
    const std::string shown = kind == ValueKind::word ? "'" + text_of(value) + "'" : text_of(value);
    unpacked.fault = name + "=" + shown + " " + error.what();
  }
}

std::string text_of(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return shortest(*number);
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  const auto* word = std::get_if<std::string>(&value);
  return word ? *word : "";
}

}  // namespace clog::sweep
