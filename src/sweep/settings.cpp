#include "clog/sweep/settings.hpp"

#include <algorithm>
#include <limits>
#include <sstream>
#include <utility>

#include "clog/core/error.hpp"

namespace clog::sweep {
namespace {

/// Of a value in the config: all keys together must fit an attribute of the file, 64 KiB.
constexpr std::size_t longest_text = 3000;

std::optional<double> number_or_auto(const std::string& value) {
  if (value == "auto" || value == "saturated") return std::nullopt;
  return to_number(value);
}

template <class Integer>
Integer in_range(const std::string& value) {
  const long long integer = to_integer(value);
  if (integer < std::numeric_limits<Integer>::min() || integer > std::numeric_limits<Integer>::max())
    throw Error("'" + value + "' is out of range");
  return static_cast<Integer>(integer);
}

std::vector<Key> make_keys() {
  using enum ValueKind;
  return {
      {"model",
       word,
       {"dp", "sp"},
       "dp",
       "dp: deformable polygon, sp: soft disk",
       false,
       [](RunParameters& run, const std::string& value) {
         run.model = value == "dp" ? Model::dp : Model::sp;
       }},
      {"preset",
       word,
       {"robust", "heavy-interface", "elastic", "literal"},
       "robust",
       "sets the keys of the interface together, those given by hand excepted: robust (weight on the "
       "liquid), "
       "heavy-interface (weight on the interface), elastic (the same, and it stretches like rubber, K_l = "
       "0.1 Gamma; "
       "shows the published trends), literal (the published equations)",
       true,
       [](RunParameters&, const std::string&) {}},  // Settings::set does it
      {"line-tension",
       number,
       {},
       "1",
       "Gamma [g rho sigma^2]",
       true,
       [](RunParameters& run, const std::string& value) { run.dp.line_tension = to_number(value); }},
      {"wall-stiffness",
       number,
       {"auto"},
       "auto",
       "E_w [g rho sigma^3]; auto: the stiffest that time-step and vertices hold (dp only)",
       false,
       [](RunParameters& run, const std::string& value) { run.wall_stiffness = number_or_auto(value); }},
      {"obstacle-gap",
       number,
       {},
       "0.2",
       "w_ob, smallest distance between obstacle surfaces [sigma]",
       false,
       [](RunParameters& run, const std::string& value) { run.obstacles.gap = to_number(value); }},
      {"obstacle-diameter",
       number,
       {},
       "0.3",
       "sigma_ob [sigma]",
       false,
       [](RunParameters& run, const std::string& value) { run.obstacles.diameter = to_number(value); }},
      {"obstacle-diameter-spread",
       number,
       {},
       "0",
       "diameters of random obstacles are uniform in obstacle-diameter*(1 -+ spread)",
       false,
       [](RunParameters& run, const std::string& value) {
         run.obstacles.diameter_spread = to_number(value);
       }},
      {"obstacle-density",
       number,
       {"saturated"},
       "saturated",
       "obstacles per sigma^2; saturated: until not one more fits",
       false,
       [](RunParameters& run, const std::string& value) { run.obstacles.density = number_or_auto(value); }},
      {"obstacle-layout",
       word,
       {"random", "lattice"},
       "random",
       "random: sequential addition, lattice: square, obstacle-gap + obstacle-diameter from centre to centre",
       false,
       [](RunParameters& run, const std::string& value) {
         run.obstacles.layout = value == "lattice" ? ObstacleLayout::lattice : ObstacleLayout::random;
       }},
      {"lattice-angle",
       number,
       {},
       "0",
       "of the lattice's rows from +x (the flow) to +y [degrees]; the nearest with a period of at most box",
       false,
       [](RunParameters& run, const std::string& value) { run.obstacles.lattice_angle = to_number(value); }},
      {"seeds",
       integer,
       {},
       "1..10",
       "one run for each: obstacle array and release follow from the seed",
       false,
       [](RunParameters& run, const std::string& value) { run.seed = in_range<std::uint32_t>(value); }},
      {"box",
       number,
       {},
       "500",
       "period of the obstacle array [sigma]",
       false,
       [](RunParameters& run, const std::string& value) { run.obstacles.box = to_number(value); }},
      {"boxes",
       integer,
       {},
       "1",
       "the array is so many boxes long, along the flow, before it repeats",
       false,
       [](RunParameters& run, const std::string& value) { run.obstacles.boxes = in_range<int>(value); }},
      {"max-time",
       number,
       {},
       "2e5",
       "longest run [t0]",
       false,
       [](RunParameters& run, const std::string& value) { run.max_time = to_number(value); }},
      {"terminal-speed",
       number,
       {},
       "0.03",
       "V_t [sqrt(sigma g)]",
       false,
       [](RunParameters& run, const std::string& value) { run.drag.terminal_speed = to_number(value); }},
      {"near-wall-drag",
       number,
       {},
       "0",
       "b_0/b_inf",
       true,
       [](RunParameters& run, const std::string& value) { run.drag.near_wall = to_number(value); }},
      {"near-wall-exponent",
       number,
       {},
       "1.3333333333333333",
       "alpha, of the near-wall drag's power of sigma/d",
       true,
       [](RunParameters& run, const std::string& value) { run.drag.near_wall_exponent = to_number(value); }},
      {"near-wall-cutoff",
       number,
       {},
       "0.00614",
       "d of the near-wall drag counts as no less [sigma]",
       true,
       [](RunParameters& run, const std::string& value) { run.drag.near_wall_cutoff = to_number(value); }},
      {"relative-drag",
       number,
       {},
       "1",
       "c, drag of motion relative to the centre of mass over b_inf",
       true,
       [](RunParameters& run, const std::string& value) { run.drag.relative = to_number(value); }},
      {"vertices",
       integer,
       {},
       "128",
       "N_v of the polygon",
       true,
       [](RunParameters& run, const std::string& value) { run.dp.vertices = in_range<int>(value); }},
      {"time-step",
       number,
       {"auto"},
       "auto",
       "[t0]; auto: the largest at which nothing stiff matters, 1e-3 is the published one",
       false,
       [](RunParameters& run, const std::string& value) { run.time_step = number_or_auto(value); }},
      {"area-stiffness",
       number,
       {"auto"},
       "auto",
       "K_a [g rho/sigma]; auto: the area keeps within 0.2 % of its rest value as long as 1e4, the published "
       "value, can hold it",
       true,
       [](RunParameters& run, const std::string& value) { run.dp.area_stiffness = number_or_auto(value); }},
      {"perimeter-spring",
       word,
       {"along", "mean", "rest"},
       "along",
       "springs of the edges pull to l0 (rest, as published), to the mean edge length, or only along the "
       "interface",
       true,
       [](RunParameters& run, const std::string& value) {
         run.dp.perimeter_spring = value == "rest"   ? PerimeterSpring::rest
                                   : value == "mean" ? PerimeterSpring::mean
                                                     : PerimeterSpring::along;
       }},
      {"perimeter-stiffness",
       number,
       {"auto"},
       "auto",
       "K_l [g rho sigma]; auto: ratio times Gamma for rest, 1 for mean, 0.003/V_t for along",
       true,
       [](RunParameters& run, const std::string& value) {
         run.dp.perimeter_stiffness = number_or_auto(value);
       }},
      {"perimeter-stiffness-ratio",
       number,
       {},
       "0.001",
       "K_l/Gamma of springs to the rest length, where perimeter-stiffness=auto",
       true,
       [](RunParameters& run, const std::string& value) {
         run.dp.perimeter_stiffness_ratio = to_number(value);
       }},
      {"wall-contact",
       word,
       {"edge", "vertex"},
       "edge",
       "a wall pushes the nearest point of every edge, or the vertices alone (as published)",
       true,
       [](RunParameters& run, const std::string& value) {
         run.dp.wall_contact = value == "edge" ? WallContact::edge : WallContact::vertex;
       }},
      {"contact-range",
       number,
       {"half-vertex"},
       "0",
       "distance from a wall's surface at which contact begins [sigma]; half-vertex: half a vertex diameter, "
       "as "
       "published",
       true,
       [](RunParameters& run, const std::string& value) {
         run.dp.contact_range =
             value == "half-vertex" ? std::nullopt : std::optional<double>(to_number(value));
       }},
      {"wall-tension",
       number,
       {},
       "1",
       "tension where the interface touches a wall, over Gamma: -cos of the contact angle",
       true,
       [](RunParameters& run, const std::string& value) { run.dp.wall_tension = to_number(value); }},
      {"self-contact",
       word,
       {"on", "off"},
       "on",
       "does the interface repel itself",
       true,
       [](RunParameters& run, const std::string& value) {
         run.dp.self_contact = value == "on" ? SelfContact::on : SelfContact::off;
       }},
      {"self-contact-range",
       number,
       {},
       "0.01227",
       "distance below which the interface repels itself [sigma]",
       true,
       [](RunParameters& run, const std::string& value) { run.dp.self_contact_range = to_number(value); }},
      {"gravity",
       word,
       {"area", "vertex"},
       "area",
       "weight and mean drag act on the area, as a pressure, or on the vertices (as published)",
       true,
       [](RunParameters& run, const std::string& value) {
         run.dp.gravity = value == "vertex" ? Gravity::vertex : Gravity::area;
       }},
      {"clog-energy",
       number,
       {},
       "1e-17",
       "clogged when E_k/E_t, the kinetic energy over that at terminal speed, stays below this",
       false,
       [](RunParameters& run, const std::string& value) { run.clog_energy = to_number(value); }},
      {"clog-detection",
       word,
       {"certified", "threshold"},
       "certified",
       "certified: a droplet that slows down is clogged once a stable equilibrium is proved to be at hand, "
       "or by "
       "clog-energy; threshold: by clog-energy only",
       false,
       [](RunParameters& run, const std::string& value) {
         run.clog_detection = value == "certified" ? ClogDetection::certified : ClogDetection::threshold;
       }},
  };
}

/// What a preset means for the keys of the interface and of its numerics.
struct Preset {
  const char* name;
  std::vector<std::pair<const char*, const char*>> texts;
};
const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = {
      {"robust",
       {{"perimeter-spring", "along"},
        {"perimeter-stiffness", "auto"},
        {"perimeter-stiffness-ratio", "0.001"},
        {"wall-contact", "edge"},
        {"contact-range", "0"},
        {"self-contact", "on"},
        {"gravity", "area"},
        {"area-stiffness", "auto"},
        {"time-step", "auto"}}},
      {"heavy-interface",
       {{"perimeter-spring", "mean"},
        {"perimeter-stiffness", "auto"},
        {"perimeter-stiffness-ratio", "0.001"},
        {"wall-contact", "edge"},
        {"contact-range", "0"},
        {"self-contact", "on"},
        {"gravity", "vertex"},
        {"area-stiffness", "auto"},
        {"time-step", "auto"}}},
      {"elastic",
       {{"perimeter-spring", "rest"},
        {"perimeter-stiffness", "auto"},
        {"perimeter-stiffness-ratio", "0.1"},
        {"wall-contact", "edge"},
        {"contact-range", "0"},
        {"self-contact", "on"},
        {"gravity", "vertex"},
        {"area-stiffness", "auto"},
        {"time-step", "auto"}}},
      {"literal",
       {{"perimeter-spring", "rest"},
        {"perimeter-stiffness", "auto"},
        {"perimeter-stiffness-ratio", "0.001"},
        {"wall-contact", "vertex"},
        {"contact-range", "half-vertex"},
        {"self-contact", "off"},
        {"gravity", "vertex"},
        {"area-stiffness", "1e4"},
        {"time-step", "1e-3"}}},
  };
  return all;
}

}  // namespace

