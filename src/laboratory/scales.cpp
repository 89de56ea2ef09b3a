#include "clog/laboratory/scales.hpp"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/sweep/keys.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::laboratory {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A droplet on a wall that it does not wet.
struct Puddle {
  double height = 0, area = 0, moment = 0;  ///< `moment` is that of the depth below the apex
};

/// Integrates the Young-Laplace equation along the interface by the fourth-order Runge-Kutta rule: phi' =
/// kappa_0 + z/Gamma, x' = cos(phi), z' = sin(phi), area' = 2 x z'. Here z is the depth below the apex, and
/// phi the angle of the slope, from 0 at the apex to pi at the wall.
Puddle puddle(double line_tension, double apex_curvature) {
  using State = Eigen::Array<double, 5, 1>;  // phi, x, z, area, moment
  // At the rim of a puddle, the interface bends over a length of sqrt(Gamma). A small droplet has a radius of
  // curvature of 1/2.
  const double step = 0.02 * std::min(0.5, std::sqrt(line_tension));
  const auto slope = [&](const State& y) {
    const double deepening = std::sin(y[0]);
    return State(apex_curvature + y[2] / line_tension, std::cos(y[0]), deepening, 2 * y[1] * deepening,
                 2 * y[1] * y[2] * deepening);
  };
  State y = State::Zero();
  for (bool is_at_wall = false; !is_at_wall;) {
    const State k1 = slope(y);
    const double rest = (std::numbers::pi - y[0]) / k1[0];
    is_at_wall = rest <= step;
    const double h = is_at_wall ? rest : step;
    const State k2 = slope(y + h / 2 * k1), k3 = slope(y + h / 2 * k2), k4 = slope(y + h * k3);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return {.height = y[2], .area = y[3], .moment = y[4]};
}

/// Root of a monotonic function of a positive variable. The search uses the logarithm of the variable.
template <class Function>
double root(Function function, double low, double high) {
  std::uintmax_t most_steps = 200;
  constexpr int bits = 40;
  const auto [below, above] = boost::math::tools::toms748_solve(
      [&](double logarithm) { return function(std::exp(logarithm)); }, std::log(low), std::log(high),
      boost::math::tools::eps_tolerance<double>(bits), most_steps);
  return std::exp((below + above) / 2);
}

constexpr double softest = 1e-3, stiffest = 1e4;  // Gamma

double sag_of(double line_tension) {
  constexpr double flattest = 1e-120, roundest = 2;  // curvature of the apex; a circle has 2
  const auto excess = [&](double curvature) {
    return puddle(line_tension, curvature).area - units::rest_area;
  };
  const Puddle drop = puddle(line_tension, root(excess, flattest, roundest));
  return units::droplet_diameter / 2 - (drop.height - drop.moment / drop.area);
}

}  // namespace

double sag_on_wall(double line_tension) {
  return line_tension >= softest && line_tension <= stiffest ? sag_of(line_tension) : unknown;
}

double line_tension_of_sag(double sag) {
  if (!(sag < sag_of(softest) && sag > sag_of(stiffest))) return unknown;
  return root([&](double line_tension) { return sag_of(line_tension) - sag; }, softest, stiffest);
}

double wall_stiffness_of_sag(double sag) { return std::numbers::pi / (16 * sag); }

Scales scales_of(const Laboratory& lab) {
  const Experiment& at = lab.experiment;
  const double per_line_tension = at.gravity() * at.droplet_density * at.diameter * at.diameter;
  const bool is_speed_known = at.terminal_speed > 0;
  Scales scales{.length = at.diameter,
                .gravity = at.gravity(),
                .time = std::sqrt(at.diameter / at.gravity()),
                .speed = is_speed_known ? at.terminal_speed : unknown,
                .tension = per_line_tension / lab.tension_ratio,
                .line_tension_experiment = at.line_tension(),
                .line_tension = lab.tension_ratio * at.line_tension(),
                .terminal_speed = is_speed_known ? at.reduced_terminal_speed() : unknown,
                .line_tension_of_cell = at.interfacial_tension * lab.thickness,
                .break_up_neck = lab.thickness / at.diameter};
  scales.capillary_number = units::droplet_mass * units::gravity / scales.line_tension;
  scales.sag = std::isnan(scales.line_tension) ? unknown : sag_on_wall(scales.line_tension);
  scales.wall_stiffness = wall_stiffness_of_sag(scales.sag);
  return scales;
}

namespace {

/// The value with four digits, because a measurement is not more precise. Empty if the value is unknown.
std::string rounded_text(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : ""; }

}  // namespace

