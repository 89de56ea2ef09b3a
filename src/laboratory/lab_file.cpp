#include "clog/laboratory/lab_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <vector>

#include "clog/console/csv.hpp"
#include "clog/console/text_file.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/excerpt.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::laboratory {
namespace {

using Entries = std::map<std::string, std::string>;

/// The kind of quantity of each key; the ratio is a plain number.
const std::map<std::string, std::string>& known_keys() {
  static const std::map<std::string, std::string> keys = {{"diameter", "length"},
                                                          {"thickness", "length"},
                                                          {"density", "density"},
                                                          {"outer-density", "density"},
                                                          {"tension", "tension"},
                                                          {"angle", "angle"},
                                                          {"density-difference", "density"},
                                                          {"speed", "speed"},
                                                          {"tension-ratio", ""},
                                                          {"speed-diameter", "length"},
                                                          {"speed-angle", "angle"},
                                                          {"speed-exponent", ""}};
  return keys;
}

[[noreturn]] void refuse_key(const std::string& key, int line) {
  std::vector<std::string> names;
  names.reserve(known_keys().size());
  for (const auto& [name, units] : known_keys()) names.push_back(name);
  const std::string near = did_you_mean(key, names);
  throw Error(fmt::format("line {}: unknown key '{}'{} (known: {})", line, excerpt(key),
                          near.empty() ? "" : "; did you mean " + near + '?', joined(names)));
}

Entries entries_of(const std::string& text) {
  Entries entries;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream parts(line.substr(0, line.find('#')));
    for (std::string part; std::getline(parts, part, ';');) {
      const std::string words = console::trimmed(part);
      if (words.empty()) continue;
      const auto equals = words.find('=');
      if (equals == std::string::npos)
        throw Error(fmt::format("line {}: '{}' is not key = value", number, excerpt(words)));
      const std::string key = console::trimmed(words.substr(0, equals));
      if (!known_keys().contains(key)) refuse_key(key, number);
      if (!entries.emplace(key, console::trimmed(words.substr(equals + 1))).second)
        throw Error(fmt::format("line {}: {} stands there twice", number, key));
    }
  }
  return entries;
}

double pure_number(const std::string& text) try {
  return sweep::to_number(text);
} catch (const sweep::NumberWithUnit& error) {
  throw Error(std::string(error.what()) + "; it is a pure number, write it without a unit");
}

/// A key's value in SI units; `otherwise` if the file does not have the key.
double value_of(const Entries& entries, const std::string& key, double otherwise) {
  const auto found = entries.find(key);
  if (found == entries.end()) return otherwise;
  try {
    const std::string& units = known_keys().at(key);
    if (found->second.find(',') != std::string::npos)
      throw Error("one value is needed; diameter, angle and speed may be lists");
    const double value = units.empty() ? pure_number(found->second) : to_si(found->second, units);
    if (value > 0 || (value == 0 && key == "speed-exponent")) return value;
    throw Error("must be positive");
  } catch (const Error& error) {
    throw Error(fmt::format("invalid {}={} ({})", key, found->second, error.what()));
  }
}

/// A key's value in the usual unit, so that 1000 um and 1.0 mm describe the same laboratory.
std::string usual_text(const Entries& entries, const std::string& key) {
  const double value = value_of(entries, key, 0);
  const std::string& units = known_keys().at(key);
  return units.empty() ? shortest(value) : in_usual_unit(value, units);
}

constexpr const char* scaling_keys[] = {"speed-diameter", "speed-angle", "speed-exponent"};

bool scales_speed(const Entries& entries) {
  return std::ranges::any_of(scaling_keys, [&](const char* key) { return entries.contains(key); });
}

constexpr double largest_length = 0.1;  // [m]
constexpr double densest_gas = 100;     // [kg/m^3]

constexpr double right_angle = std::numbers::pi / 2 * (1 + 1e-12);