const std::vector<Key>& keys() {
  static const std::vector<Key> all = make_keys();
  return all;
}

const Key& find_key(std::string_view name) {
  const auto key = std::find_if(keys().begin(), keys().end(), [&](const Key& k) { return k.name == name; });
  if (key != keys().end()) return *key;
  std::vector<std::string> names;
  for (const Key& k : keys()) names.push_back(k.name);
  const std::string near = did_you_mean(name, names);
  throw Error("unknown key '" + std::string(name) + "'" +
              (near.empty() ? "; --help lists the keys" : "; did you mean " + near + "?"));
}

bool is_same_value(const std::string& a, const std::string& b) {
  if (a == b) return true;
  try {
    return to_number(a) == to_number(b);
  } catch (const Error&) {
    return false;
  }
}

std::string preset_name(const RunParameters& run) {
  for (const Preset& preset : presets()) {
    RunParameters other = run;
    other.dp.perimeter_stiffness.reset();
    for (const auto& [name, text] : preset.texts) find_key(name).apply(other, text);
    if (!other.dp.contact_range) other.dp.contact_range = half_vertex_diameter(other.dp);
    if (!other.dp.perimeter_stiffness) other.dp.perimeter_stiffness = automatic_perimeter_stiffness(other);
    if (other.dp.perimeter_spring == run.dp.perimeter_spring &&
        other.dp.perimeter_stiffness == run.dp.perimeter_stiffness &&
        other.dp.wall_contact == run.dp.wall_contact && other.dp.self_contact == run.dp.self_contact &&
        other.dp.gravity == run.dp.gravity && other.dp.contact_range == run.dp.contact_range)
      return preset.name;
  }
  return "custom";
}

