#include "clog/laboratory/experiment.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <numbers>
#include <string_view>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::laboratory {
namespace {

// Tables are made on first use, because a failed allocation before main() could not be reported.

/// The units of a quantity, and the value of each unit in SI units.
const std::map<std::string, double>& known_units(const std::string& quantity) {
  static const std::map<std::string, std::map<std::string, double>> units = {
      {"length", {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}}},
      {"number per area", {{"/m^2", 1}, {"/cm^2", 1e4}, {"/mm^2", 1e6}, {"/um^2", 1e12}}},
      {"time", {{"s", 1}, {"min", 60}, {"h", 3600}}},
      {"speed", {{"m/s", 1}, {"cm/s", 1e-2}, {"mm/s", 1e-3}, {"um/s", 1e-6}}},
      {"tension", {{"N/m", 1}, {"mN/m", 1e-3}, {"J/m^2", 1}, {"mJ/m^2", 1e-3}}},
      {"density", {{"kg/m^3", 1}, {"g/cm^3", 1e3}, {"g/ml", 1e3}}},
      {"angle", {{"deg", std::numbers::pi / 180}, {"°", std::numbers::pi / 180}, {"rad", 1}}}};
  return units.at(quantity);
}

/// A common spelling of a unit: u instead of the micro sign (which has two code points), and ^2 and ^3
/// instead of other forms of powers, as in mm2 and mm².
std::string plain_unit(std::string unit) {
  const std::pair<const char*, const char*> forms[] = {{"µ", "u"}, {"μ", "u"}, {"²", "^2"}, {"³", "^3"}};
  for (const auto& [form, plain] : forms)
    if (const auto found = unit.find(form); found != std::string::npos)
      unit.replace(found, std::strlen(form), plain);
  if (unit.ends_with("m2") || unit.ends_with("m3")) unit.insert(unit.size() - 1, "^");
  return unit;
}

const std::string& usual_unit(const std::string& quantity) {
  static const std::map<std::string, std::string> units = {
      {"length", "mm"},    {"number per area", "/mm^2"}, {"time", "s"},   {"speed", "mm/s"},
      {"tension", "mN/m"}, {"density", "g/ml"},          {"angle", "deg"}};
  return units.at(quantity);
}

std::string names_of_units(const std::string& quantity) {
  std::string names;
  for (const auto& [name, factor] : known_units(quantity)) names += (names.empty() ? "" : ", ") + name;
  return names;
}

/// Factor of a unit. @throws Error
double si_factor(const std::string& unit, const std::string& units) {
  const auto& known = known_units(units);
  if (const auto found = known.find(plain_unit(unit)); found != known.end()) return found->second;
  throw Error("unknown unit '" + unit + "' for " + units + " (known: " + names_of_units(units) + ")");
}

}  // namespace

double to_si(const std::string& text, const std::string& units) {
  char* rest = nullptr;
  std::strtod(text.c_str(), &rest);
  const auto end = static_cast<std::size_t>(rest - text.c_str());
  const std::size_t unit = text.find_first_not_of(' ', end);
  if (unit == std::string::npos)
    throw Error("'" + text + "' has no unit; write the unit of your " + units +
                " after the number: " + names_of_units(units));
  return sweep::to_number(text.substr(0, end)) * si_factor(text.substr(unit), units);
}

std::string in_usual_unit(double value, const std::string& units) {
  const std::string& unit = usual_unit(units);
  return shortest(twelve_digits(value / known_units(units).at(unit))) + ' ' + unit;
}

double Experiment::gravity() const {
  constexpr double earth = 9.81;  // [m/s^2]
  return std::sin(tilt) * earth * std::abs(outer_density - droplet_density) / droplet_density;
}

double Experiment::reduced_terminal_speed() const { return terminal_speed / std::sqrt(diameter * gravity()); }

double Experiment::line_tension() const {
  return interfacial_tension / (gravity() * droplet_density * diameter * diameter);
}

}  // namespace clog::laboratory