std::string line_tension_text(const Scales& scales) { return rounded_text(scales.line_tension); }

Texts droplet_texts(const Laboratory& lab, const sweep::Settings& settings, const std::string& model,
                    bool has_daughters) {
  const Scales scales = scales_of(lab);
  Texts texts = {{"laboratory", lab.text}};
  const auto set = [&](const char* key, double value) {
    if (std::isfinite(value) && !settings.is_given(key)) texts[key] = rounded_text(value);
  };
  set("terminal-speed", scales.terminal_speed);
  if (model == "dp") set("line-tension", scales.line_tension);
  if (model == "sp") set("wall-stiffness", scales.wall_stiffness);
  if (has_daughters && lab.measured) set("speed-exponent", lab.measured->exponent);
  return texts;
}

namespace {

/// Replaces each number that has a unit. @param convert  returns the replacement for a number and its unit
template <class Convert>
std::string without_units(const std::string& text, const Convert& convert) {
  static const std::regex number_with_unit(
      "[-+]?([0-9.]+(?:[eE][-+]?[0-9]+)?) *(/?(?:[A-Za-z]|\xc2\xb5|\xce\xbc)(?:[A-Za-z/^2]|\xc2\xb2)*)");
  std::string converted;
  const char* rest = text.data();
  for (const std::string_view written : sweep::numbers_in(text)) {
    std::cmatch parts;
    if (!std::regex_match(written.data(), written.data() + written.size(), parts, number_with_unit)) continue;
    converted.append(rest, parts[1].first);
    rest = parts[2].second;
    converted += convert(parts[1].str(), parts[2].str());
  }
  return converted.append(rest, text.data() + text.size());
}

/// @param unit  a name of a unit, or sigma. @param size  the model's unit of the quantity [SI]
std::string in_model_unit(const std::string& number, const std::string& unit, const std::string& quantity,
                          double size) {
  constexpr int digits = 13;  // circles in a file have as many digits
  if (unit == "sigma" || unit == "/sigma^2") return number;
  return fmt::format("{:.{}g}", to_si(number + unit, quantity) / size, digits);
}

/// A unit of the model: the quantity, and the unit's size in the laboratory [SI].
struct ModelUnit {
  std::string quantity;
  double size;
};

/// The model's unit of a key; nullopt if numbers of the key have no unit.
std::optional<ModelUnit> model_unit_of(const std::string& key, const Scales& scales) {
  const sweep::Key& known = sweep::find_key(key);
  const std::map<std::string, ModelUnit> units = {
      {"sigma", {"length", scales.length}},
      {"1/sigma^2", {"number per area", 1 / (scales.length * scales.length)}},
      {"t0", {"time", scales.time}},
      {"sqrt(sigma g)", {"speed", scales.length / scales.time}},
      {"g rho sigma^2", {"tension", scales.tension}}};
  const auto unit = units.find(known.parameter ? known.parameter->unit : "");
  return unit == units.end() ? std::nullopt : std::optional(unit->second);
}

}  // namespace

std::string in_model_units(const std::string& key, const std::string& text, const Scales& scales) {
  const std::optional<ModelUnit> unit = model_unit_of(key, scales);
  try {
    return without_units(text, [&](const std::string& number, const std::string& its_unit) {
      if (!unit) throw Error(fmt::format("numbers have no unit here; write {} without {}", number, its_unit));
      return in_model_unit(number, its_unit, unit->quantity, unit->size);
    });
  } catch (const Error& error) {
    throw Error(fmt::format("invalid {}={} ({})", key, text, error.what()));
  }
}

std::string in_laboratory_units(const std::string& key, double value, const Scales& scales) {
  const std::optional<ModelUnit> unit = model_unit_of(key, scales);
  return unit ? in_usual_unit(sweep::to_number(rounded_text(value * unit->size)), unit->quantity) : "";
}

std::string in_diameters(const std::string& text, double diameter) {
  return without_units(text, [&](const std::string& number, const std::string& unit) {
    if (unit != "sigma" && std::isnan(diameter))
      throw Error(number + unit + " has a unit, but the droplet's diameter is not known; add --lab FILE");
    return in_model_unit(number, unit, "length", diameter);
  });
}

double line_tension_upright(const Laboratory& lab) {
  Experiment upright = lab.experiment;
  upright.tilt = std::numbers::pi / 2;
  return lab.tension_ratio * upright.line_tension();
}

double tilt_of(double line_tension, const Laboratory& lab) {
  return std::asin(line_tension_upright(lab) / line_tension);
}

}  // namespace clog::laboratory
