#include "clog/laboratory/lab_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <sstream>
#include <vector>

#include "clog/console/csv.hpp"
#include "clog/console/text_file.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/excerpt.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::laboratory {
namespace {

using Entries = std::map<std::string, std::string>;

/// The quantity that each key gives; the ratio is a plain number.
const std::map<std::string, std::string>& known_keys() {
  static const std::map<std::string, std::string> keys = {
      {"diameter", "length"}, {"thickness", "length"}, {"density", "density"}, {"outer-density", "density"},
      {"tension", "tension"}, {"angle", "angle"},      {"speed", "speed"},     {"tension-ratio", ""}};
  return keys;
}

std::string names_of_keys() {
  std::vector<std::string> names;
  names.reserve(known_keys().size());
  for (const auto& [name, units] : known_keys()) names.push_back(name);
  return joined(names);
}

Entries entries_of(const std::string& text) {
  Entries entries;
  std::string in_lines = text;
  std::ranges::replace(in_lines, ';', '\n');
  std::istringstream lines(in_lines);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::string words = console::trimmed(line.substr(0, line.find('#')));
    if (words.empty()) continue;
    const auto equals = words.find('=');
    if (equals == std::string::npos)
      throw Error(fmt::format("line {}: '{}' is not key = value", number, excerpt(words)));
    const std::string key = console::trimmed(words.substr(0, equals));
    if (!known_keys().contains(key))
      throw Error(
          fmt::format("line {}: unknown key '{}' (known: {})", number, excerpt(key), names_of_keys()));
    if (!entries.emplace(key, console::trimmed(words.substr(equals + 1))).second)
      throw Error(fmt::format("line {}: {} stands there twice", number, key));
  }
  return entries;
}

/// A key's value in SI units; `otherwise` if the file does not have the key.
double value_of(const Entries& entries, const std::string& key, double otherwise) {
  const auto found = entries.find(key);
  if (found == entries.end()) return otherwise;
  try {
    const std::string& units = known_keys().at(key);
    const double value = units.empty() ? sweep::to_number(found->second) : to_si(found->second, units);
    if (value > 0) return value;
    throw Error("must be positive");
  } catch (const Error& error) {
    throw Error(fmt::format("invalid {}={} ({})", key, found->second, error.what()));
  }
}

Laboratory laboratory_of(const Entries& entries) {
  for (const auto& [key, example] : {std::pair{"diameter", "3.5 mm"}, {"angle", "28 deg"}})
    if (!entries.contains(key))
      throw Error(fmt::format("has no {0}; write for example {0} = {1}", key, example));
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  constexpr double octane = 703, water = 997;  // of the article [kg/m^3]
  Laboratory lab;
  lab.experiment = {.diameter = value_of(entries, "diameter", 0),
                    .terminal_speed = value_of(entries, "speed", 0),
                    .tilt = value_of(entries, "angle", 0),
                    .droplet_density = value_of(entries, "density", octane),
                    .outer_density = value_of(entries, "outer-density", water),
                    .interfacial_tension = value_of(entries, "tension", unknown)};
  lab.thickness = value_of(entries, "thickness", unknown);
  lab.tension_ratio = value_of(entries, "tension-ratio", lab.tension_ratio);
  constexpr double largest = 0.1;  // [m]
  if (lab.experiment.diameter > largest)
    throw Error(fmt::format("invalid diameter={} (a droplet wider than {} m; is the unit right?)",
                            entries.at("diameter"), largest));
  constexpr double right_angle = std::numbers::pi / 2 * (1 + 1e-12);
  if (lab.experiment.tilt > right_angle)
    throw Error(fmt::format("invalid angle={} (beyond 90 degrees)", entries.at("angle")));
  if (lab.experiment.droplet_density == lab.experiment.outer_density)
    throw Error("density and outer-density are equal: nothing drives the droplet");
  constexpr double fastest = 10;
  if (const double speed = lab.experiment.reduced_terminal_speed(); speed > fastest)
    throw Error(
        fmt::format("invalid speed={} (V_t = {:.3g}, of such a droplet, is above {}; is the unit right?)",
                    entries.at("speed"), speed, fastest));
  for (const auto& [key, value] : entries)
    lab.text += fmt::format("{}{} = {}", lab.text.empty() ? "" : "; ", key, value);
  return lab;
}

}  // namespace

Laboratory parse_laboratory(const std::string& text, const std::string& source) {
  try {
    return laboratory_of(entries_of(text));
  } catch (const Error& error) {
    throw Error(source + " " + error.what());
  }
}

Laboratory read_laboratory(const std::string& path) {
  return parse_laboratory(console::read_text(path), path);
}

}  // namespace clog::laboratory