/// Scales the measured speed to the droplet and the tilt of this laboratory.
void scale_speed(Laboratory& lab, const Entries& entries) {
  Experiment& at = lab.experiment;
  if (at.terminal_speed == 0) throw Error("has no speed, which speed-diameter, -angle and -exponent scale");
  lab.measured = {.speed = at.terminal_speed,
                  .diameter = value_of(entries, "speed-diameter", at.diameter),
                  .tilt = value_of(entries, "speed-angle", at.tilt),
                  .exponent = value_of(entries, "speed-exponent", 0)};
  if (lab.measured->tilt > right_angle)
    throw Error(fmt::format("invalid speed-angle={} (beyond 90 degrees)", entries.at("speed-angle")));
  at.terminal_speed *= std::sin(at.tilt) / std::sin(lab.measured->tilt) *
                       std::pow(at.diameter / lab.measured->diameter, lab.measured->exponent);
}

Laboratory laboratory_of(const Entries& entries) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  constexpr double octane = 703, water = 997;  // densities in Cheng et al. [kg/m^3]
  Laboratory lab;
  lab.experiment = {.diameter = value_of(entries, "diameter", 0),
                    .terminal_speed = value_of(entries, "speed", 0),
                    .tilt = value_of(entries, "angle", 0),
                    .droplet_density = value_of(entries, "density", octane),
                    .outer_density = value_of(entries, "outer-density", water),
                    .interfacial_tension = value_of(entries, "tension", unknown)};
  if (entries.contains("density-difference")) {
    if (entries.contains("outer-density"))
      throw Error("has outer-density and density-difference, and one follows from the other; leave one out");
    lab.experiment.outer_density =
        lab.experiment.droplet_density + value_of(entries, "density-difference", unknown);
  }
  lab.thickness = value_of(entries, "thickness", unknown);
  lab.tension_ratio = value_of(entries, "tension-ratio", lab.tension_ratio);
  lab.has_own_ratio = entries.contains("tension-ratio");
  if (lab.experiment.diameter > largest_length)
    throw Error(fmt::format("invalid diameter={} (a droplet wider than {} m; is the unit right?)",
                            entries.at("diameter"), largest_length));
  if (lab.experiment.tilt > right_angle)
    throw Error(fmt::format("invalid angle={} (beyond 90 degrees)", entries.at("angle")));
  if (lab.experiment.droplet_density == lab.experiment.outer_density)
    throw Error("density and outer-density are equal: nothing drives the droplet");
  if (scales_speed(entries)) scale_speed(lab, entries);
  constexpr double fastest = 10;
  if (const double speed = lab.experiment.reduced_terminal_speed(); speed > fastest)
    throw Error(
        fmt::format("invalid speed={} (V_t = {:.3g}, of such a droplet, is above {}; is the unit right?)",
                    entries.at("speed"), speed, fastest));
  for (const auto& [key, given] : entries)
    lab.text += fmt::format("{}{} = {}", lab.text.empty() ? "" : "; ", key, usual_text(entries, key));
  return lab;
}

/// The values of a list; empty for a missing key.
std::vector<std::string> values_of(const Entries& entries, const std::string& key) {
  const auto found = entries.find(key);
  if (found == entries.end()) return {};
  const std::vector<std::string_view> values = sweep::split_list(found->second);
  return {values.begin(), values.end()};
}

