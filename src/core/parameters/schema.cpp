#include "clog/core/parameters/schema.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "clog/core/parameters/refusal.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/number_text.hpp"

namespace clog {
namespace {

constexpr ParameterScope every_run = {"all", "", "", [](const RunParameters&) { return true; }};
constexpr ParameterScope polygons = {"dp", "model=sp does not depend on it", "leave it out, or use model=dp",
                                     [](const RunParameters& run) { return run.model == Model::dp; }};
constexpr ParameterScope arrays = {
    "arrays", "there is no array of obstacles", "leave it out", [](const RunParameters& run) {
      return run.obstacles.layout != ObstacleLayout::channel && run.obstacles.layout != ObstacleLayout::wall;
    }};
constexpr ParameterScope own_circles = {
    "file", "there are no user-supplied circles", "add obstacles=FILE.csv, or leave this key out",
    [](const RunParameters& run) { return run.obstacles.layout == ObstacleLayout::file; }};
constexpr ParameterScope lengths = {
    "file", own_circles.reason, own_circles.remedy, [](const RunParameters& run) {
      return own_circles.holds(run) || (run.obstacles.layout == ObstacleLayout::lattice &&
                                        run.obstacles.lattice != LatticeKind::square);
    }};
constexpr ParameterScope channels = {
    "channel", "there is no channel", "add obstacle-layout=channel, or leave this key out",
    [](const RunParameters& run) { return run.obstacles.layout == ObstacleLayout::channel; }};
constexpr ParameterScope lattices = {
    "lattice", "a random array has no rows", "add obstacle-layout=lattice",
    [](const RunParameters& run) { return run.obstacles.layout == ObstacleLayout::lattice; }};
constexpr ParameterScope families = {
    "daughters", "daughters are not followed", "add break-up=daughters, or leave this key out",
    [](const RunParameters& run) { return polygons.holds(run) && run.dp.break_up == BreakUp::daughters; }};

// Outside<T> converts a member of type T to a value of the schema and back.

template <class T>
struct Outside;

template <>
struct Outside<double> {
  static constexpr ValueKind kind = ValueKind::number;
  static std::vector<std::string> words() { return {}; }
  static ParameterValue get(double value) { return value; }
  static double set(const ParameterValue& value) { return std::get<double>(value); }
};

template <>
struct Outside<std::optional<double>> : Outside<double> {
  static ParameterValue get(std::optional<double> value) {
    return value ? ParameterValue(*value) : ParameterValue();
  }
  static std::optional<double> set(const ParameterValue& value) {
    const double* number = std::get_if<double>(&value);
    return number ? std::optional(*number) : std::nullopt;
  }
};

template <std::integral Integer>
struct Outside<Integer> {
  static constexpr ValueKind kind = ValueKind::integer;
  static std::vector<std::string> words() { return {}; }
  static ParameterValue get(Integer value) { return std::int64_t{value}; }
  static Integer set(const ParameterValue& value) {
    const auto integer = std::get<std::int64_t>(value);
    if (!std::in_range<Integer>(integer))
      throw Error("is out of range, " + std::to_string(std::numeric_limits<Integer>::min()) + " to " +
                  std::to_string(std::numeric_limits<Integer>::max()));
    return static_cast<Integer>(integer);
  }
};

template <>
struct Outside<std::optional<int>> : Outside<int> {
  static ParameterValue get(std::optional<int> value) {
    return value ? ParameterValue(std::int64_t{*value}) : ParameterValue();
  }
  static std::optional<int> set(const ParameterValue& value) {
    return std::holds_alternative<std::monostate>(value) ? std::nullopt
                                                         : std::optional(Outside<int>::set(value));
  }
};

template <class Enum>
requires std::is_enum_v<Enum>
struct Outside<Enum> {
  static constexpr ValueKind kind = ValueKind::word;
  static std::vector<std::string> words() {
    std::vector<std::string> all;
    for (const auto& [value, word] : Words<Enum>::all) all.emplace_back(word);
    return all;
  }
  static ParameterValue get(Enum value) { return name(value); }
  static Enum set(const ParameterValue& value) {
    const std::string& word = std::get<std::string>(value);
    if (const std::optional<Enum> meant = meant_by<Enum>(word)) return *meant;
    throw Error("is unknown");
  }
};

/// A word of an enum; an empty optional is `auto`.
template <class Enum>
requires std::is_enum_v<Enum>
struct Outside<std::optional<Enum>> : Outside<Enum> {
  static constexpr const char* automatic = "auto";
  static std::vector<std::string> words() {
    std::vector<std::string> all = Outside<Enum>::words();
    all.insert(all.begin(), automatic);
    return all;
  }
  static ParameterValue get(std::optional<Enum> value) {
    return value ? ParameterValue(name(*value)) : ParameterValue();
  }
  static std::optional<Enum> set(const ParameterValue& value) {
    const auto* word = std::get_if<std::string>(&value);
    return !word || *word == automatic ? std::nullopt : std::optional(Outside<Enum>::set(value));
  }
};

template <>
struct Outside<ObstacleDensity> {
  static constexpr ValueKind kind = ValueKind::number_or_share;
  static std::vector<std::string> words() { return {}; }
  static ParameterValue get(const ObstacleDensity& density) {
    if (density.share) return share_text(*density.share);
    return density.per_area ? ParameterValue(*density.per_area) : ParameterValue();
  }
  static ObstacleDensity set(const ParameterValue& value) {
    if (const auto* share = std::get_if<std::string>(&value))
      return ObstacleDensity::share_of_saturated(share_of(*share));
    const auto* number = std::get_if<double>(&value);
    return number ? ObstacleDensity(*number) : ObstacleDensity();
  }
};

template <>
struct Outside<std::optional<OwnCircles>> {
  static constexpr ValueKind kind = ValueKind::file;
  static std::vector<std::string> words() { return {"none"}; }
  static ParameterValue get(const std::optional<OwnCircles>& value) {
    return value ? ParameterValue(value->check_sum()) : ParameterValue();
  }
  static std::optional<OwnCircles> set(const ParameterValue& value) {
    const auto* text = std::get_if<std::string>(&value);
    return text ? std::optional(OwnCircles::from_check_sum(*text)) : std::nullopt;
  }
};

/// The description of a laboratory, given as its text or as its checksum.
template <>
struct Outside<std::optional<LaboratoryText>> {
  static constexpr ValueKind kind = ValueKind::text;
  static constexpr const char* none = "none";
  static std::vector<std::string> words() { return {none}; }
  static ParameterValue get(const std::optional<LaboratoryText>& value) {
    return value ? value->check_sum() : none;
  }
  static std::optional<LaboratoryText> set(const ParameterValue& value) {
    const auto* text = std::get_if<std::string>(&value);
    if (!text || *text == none) return std::nullopt;
    return text->find('=') == std::string::npos ? LaboratoryText::from_check_sum(*text)
                                                : LaboratoryText(*text);
  }
};

/// Properties of a parameter, except its key, its member, and the properties that follow from the member's
/// type.
struct Facts {
  const char* column;
  const char* symbol = "";
  const char* unit = "";
  const char* meaning;
  ParameterRole role = ParameterRole::physics;
  const ParameterScope* scope = &every_run;
  const ParameterScope* automatic_in = nullptr;
  int automatic_order = 0;
  ParameterRange range = {};
  bool has_own_column = true;
  bool shapes_array = false;
  std::vector<std::string> words = {};  ///< the allowed words, if not all words of the type
  ParameterValue elsewhere = {};
  ParameterValue before = {};
  ParameterValue (*compared)(const RunParameters&) = nullptr;
};

/// @param Member  a function without state. It takes the parameters of a run (const or not) and returns a
/// reference to the member
template <class Member>
Parameter entry(const char* key, Member, const Facts& facts) {
  using T = std::remove_cvref_t<decltype(Member{}(std::declval<RunParameters&>()))>;
  return {
      .key = key,
      .column = facts.column,
      .symbol = facts.symbol,
      .unit = facts.unit,
      .meaning = facts.meaning,
      .role = facts.role,
      .scope = facts.scope,
      .automatic_in = facts.automatic_in,
      .automatic_order = facts.automatic_order,
      .range = facts.range,
      .has_own_column = facts.has_own_column,
      .shapes_array = facts.shapes_array,
      .elsewhere = facts.elsewhere,
      .before = facts.before,
      .compared = facts.compared,
      .kind = Outside<T>::kind,
      .words = facts.words.empty() ? Outside<T>::words() : facts.words,
      .get = [](const RunParameters& run) { return Outside<T>::get(Member{}(run)); },
      .set = [](RunParameters& run, const ParameterValue& value) { Member{}(run) = Outside<T>::set(value); }};
}

Bound from(double value, const char* reason, const char* remedy) { return {value, true, reason, remedy}; }
Bound to(double value, const char* reason, const char* remedy) { return {value, true, reason, remedy}; }
Bound above(double value, const char* reason, const char* remedy) { return {value, false, reason, remedy}; }
Bound below(double value, const char* reason, const char* remedy) { return {value, false, reason, remedy}; }

/// K_l/Gamma for springs whose automatic stiffness is proportional to Gamma; unset for other springs. Rounded
/// to nine digits, which removes the round-off of the ratio.
ParameterValue ratio_to_line_tension(const RunParameters& run) {
  const DpParameters& dp = run.dp;
  if (dp.perimeter_spring != PerimeterSpring::rest || !dp.perimeter_stiffness || dp.line_tension <= 0)
    return {};
  constexpr double figures = 1e9;
  return std::round(figures * *dp.perimeter_stiffness / dp.line_tension) / figures;
}

const Bound positive = above(0, "must be positive", "use a value above 0");
const Bound not_negative = from(0, "must not be negative", "use 0 or more");

using enum ParameterRole;

/// Parameters of the droplet.
std::vector<Parameter> droplet_entries() {
  return {
      entry("model", [](auto& run) -> auto& { return run.model; },
            {.column = "model", .meaning = "model of the droplet; dp: deformable polygon, sp: soft disk"}),
      entry("line-tension", [](auto& run) -> auto& { return run.dp.line_tension; },
            {.column = "line_tension",
             .symbol = R"(\Gamma)",
             .unit = "g rho sigma^2",
             .meaning = "Gamma, tension of the interface",
             .scope = &polygons,
             .range = {not_negative, {}}}),
      entry("wall-stiffness", [](auto& run) -> auto& { return run.wall_stiffness; },
            {.column = "wall_stiffness",
             .symbol = "E_w",
             .unit = "g rho sigma^3",
             .meaning = "E_w, stiffness of contact; auto (dp only): the largest stiffness with which the "
                        "integration is stable",
             .automatic_in = &polygons,
             .automatic_order = 3,
             .range = {positive, {}},
             .words = {"auto"}}),
  };
}

/// Obstacle arrays.
std::vector<Parameter> array_entries() {
  return {
      entry("obstacle-gap", [](auto& run) -> auto& { return run.obstacles.gap; },
            {.column = "obstacle_gap",
             .symbol = R"(w_\mathrm{ob})",
             .unit = "sigma",
             .meaning = "w_ob, smallest distance between obstacle surfaces",
             .scope = &arrays,
             .range = {positive, {}},
             .shapes_array = true}),
      entry("obstacle-diameter", [](auto& run) -> auto& { return run.obstacles.diameter; },
            {.column = "obstacle_diameter",
             .symbol = R"(\sigma_\mathrm{ob})",
             .unit = "sigma",
             .meaning = "sigma_ob, diameter of the obstacles, or of user-supplied circles without a diameter "
                        "in the file",
             .scope = &arrays,
             .range = {positive, {}},
             .shapes_array = true}),
      entry("obstacle-diameter-spread", [](auto& run) -> auto& { return run.obstacles.diameter_spread; },
            {.column = "obstacle_diameter_spread",
             .symbol = R"(\Delta\sigma_\mathrm{ob}/\sigma_\mathrm{ob})",
             .meaning = "random obstacles have diameters distributed uniformly between obstacle-diameter*(1 "
                        "- spread) and obstacle-diameter*(1 + spread)",
             .scope = &arrays,
             .range = {not_negative,
                       below(1, "the smallest obstacles would have no diameter", "use less than 1")},
             .shapes_array = true,
             .elsewhere = 0.0}),
      entry(
          "obstacle-density", [](auto& run) -> auto& { return run.obstacles.density; },
          {.column = "obstacle_density",
           .symbol = R"(\rho_\mathrm{ob})",
           .unit = "1/sigma^2",
           .meaning =
               "number of obstacles per area, or a share of the mean density of saturated arrays; saturated: "
               "as many obstacles as fit; a density that the array of some seed cannot reach is refused",
           .scope = &arrays,
           .automatic_in = &arrays,
           .range = {positive, {}},
           .has_own_column = false,
           .shapes_array = true,
           .words = {"saturated"}}),
      entry("obstacle-layout", [](auto& run) -> auto& { return run.obstacles.layout; },
            {.column = "obstacle_filling",
             .meaning =
                 "random: random sequential addition; lattice: posts in rows, see the keys lattice, pitch "
                 "and lattice-angle; file: user-supplied circles; channel: two wedges; wall: a flat wall",
             .has_own_column = false,
             .shapes_array = true}),
  };
}

/// Circles of a file, and the device around them.
std::vector<Parameter> own_circle_entries() {
  return {
      entry("obstacles", [](auto& run) -> auto& { return run.obstacles.own; },
            {.column = "obstacles",
             .meaning =
                 "CSV file of user-supplied circles with columns x, y and diameter (default: "
                 "obstacle-diameter); the result file stores the circles, and each row stores their checksum",
             .scope = &own_circles,
             .shapes_array = true}),
      entry("release", [](auto& run) -> auto& { return run.obstacles.release; },
            {.column = "release",
             .meaning = "where droplets start among user-supplied circles; centre: near the centre of the "
                        "array; anywhere: near a random place in the array; entrance: near a random place on "
                        "the line of the entrance; the seed determines the random place",
             .scope = &own_circles,
             .shapes_array = true}),
      entry("length", [](auto& run) -> auto& { return run.obstacles.length; },
            {.column = "length",
             .symbol = R"(L_x)",
             .unit = "sigma",
             .meaning =
                 "length along the flow after which user-supplied circles repeat; 0: boxes*box. For "
                 "triangular and rhombic lattices, it is the largest allowed period along the flow; 0: box",
             .role = numerics,
             .scope = &lengths,
             .range = {not_negative, to(1e7, "no droplet travels so far", "use at most 1e7")},
             .shapes_array = true,
             .before = 0.0}),
      entry("side-walls", [](auto& run) -> auto& { return run.obstacles.side_walls; },
            {.column = "side_walls",
             .meaning = "on: straight walls along the flow at y=0 and y=box beside user-supplied circles; "
                        "off: the circles repeat across the flow",
             .scope = &own_circles,
             .shapes_array = true,
             .before = "off"}),
      entry("entrance", [](auto& run) -> auto& { return run.obstacles.entrance; },
            {.column = "entrance",
             .symbol = R"(x_\mathrm{in})",
             .unit = "sigma",
             .meaning = "x of the line on which release=entrance places droplets; a droplet whose place is "
                        "not free starts in the nearest void",
             .scope = &own_circles,
             .range = {not_negative, {}},
             .shapes_array = true,
             .before = 0.0}),
      entry("entrance-from", [](auto& run) -> auto& { return run.obstacles.entrance_from; },
            {.column = "entrance_from",
             .symbol = R"(y_\mathrm{in,1})",
             .unit = "sigma",
             .meaning = "y at which the line of the entrance begins",
             .scope = &own_circles,
             .range = {not_negative, {}},
             .shapes_array = true,
             .before = 0.0}),
      entry("entrance-to", [](auto& run) -> auto& { return run.obstacles.entrance_to; },
            {.column = "entrance_to",
             .symbol = R"(y_\mathrm{in,2})",
             .unit = "sigma",
             .meaning = "y at which the line of the entrance ends; 0: at box",
             .scope = &own_circles,
             .range = {not_negative, {}},
             .shapes_array = true,
             .before = 0.0}),
      entry("exit", [](auto& run) -> auto& { return run.obstacles.exit; },
            {.column = "exit",
             .symbol = R"(x_\mathrm{out})",
             .unit = "sigma",
             .meaning = "x at which a droplet has passed the user-supplied circles, so that its run ends; 0: "
                        "there is no exit, and the circles repeat",
             .scope = &own_circles,
             .range = {not_negative, {}},
             .before = 0.0}),
  };
}

/// The channel between two wedges.
std::vector<Parameter> channel_entries() {
  return {
      entry("orifice", [](auto& run) -> auto& { return run.channel.orifice; },
            {.column = "orifice",
             .symbol = "w",
             .unit = "sigma",
             .meaning = "w, distance between the tips of the channel's wedges",
             .scope = &channels,
             .range = {positive, to(20, "the droplet would not feel the wedges", "try 0.7")},
             .shapes_array = true}),
      entry("wedge-angle", [](auto& run) -> auto& { return run.channel.wedge_angle; },
            {.column = "wedge_angle",
             .symbol = R"(\beta)",
             .unit = "degrees",
             .meaning = "angle between the wedges' flanks and the flow; 0: parallel walls",
             .scope = &channels,
             .range = {from(0, "it is the angle between the wedges' flanks and the flow",
                            "use 5..85, or 0 for parallel walls"),
                       to(85, "it is the angle between the wedges' flanks and the flow",
                          "use 5..85, or 0 for parallel walls")},
             .shapes_array = true}),
      entry("tip-radius", [](auto& run) -> auto& { return run.channel.tip_radius; },
            {.column = "tip_radius",
             .symbol = "r_t",
             .unit = "sigma",
             .meaning = "radius of the wedges' rounded tips",
             .scope = &channels,
             .range = {not_negative, to(10, "tips of such a radius are nearly flat", "try 0.03")},
             .shapes_array = true}),
      entry("start", [](auto& run) -> auto& { return run.channel.start; },
            {.column = "start",
             .symbol = "h_0",
             .unit = "sigma",
             .meaning = "position h of the droplet's centre at release; h counts from the line through the "
                        "wedges' tips and is negative upstream",
             .scope = &channels,
             .range = {from(-100, "the approach would take most of the time", "try -10"), {}}}),
      entry("end", [](auto& run) -> auto& { return run.channel.end; },
            {.column = "end",
             .symbol = "h_1",
             .unit = "sigma",
             .meaning = "position h of the droplet's centre at which the run ends, because the droplet has "
                        "passed the channel",
             .scope = &channels,
             .range = {{}, to(100, "the path behind the orifice would take most of the time", "try 3")}}),
  };
}

/// Lattices, boxes, and seeds.
std::vector<Parameter> period_entries() {
  return {
      entry("lattice", [](auto& run) -> auto& { return run.obstacles.lattice; },
            {.column = "obstacle_filling",
             .meaning = "square or triangular lattices are turned by lattice-angle; rhombic: columns of "
                        "posts across the flow, each shifted by pitch*tan(lattice-angle) relative to the "
                        "previous one, as in deterministic lateral displacement",
             .scope = &lattices,
             .has_own_column = false,
             .shapes_array = true}),
      entry("pitch", [](auto& run) -> auto& { return run.obstacles.pitch; },
            {.column = "obstacle_gap",
             .symbol = "a",
             .unit = "sigma",
             .meaning =
                 "distance between neighbouring centres in a lattice; 0: obstacle-gap + obstacle-diameter",
             .scope = &lattices,
             .range = {not_negative, {}},
             .has_own_column = false,
             .shapes_array = true}),
      entry("lattice-angle", [](auto& run) -> auto& { return run.obstacles.lattice_angle; },
            {.column = "lattice_angle",
             .symbol = R"(\theta)",
             .unit = "degrees",
             .meaning = "angle of the lattice's rows from +x (the flow) towards +y; adjusted to the nearest "
                        "angle at which the lattice has a period of at most box",
             .scope = &lattices,
             .range = {from(-45, "a square lattice turned by 90 degrees is the same lattice", "use -45..45"),
                       to(45, "a square lattice turned by 90 degrees is the same lattice", "use -45..45")},
             .shapes_array = true}),
      entry("seeds", [](auto& run) -> auto& { return run.seed; },
            {.column = "seed",
             .meaning = "one run for each seed; the seed determines the obstacles and the place of release",
             .role = ensemble,
             .scope = &arrays,
             .range = {from(0, "a seed is not negative", "use 0..4294967295"),
                       to(4294967295, "a seed has 32 bits", "use 0..4294967295")},
             .shapes_array = true,
             .elsewhere = std::int64_t{0}}),
      entry("box", [](auto& run) -> auto& { return run.obstacles.box; },
            {.column = "box",
             .symbol = "L",
             .unit = "sigma",
             .meaning = "period of the obstacle array across the flow and, with boxes=1, along the flow; for "
                        "lattices, the largest allowed period",
             .role = numerics,
             .scope = &arrays,
             .range = {from(1, "such a box has no room for a droplet",
                            "use at least 5, or more than 1 with side-walls=on"),
                       to(1e5, "no droplet travels that far", "use at most 1e5; the array is periodic")},
             .shapes_array = true}),
      entry("boxes", [](auto& run) -> auto& { return run.obstacles.boxes; },
            {.column = "boxes",
             .symbol = R"(n_\mathrm{box})",
             .meaning = "number of boxes along the flow after which the array repeats; no droplet reaches "
                        "the repetition if this number is at least terminal-speed*max-time/box",
             .role = numerics,
             .scope = &arrays,
             .range = {from(1, "it is the number of boxes along the flow after which the array repeats",
                            "use 1..1e6"),
                       to(1e6, "it is the number of boxes along the flow after which the array repeats",
                          "use 1..1e6")},
             .shapes_array = true,
             .elsewhere = std::int64_t{1}}),
  };
}

/// Time, speed and drag.
std::vector<Parameter> motion_entries() {
  return {
      entry("max-time", [](auto& run) -> auto& { return run.max_time; },
            {.column = "max_time",
             .symbol = "T",
             .unit = "t0",
             .meaning = "time at which a run ends if its droplet has not clogged",
             .role = numerics,
             .range = {positive, {}}}),
      entry("terminal-speed", [](auto& run) -> auto& { return run.drag.terminal_speed; },
            {.column = "terminal_speed",
             .symbol = "V_t",
             .unit = "sqrt(sigma g)",
             .meaning = "V_t, terminal speed of the droplet far from obstacles",
             .range = {positive, to(100, "the droplet would cross many boxes before drag matters",
                                    "use at most 100")}}),
      entry("near-wall-drag", [](auto& run) -> auto& { return run.drag.near_wall; },
            {.column = "near_wall_drag",
             .symbol = R"(b_0/b_\infty)",
             .meaning = "b_0/b_inf: extra drag at a distance of one diameter from a wall, divided by the "
                        "drag far from walls",
             .scope = &polygons,
             .range = {not_negative,
                       to(1000, "near-wall drag would stop the droplet everywhere", "use at most 1000")},
             .elsewhere = 0.0}),
      entry("near-wall-exponent", [](auto& run) -> auto& { return run.drag.near_wall_exponent; },
            {.column = "near_wall_exponent",
             .symbol = R"(\alpha)",
             .meaning = "alpha, exponent of sigma/d in the near-wall drag",
             .scope = &polygons,
             .range = {from(0, "drag would grow away from walls", "use 0..4; the published exponent is 4/3"),
                       to(4, "lubrication theory gives no larger exponent",
                          "use 0..4; the published exponent is 4/3")}}),
      entry("near-wall-cutoff", [](auto& run) -> auto& { return run.drag.near_wall_cutoff; },
            {.column = "near_wall_cutoff",
             .symbol = R"(d_\mathrm{min})",
             .unit = "sigma",
             .meaning = "d_min, distance from a wall below which the near-wall drag is constant",
             .scope = &polygons,
             .range = {positive, to(1, "drag would hardly depend on the distance from walls",
                                    "use at most 1, a droplet diameter")}}),
      entry("relative-drag", [](auto& run) -> auto& { return run.drag.relative; },
            {.column = "relative_drag",
             .symbol = "c",
             .meaning = "c, drag coefficient of motion relative to the centre of mass, divided by b_inf",
             .scope = &polygons,
             .range = {not_negative, to(1000, "the droplet would hardly change its shape",
                                        "use at most 1000; 1 is the published model")},
             .elsewhere = 1.0}),
  };
}

/// The polygon and the springs along it.
std::vector<Parameter> interface_entries() {
  return {
      entry("vertices", [](auto& run) -> auto& { return run.dp.vertices; },
            {.column = "vertices",
             .symbol = "N_v",
             .meaning = "N_v, number of vertices of the polygon; auto: at least 128, and enough for edges "
                        "that are short compared with the obstacles' radius",
             .role = numerics,
             .scope = &polygons,
             .automatic_in = &polygons,
             .automatic_order = 1,
             .range = {from(16, "a polygon with fewer vertices is far from a circle", "use 16..4096"),
                       to(4096, "a run would take months", "use 16..4096")},
             .words = {"auto"},
             .elsewhere = std::int64_t{1}}),
      entry("inertia", [](auto& run) -> auto& { return run.dp.inertia; },
            {.column = "inertia",
             .symbol = "S",
             .meaning = "factor S that multiplies the inertial mass, but neither weight nor drag; the "
                        "automatic time-step is proportional to sqrt(S), or to S if drag limits it",
             .role = numerics,
             .scope = &polygons,
             .range = {from(0.01, "time steps would be needlessly short", "use 0.01..16"),
                       to(16, "inertia would carry the droplet on", "use 0.01..16")},
             .elsewhere = 1.0,
             .before = 1.0}),
      entry("time-step", [](auto& run) -> auto& { return run.time_step; },
            {.column = "time_step",
             .symbol = R"(\Delta t)",
             .unit = "t0",
             .meaning = "step of the integrator; auto: the largest step at which stiff modes do not affect "
                        "the result; the published step is 1e-3",
             .role = numerics,
             .automatic_in = &every_run,
             .automatic_order = 2,
             .range = {from(1e-9, "no mode needs so short a step", "try 1e-3"), {}},
             .words = {"auto"}}),
      entry("area-stiffness", [](auto& run) -> auto& { return run.dp.area_stiffness; },
            {.column = "area_stiffness",
             .symbol = "K_a",
             .unit = "g rho/sigma",
             .meaning = "K_a, stiffness of the area; auto: the value that keeps the area within 0.2 % of its "
                        "rest value, at most the published 1e4",
             .role = numerics,
             .scope = &polygons,
             .automatic_in = &polygons,
             .range = {positive, {}},
             .words = {"auto"}}),
      entry("perimeter-spring", [](auto& run) -> auto& { return run.dp.perimeter_spring; },
            {.column = "perimeter_spring",
             .meaning =
                 "springs of the polygon's edges; rest: pull edges to their rest length l0, as published; "
                 "mean: pull edges to the mean edge length; along: pull each vertex only along the interface",
             .scope = &polygons}),
      entry("perimeter-stiffness", [](auto& run) -> auto& { return run.dp.perimeter_stiffness; },
            {.column = "perimeter_stiffness",
             .symbol = "K_l",
             .unit = "g rho sigma",
             .meaning =
                 "K_l, stiffness of the springs of perimeter-spring; auto: perimeter-stiffness-ratio*Gamma "
                 "with perimeter-spring=rest, 1 with mean, 0.003/V_t with along",
             .scope = &polygons,
             .automatic_in = &polygons,
             .range = {not_negative, {}},
             .words = {"auto"},
             .compared = ratio_to_line_tension}),
      entry("perimeter-stiffness-ratio", [](auto& run) -> auto& { return run.dp.perimeter_stiffness_ratio; },
            {.column = "perimeter_stiffness",
             .symbol = R"(K_l/\Gamma)",
             .meaning = "K_l/Gamma with perimeter-spring=rest and perimeter-stiffness=auto",
             .scope = &polygons,
             .range = {not_negative, {}},
             .has_own_column = false}),
  };
}

/// Contact with walls, and forces along walls.
std::vector<Parameter> wall_entries() {
  return {
      entry("wall-contact", [](auto& run) -> auto& { return run.dp.wall_contact; },
            {.column = "wall_contact",
             .meaning = "edge: a wall pushes the nearest point of every edge; vertex: a wall pushes only the "
                        "vertices, as published",
             .role = numerics,
             .scope = &polygons}),
      entry(
          "contact-range", [](auto& run) -> auto& { return run.dp.contact_range; },
          {.column = "contact_range",
           .symbol = R"(d_\mathrm{c})",
           .unit = "sigma",
           .meaning =
               "distance from a wall's surface at which contact begins; half-vertex: half a vertex diameter, "
               "as published",
           .scope = &polygons,
           .range = {not_negative,
                     to(0.1, "walls would act at a distance, and gaps would be narrower by twice this range",
                        "use 0 (contact at the surface) to 0.1")},
           .words = {"half-vertex"}}),
      entry("wall-tension", [](auto& run) -> auto& { return run.dp.wall_tension; },
            {.column = "wall_tension",
             .symbol = R"(\Gamma_\mathrm{w}/\Gamma)",
             .meaning = "tension of the interface that covers walls, divided by Gamma; equal to -cos(Young's "
                        "contact angle); auto: minus the mean cosine of receding-angle and advancing-angle "
                        "if both are given, otherwise 1",
             .scope = &polygons,
             .range = {from(0.1, "below 0.1 the interface on a wall would buckle", "use 0.1..1"),
                       to(1, "it is minus the cosine of the contact angle", "use 0.1..1")},
             .words = {"auto"}}),
      entry("receding-angle", [](auto& run) -> auto& { return run.dp.receding_angle; },
            {.column = "receding_angle",
             .symbol = R"(\theta_\mathrm{R})",
             .unit = "degrees",
             .meaning = "contact angle of the droplet below which the end of a wetted arc recedes; young: "
                        "the contact angle of wall-tension; only with perimeter-spring=along",
             .scope = &polygons,
             .automatic_in = &polygons,
             .range = {from(0, "it is the angle between wall and interface", "use 0..180, or young"),
                       to(180, "it is the angle between wall and interface", "use 0..180, or young")},
             .words = {"young"}}),
      entry("advancing-angle", [](auto& run) -> auto& { return run.dp.advancing_angle; },
            {.column = "advancing_angle",
             .symbol = R"(\theta_\mathrm{A})",
             .unit = "degrees",
             .meaning = "contact angle of the droplet above which the end of a wetted arc advances; young: "
                        "the contact angle of wall-tension; only with perimeter-spring=along",
             .scope = &polygons,
             .automatic_in = &polygons,
             .range = {from(0, "it is the angle between wall and interface", "use 0..180, or young"),
                       to(180, "it is the angle between wall and interface", "use 0..180, or young")},
             .words = {"young"}}),
      entry("friction", [](auto& run) -> auto& { return run.dp.friction; },
            {.column = "friction",
             .symbol = R"(\mu)",
             .meaning = "mu, coefficient of dry friction of walls: largest tangential force divided by "
                        "normal force; not with perimeter-spring=along",
             .scope = &polygons,
             .range = {not_negative, to(10, "no wall has so much friction", "try 0.3")},
             .elsewhere = 0.0}),
      entry("yield-traction", [](auto& run) -> auto& { return run.dp.yield_traction; },
            {.column = "yield_traction",
             .symbol = R"(\tau_\mathrm{y})",
             .unit = "g rho sigma",
             .meaning = "tau_y, yield traction of walls: largest tangential force per wetted length, in "
                        "addition to friction; not with perimeter-spring=along",
             .scope = &polygons,
             .range = {not_negative, to(1000, "no droplet would ever move", "try 0.1")},
             .elsewhere = 0.0}),
  };
}

/// Self-contact, and where the weight acts.
std::vector<Parameter> self_contact_entries() {
  return {
      entry("self-contact", [](auto& run) -> auto& { return run.dp.self_contact; },
            {.column = "self_contact",
             .meaning = "whether the interface repels itself",
             .role = numerics,
             .scope = &polygons}),
      entry("self-contact-range", [](auto& run) -> auto& { return run.dp.self_contact_range; },
            {.column = "self_contact_range",
             .symbol = R"(d_\mathrm{s})",
             .unit = "sigma",
             .meaning = "distance below which the interface repels itself",
             .scope = &polygons,
             .range = {positive, to(0.1, "the droplet could not get thinner than this, so it could not fold",
                                    "use at most 0.1")}}),
      entry("film-friction", [](auto& run) -> auto& { return run.dp.film_friction; },
            {.column = "film_friction",
             .meaning = "whether friction of the wall also holds the upper layers of the interface; auto: on "
                        "with friction and self-contact",
             .scope = &polygons,
             .automatic_in = &polygons,
             .before = name(FilmFriction::off)}),
      entry("gravity", [](auto& run) -> auto& { return run.dp.gravity; },
            {.column = "gravity",
             .meaning = "area: weight and mean drag act on the area, as a pressure; vertex: they act on the "
                        "vertices, as published",
             .scope = &polygons}),
  };
}

/// Parameters that determine how a run ends, and its status.
std::vector<Parameter> verdict_entries() {
  return {
      entry("clog-energy", [](auto& run) -> auto& { return run.clog_energy; },
            {.column = "clog_energy",
             .symbol = "E_k/E_t",
             .meaning = "a droplet is clogged when its kinetic energy stays below this fraction of its "
                        "kinetic energy at terminal speed",
             .role = numerics,
             .range = {above(0, "the kinetic energy never becomes exactly 0", "try 1e-17"),
                       below(1e-3, "droplets that only pause would count as clogged", "try 1e-17")}}),
      entry("clog-detection", [](auto& run) -> auto& { return run.clog_detection; },
            {.column = "clog_detection",
             .meaning = "certified: a droplet that slows down counts as clogged if a stable equilibrium is "
                        "proved to be near, or if its kinetic energy stays below clog-energy; threshold: "
                        "only if its kinetic energy stays below clog-energy",
             .role = numerics}),
      entry("dwell-length", [](auto& run) -> auto& { return run.dwell_length; },
            {.column = "dwell_length",
             .symbol = R"(\delta_\mathrm{d})",
             .unit = "sigma",
             .meaning = "a droplet rests (dwells) while it advances by at most this length; the dwell "
                        "columns record for how long",
             .role = numerics,
             .range = {positive,
                       to(0.5, "a droplet that hangs on an obstacle moves less than this", "try 0.05")}}),
      entry("break-up-neck", [](auto& run) -> auto& { return run.dp.break_up_neck; },
            {.column = "break_up_neck",
             .symbol = R"(w_\mathrm{b})",
             .unit = "sigma",
             .meaning = "a droplet has broken up when a neck between two of its lobes is narrower than this "
                        "width; 0: droplets never break up",
             .scope = &polygons,
             .range = {from(0, "must not be negative", "try 0.05, or 0 for droplets that never break up"),
                       to(0.5, "a droplet in a gap may be this narrow without breaking up", "try 0.05")}}),
      entry("break-up", [](auto& run) -> auto& { return run.dp.break_up; },
            {.column = "break_up",
             .meaning = "end: a run ends when its droplet breaks up; daughters: the run continues with all "
                        "daughters, which needs near-wall-drag=0, side-walls=off and walls that the droplet "
                        "does not wet",
             .scope = &polygons,
             .before = "end"}),
      entry("smallest-daughter", [](auto& run) -> auto& { return run.dp.smallest_daughter; },
            {.column = "smallest_daughter",
             .symbol = "d_0",
             .unit = "sigma",
             .meaning = "daughters of a smaller diameter are counted, but not followed",
             .scope = &families,
             .range = {from(0.05, "its step would be much shorter", "try 0.2"),
                       to(0.7, "the smaller of two daughters has at most a diameter of 0.71", "try 0.2")},
             .elsewhere = 0.2,
             .before = 0.2}),
      entry("speed-exponent", [](auto& run) -> auto& { return run.drag.speed_exponent; },
            {.column = "speed_exponent",
             .symbol = "n",
             .meaning = "exponent n: the terminal speed of a daughter of diameter d (ancestor: 1) is d^n "
                        "times that of its ancestor",
             .scope = &families,
             .range = {not_negative, to(2, "no drag gives a larger exponent", "try 1")},
             .elsewhere = 0.0,
             .before = 0.0}),
  };
}

/// The laboratory; results are also given in its units.
std::vector<Parameter> laboratory_entries() {
  return {entry("laboratory", [](auto& run) -> auto& { return run.laboratory; },
                {.column = "laboratory",
                 .meaning = "description of the laboratory, set by --lab FILE; the result file stores this "
                            "description, and each row stores its checksum",
                 .before = "none"})};
}

/// All entries, in the order of the table's columns.
std::vector<Parameter> make_schema() {
  std::vector<Parameter> all;
  for (const auto& entries : {droplet_entries(), array_entries(), own_circle_entries(), channel_entries(),
                              period_entries(), motion_entries(), interface_entries(), wall_entries(),
                              self_contact_entries(), verdict_entries(), laboratory_entries()})
    all.insert(all.end(), entries.begin(), entries.end());
  return all;
}

std::string text_of(const ParameterValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return shortest(*number);
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  return "auto";
}

/// The keys that an error names if the parameter does not apply to the run.
Refusal::About about_scope(const Parameter& parameter) {
  const ParameterScope* const scope = parameter.scope;
  if (scope == &polygons) return {.key = parameter.key, .named = {"model"}};
  if (scope == &own_circles || scope == &lengths) return {.key = parameter.key, .added = "obstacles"};
  if (scope == &families) return {.key = parameter.key, .added = "break-up"};
  if (scope == &channels || scope == &lattices) return {.key = parameter.key, .added = "obstacle-layout"};
  return {.key = parameter.key};
}

[[noreturn]] void refuse(const Parameter& parameter, const ParameterValue& value, const std::string& reason,
                         const char* remedy) {
  throw Refusal({.key = parameter.key}, text_of(value), reason, remedy);
}

bool is_beyond(const Bound& bound, double excess) { return bound.is_allowed ? excess < 0 : excess <= 0; }

void check_range(const Parameter& parameter, double number, const ParameterValue& value) {
  if (!std::isfinite(number)) refuse(parameter, value, "must be finite", "use a number");
  const auto& [lower, upper] = parameter.range;
  const auto refuse_beyond = [&](const Bound& bound) {
    // Remedies that begin with "use" name the range themselves.
    const bool has_range = !std::string_view(bound.remedy).starts_with("try ");
    refuse(parameter, value, bound.reason + (has_range ? "" : "; possible: " + text_of(parameter.range)),
           bound.remedy);
  };
  if (lower && is_beyond(*lower, number - lower->value)) refuse_beyond(*lower);
  if (upper && is_beyond(*upper, upper->value - number)) refuse_beyond(*upper);
}

/// The number in a value; a share like `12.5%` is converted to a number.
std::optional<double> number_of(const ParameterValue& value, ValueKind kind) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  const auto* text = std::get_if<std::string>(&value);
  return text && kind == ValueKind::number_or_share ? std::optional(share_of(*text)) : std::nullopt;
}

void check_one(const Parameter& parameter, const RunParameters& run) {
  static const RunParameters defaults;
  const ParameterValue value = parameter.get(run);
  if (!parameter.applies_to(run)) {
    if (value != parameter.get(defaults))
      throw Refusal(about_scope(parameter), text_of(value), parameter.scope->reason, parameter.scope->remedy);
    return;
  }
  if (const std::optional<double> number = number_of(value, parameter.kind))
    check_range(parameter, *number, value);
}

}  // namespace

std::span<const Parameter> parameter_schema() {
  static const std::vector<Parameter> all = make_schema();
  return all;
}

const Parameter& parameter(std::string_view key) {
  const auto all = parameter_schema();
  const auto found =
      std::find_if(all.begin(), all.end(), [=](const Parameter& one) { return one.key == key; });
  if (found == all.end()) throw std::out_of_range("no parameter " + std::string(key));
  return *found;
}

void check_each(const RunParameters& run) {
  for (const Parameter& parameter : parameter_schema()) check_one(parameter, run);
}

std::string text_of(const ParameterRange& range) {
  const auto& [lower, upper] = range;
  std::string text;
  if (lower) text += (lower->is_allowed ? "at least " : "above ") + shortest(lower->value);
  if (lower && upper) text += ", ";
  if (upper) text += (upper->is_allowed ? "at most " : "below ") + shortest(upper->value);
  return text;
}

}  // namespace clog