Settings::Settings() {
  for (const Key& key : keys()) assign(key.name, key.default_text);
}

Settings Settings::from_config(const std::string& text) {
  Settings settings;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const auto equals = line.find(" = ");
    if (equals == std::string::npos) throw Error("'" + line.substr(0, 60) + "' is not key = value");
    settings.set(line.substr(0, equals), line.substr(equals + 3));
  }
  return settings;
}

void Settings::set(const std::string& name, const std::string& text) {
  assign(name, text);
  given_.insert(name);
  if (name != "preset") return;
  for (const Preset& preset : presets())
    if (preset.name == text)
      for (const auto& [key, value] : preset.texts)
        if (!given_.contains(key)) assign(key, value);
}

void Settings::assign(const std::string& name, const std::string& text) {
  const Key& key = find_key(name);
  std::vector<std::string> values;
  try {
    if (text.size() > longest_text)
      throw Error("the list is too long to be stored; ranges like 1..15000 are short");
    values = expand_list(text, key.kind, key.words);
    for (const std::string& value : values) {
      RunParameters scratch;
      key.apply(scratch, value);
    }
    if (key.kind == ValueKind::word && values.size() > 1) throw Error("takes one value, not a list");
  } catch (const Error& error) {
    const std::string shown = text.size() > 60 ? text.substr(0, 60) + "..." : text;
    throw Error("invalid " + name + "=" + shown + " (" + error.what() + ")");
  }
  texts_[name] = text;
  values_[name] = std::move(values);
}

std::string Settings::to_config(bool with_comments) const {
  std::ostringstream out;
  for (const Key& key : keys()) {
    if (with_comments) out << "# " << key.help << '\n';
    out << key.name << " = " << text(key.name) << '\n';
  }
  return out.str();
}

}  // namespace clog::sweep