/// One set of entries for each droplet at each tilt.
std::vector<Entries> sets_of(const Entries& entries) {
  for (const auto& [key, example] : {std::pair{"diameter", "3.5 mm"}, {"angle", "28 deg"}})
    if (!entries.contains(key))
      throw Error(fmt::format("has no {0}; write for example {0} = {1}", key, example));
  const std::vector<std::string> diameters = values_of(entries, "diameter"),
                                 angles = values_of(entries, "angle"), speeds = values_of(entries, "speed");
  const std::size_t num_sets = diameters.size() * angles.size();
  if (speeds.size() > 1 && speeds.size() != num_sets)
    throw Error(
        fmt::format("has {} values of speed for {} (diameters times angles); give one for each, with "
                    "the angles of the first diameter first, or one for all",
                    speeds.size(), count_text(std::ssize(diameters) * std::ssize(angles), "set")));
  if (speeds.size() > 1 && scales_speed(entries))
    throw Error(
        "has a speed for each set, so speed-diameter, -angle and -exponent have no meaning; leave "
        "them out");
  std::vector<Entries> sets;
  sets.reserve(num_sets);
  for (const std::string& diameter : diameters)
    for (const std::string& angle : angles) {
      Entries one = entries;
      if (speeds.size() > 1) one["speed"] = speeds[sets.size()];
      one["diameter"] = diameter;
      one["angle"] = angle;
      if (num_sets > 1 && speeds.size() == 1) {
        one.emplace("speed-diameter", diameters.front());
        one.emplace("speed-angle", angles.front());
        one.emplace("speed-exponent", "0");
      }
      sets.push_back(std::move(one));
    }
  return sets;
}

std::vector<Laboratory> parse_laboratories(const std::string& text, const std::string& source) {
  try {
    std::vector<Laboratory> all;
    for (const Entries& entries : sets_of(entries_of(text))) all.push_back(laboratory_of(entries));
    return all;
  } catch (const Error& error) {
    throw Error(source + " " + error.what());
  }
}

/// Refuses values that follow from a wrong unit. Laboratories stored with rows are not checked, so that old
/// sweeps remain readable. @throws Error
void refuse_unlikely_values(const Entries& entries, const std::string& path) {
  constexpr double densest = 25000, lightest = 0.05;  // denser than all liquids, lighter than all gases
  const auto refuse = [&](const std::string& key, const std::string& why) {
    throw Error(fmt::format("{} invalid {}={} ({}; is the unit right?)", path, key, entries.at(key), why));
  };
  if (value_of(entries, "thickness", 0) > largest_length)
    refuse("thickness", fmt::format("a cell thicker than {} m", largest_length));
  for (const std::string key : {"density", "outer-density", "density-difference"}) {
    const double density = value_of(entries, key, densest_gas);
    if (density > densest) refuse(key, fmt::format("above {} kg/m^3", densest));
    if (density < lightest && key != "density-difference")
      refuse(key, fmt::format("below {} kg/m^3", lightest));
  }
}

Laboratory only_one(std::vector<Laboratory> all, const std::string& source, const std::string& remedy) {
  if (all.size() == 1) return std::move(all.front());
  throw Error(
      fmt::format("{} describes {} droplets, but only one has a place here; {}", source, all.size(), remedy));
}

}  // namespace

std::string unusual_density(const Laboratory& lab) {
  for (const auto& [what, density] : {std::pair{"droplet", lab.experiment.droplet_density},
                                      {"liquid around the droplet", lab.experiment.outer_density}})
    if (density < densest_gas)
      return fmt::format("the density of the {}, {:.4g} kg/m^3, is that of a gas; is the unit right?", what,
                         density);
  return "";
}

std::string law_of_speed(const Laboratory& lab) {
  if (!lab.measured) return "";
  constexpr double milli = 1e-3, degree = std::numbers::pi / 180;
  return fmt::format(
      "the terminal speed, {:.4g} mm/s at {:.4g} mm and {:.4g} degrees, is scaled with sin(angle) and "
      "diameter^{:.4g} (speed-exponent); a list of measured speeds replaces this law",
      lab.measured->speed / milli, lab.measured->diameter / milli, lab.measured->tilt / degree,
      lab.measured->exponent);
}

Laboratory parse_laboratory(const std::string& text, const std::string& source, const std::string& remedy) {
  return only_one(parse_laboratories(text, source), source, remedy);
}

std::vector<Laboratory> read_laboratories(const std::string& path) {
  const std::string text = console::read_text(path);
  std::vector<Laboratory> all = parse_laboratories(text, path);
  refuse_unlikely_values(entries_of(text), path);
  return all;
}

Laboratory read_laboratory(const std::string& path, const std::string& remedy) {
  return only_one(read_laboratories(path), path, remedy);
}

}  // namespace clog::laboratory
