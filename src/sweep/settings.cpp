#include "clog/sweep/settings.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

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
      {"vertices",
       integer,
       {},
       "256",
       "N_v of the polygon",
       true,
       [](RunParameters& run, const std::string& value) { run.dp.vertices = in_range<int>(value); }},
      {"time-step",
       number,
       {},
       "1e-3",
       "[t0]",
       false,
       [](RunParameters& run, const std::string& value) { run.time_step = to_number(value); }},
      {"area-stiffness",
       number,
       {},
       "1e4",
       "K_a [g rho/sigma]",
       true,
       [](RunParameters& run, const std::string& value) { run.dp.area_stiffness = to_number(value); }},
      {"perimeter-spring",
       word,
       {"rest", "mean"},
       "mean",
       "springs of the edges pull to l0 (rest, the paper) or to the mean edge length",
       true,
       [](RunParameters& run, const std::string& value) {
         run.dp.perimeter_spring = value == "rest" ? PerimeterSpring::rest : PerimeterSpring::mean;
       }},
      {"perimeter-stiffness",
       number,
       {"auto"},
       "auto",
       "K_l [g rho sigma]; auto: 1e-3 Gamma for rest, 1 for mean",
       true,
       [](RunParameters& run, const std::string& value) {
         run.dp.perimeter_stiffness = number_or_auto(value);
       }},
      {"self-contact",
       word,
       {"on", "off"},
       "on",
       "does the interface repel itself",
       true,
       [](RunParameters& run, const std::string& value) {
         run.dp.self_contact = value == "on" ? SelfContact::on : SelfContact::off;
       }},
      {"gravity",
       word,
       {"vertex", "area"},
       "vertex",
       "the weight acts on the vertices (the paper) or the area",
       true,
       [](RunParameters& run, const std::string& value) {
         run.dp.gravity = value == "vertex" ? Gravity::vertex : Gravity::area;
       }},
      {"clog-energy",
       number,
       {},
       "1e-17",
       "clogged when E_k/E_t stays below this",
       false,
       [](RunParameters& run, const std::string& value) { run.clog_energy = to_number(value); }},
  };
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

Settings::Settings() {
  for (const Key& key : keys()) set(key.name, key.default_text);
}

Settings Settings::from_config(const std::string& text) {
  Settings settings;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (const auto equals = line.find(" = "); equals != std::string::npos && line[0] != '#')
      settings.set(line.substr(0, equals), line.substr(equals + 3));
  return settings;
}

void Settings::set(const std::string& name, const std::string& text) {
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
