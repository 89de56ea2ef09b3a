#include "clogfit_units.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/console/build_info.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/json_text.hpp"
#include "clog/console/rounded.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/polygon/forces/automatic_values.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/laboratory/scales.hpp"

namespace clog::programs {
namespace {

using laboratory::Laboratory;
using laboratory::Scales;
using Json = nlohmann::ordered_json;

constexpr const char* units_usage =
    R"(clogfit units converts between a laboratory's quantities and the model's numbers, in which the droplet's diameter
sigma, the gravity g along the plates and the droplet's density rho are 1.

  clogfit units lab.cfg
  clogfit units lab.cfg --length 24 --time 2000          converts from the model to mm and s
  clogfit units lab.cfg --line-tension 0.16,0.2          interfacial tension, or tilt, for each Gamma
  clogsweep --lab lab.cfg ... ; clogfit sweep.h5         prints the results of a sweep in both units

lab.cfg has lines key = value:

  diameter = 3.5 mm           of the undeformed droplet, seen from above
  angle = 28 deg              of the plates against the horizontal; 90 deg: upright
  speed = 7 mm/s              terminal, far from walls
  tension = 9.6 mN/m          interfacial
  density = 0.703 g/ml        of the droplet (default)
  outer-density = 0.997 g/ml  of the liquid around it (default), or density-difference = 0.294 g/ml
  thickness = 0.4 mm          of the cell
  tension-ratio = 0.3         Gamma of the model divided by Gamma_exp (default)

diameter and angle are required, and may be lists, such as 0.8 mm, 1.2 mm. Then speed is a list with one value for each
droplet, or a single value, measured at speed-diameter and speed-angle (by default the first value of each list). A single
value is scaled with sin(angle) and with diameter to the power of speed-exponent (0 by default).

Gamma_exp = gamma/(g_exp rho sigma^2) is the line tension that follows from the interfacial tension gamma. The
two-dimensional model, however, reproduces the measured motion of the article's droplets with 0.3 Gamma_exp. clogfit
calibrate finds this ratio for your droplet.
)";

constexpr double milli = 1e-3;
constexpr double degree = std::numbers::pi / 180;

/// A line of the answer: quantity, laboratory, model.
using Line = std::vector<std::string>;

std::string with_unit(double value, const char* unit, const std::string& otherwise = "-") {
  if (!std::isfinite(value)) return otherwise;
  return console::plain(value) + (*unit ? " " : "") + unit;
}

std::string lines_text(const std::vector<Line>& lines) {
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const Line& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text;
  for (const Line& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i)
      text += i + 1 < line.size() ? fmt::format("{:{}}  ", line[i], widths[i]) : line[i];
    text += '\n';
  }
  return text;
}

/// A remark on the default ratio of Gamma and Gamma_exp; empty if the file gives the ratio, or Gamma is
/// unknown.
std::string caution_about_ratio(const Laboratory& lab) {
  if (lab.has_own_ratio || std::isnan(lab.experiment.interfacial_tension)) return "";
  return " (ratio of one article's droplets; calibrate yours: handbook, tutorial/calibrated-droplet)";
}

std::vector<Line> lines_of(const Laboratory& lab, const Scales& scales) {
  const auto equals = [](const char* symbol, double value) {
    return std::isfinite(value) ? fmt::format("{} = {}", symbol, console::plain(value)) : std::string("-");
  };
  std::vector<Line> lines = {
      {"", "laboratory", "model"},
      {"droplet's diameter", with_unit(scales.length / milli, "mm"), "sigma = 1"},
      {"gravity along the plates, less buoyancy", with_unit(scales.gravity, "m/s^2"), "g = 1"},
      {"unit of time, sqrt(sigma/g)", with_unit(scales.time, "s"), "t0 = 1"},
      {"terminal speed", with_unit(scales.speed / milli, "mm/s"), equals("V_t", scales.terminal_speed)},
      {"interfacial tension", with_unit(lab.experiment.interfacial_tension / milli, "mN/m"),
       equals("Gamma_exp", scales.line_tension_experiment)},
      {fmt::format("line tension of the model, {} Gamma_exp", console::plain(lab.tension_ratio)), "",
       equals("Gamma", scales.line_tension) + caution_about_ratio(lab)},
      {"soft disk with the droplet's sag on a flat wall", with_unit(scales.sag * scales.length / milli, "mm"),
       equals("E_w", scales.wall_stiffness)},
      {"capillary number at the terminal speed", "", equals("Ca", scales.capillary_number)}};
  if (!std::isnan(lab.thickness)) {
    lines.push_back({"line tension of the cell, tension times thickness",
                     with_unit(scales.line_tension_of_cell / (milli * milli), "uN"), ""});
    constexpr double largest_neck = 0.5;
    const char* neck = scales.break_up_neck > largest_neck
                           ? "width of a neck that breaks: the cell's thickness (too wide for break-up-neck)"
                           : "width of a neck that breaks: the cell's thickness";
    lines.push_back(
        {neck, with_unit(lab.thickness / milli, "mm"), equals("break-up-neck", scales.break_up_neck)});
  }
  return lines;
}

/// Explains why no tilt gives a droplet this Gamma.
std::string why_no_tilt(const Laboratory& lab) {
  if (std::isnan(lab.experiment.interfacial_tension)) return "not known without tension in lab.cfg";
  return fmt::format("none: even upright, Gamma is {}",
                     console::plain(laboratory::line_tension_upright(lab)));
}

/// Converts the number of an option, in the model's units, to a quantity of the laboratory.
struct Conversion {
  const char *option, *symbol;
  const char *name, *what, *unit;
  std::function<double(double)> convert;  ///< returns NaN if the laboratory has no such quantity
  std::string otherwise = "-";            ///< shown instead of NaN
};
std::vector<Conversion> conversions(const Laboratory& lab, const Scales& scales) {
  const auto times = [](double unit) { return [unit](double model) { return model * unit; }; };
  return {
      {"length", "r/sigma", "length_mm", "length", "mm", times(scales.length / milli)},
      {"time", "t/t0", "time_s", "time", "s", times(scales.time)},
      {"line-tension", "Gamma", "tension_mN_per_m", "interfacial tension at this tilt", "mN/m",
       times(scales.tension / milli)},
      {"line-tension", "Gamma", "angle_degrees", "or tilt with this tension", "deg",
       [&lab](double model) { return laboratory::tilt_of(model, lab) / degree; }, why_no_tilt(lab)},
      {"terminal-speed", "V_t", "speed_mm_per_s", "terminal speed", "mm/s",
       times(scales.length / scales.time / milli)},
      {"wall-stiffness", "E_w", "line_tension_of_equal_sag", "Gamma of the droplet with this disk's sag", "",
       [](double model) { return laboratory::line_tension_of_sag(std::numbers::pi / (16 * model)); }}};
}

Line line_of(const Conversion& conversion, double model) {
  return {conversion.what, with_unit(conversion.convert(model), conversion.unit, conversion.otherwise),
          fmt::format("{} = {}", conversion.symbol, console::plain(model))};
}

/// Advises a cheaper model for a nearly rigid droplet; empty for other droplets.
std::string advice_of(const Scales& scales) {
  if (!(scales.line_tension > nearly_rigid_tension)) return "";
  return fmt::format(
      "\nThis droplet is nearly rigid. The soft disk, model=sp wall-stiffness={}, clogs in the same places "
      "and takes a tenth of the time.\nThe polygon with line-tension={} clogs in the same places, too, and "
      "takes less time than this droplet, but was not tested for soundness.\n",
      console::plain(scales.wall_stiffness), console::plain(nearly_rigid_tension));
}

/// Rounds all numbers to twelve digits, which removes the round-off of conversions: 30, not
/// 29.999999999999996.
Json rounded(Json document) {
  for (Json& value : document)
    if (value.is_structured())
      value = rounded(value);
    else if (value.is_number_float())
      value = twelve_digits(value.get<double>());
  return document;
}

Json json_of(const Laboratory& lab, const Scales& scales) {
  const console::BuildInfo build = console::build_info();
  return {{"version", build.version},
          {"git_describe", build.git_describe},
          {"diameter_mm", scales.length / milli},
          {"angle_degrees", lab.experiment.tilt / degree},
          {"gravity_m_per_s2", scales.gravity},
          {"time_s", scales.time},
          {"speed_mm_per_s", scales.speed / milli},
          {"tension_mN_per_m", lab.experiment.interfacial_tension / milli},
          {"tension_ratio", lab.tension_ratio},
          {"tension_mN_per_m_of_gamma_1", scales.tension / milli},
          {"line_tension_experiment", scales.line_tension_experiment},
          {"line_tension", scales.line_tension},
          {"sag", scales.sag},
          {"wall_stiffness", scales.wall_stiffness},
          {"terminal_speed", scales.terminal_speed},
          {"capillary_number", scales.capillary_number},
          {"line_tension_of_cell_uN", scales.line_tension_of_cell / (milli * milli)},
          {"break_up_neck", scales.break_up_neck}};
}

/// A line of the table of several droplets. @param with_neck  whether the file gives the cell's thickness
Line line_of(const Laboratory& lab, bool with_neck) {
  const Scales scales = laboratory::scales_of(lab);
  Line line;
  for (const double value :
       {scales.length / milli, lab.experiment.tilt / degree, scales.time, scales.speed / milli,
        scales.terminal_speed, scales.line_tension, scales.wall_stiffness, scales.capillary_number})
    line.push_back(with_unit(value, ""));
  if (with_neck) line.push_back(with_unit(scales.break_up_neck, ""));
  return line;
}

/// Prints a line for each of several droplets.
int show_droplets(const std::vector<Laboratory>& all, const std::string& format) {
  if (format == "json") {
    Json document = Json::array();
    for (const Laboratory& lab : all) document.push_back(json_of(lab, laboratory::scales_of(lab)));
    std::cout << console::json_text(rounded(document));
    return console::exit_success;
  }
  std::vector<Line> lines = {
      {"diameter/mm", "angle/deg", "t0/s", "speed/(mm/s)", "V_t", "Gamma", "E_w", "Ca"}};
  const bool with_neck = !std::isnan(all.front().thickness);
  if (with_neck) lines.front().emplace_back("break-up-neck");
  for (const Laboratory& lab : all) lines.push_back(line_of(lab, with_neck));
  std::cout << lines_text(lines);
  if (const std::string law = laboratory::law_of_speed(all.front()); !law.empty()) std::cout << law << '\n';
  if (const std::string caution = caution_about_ratio(all.front()); !caution.empty())
    std::cout << "Gamma" << caution << '\n';
  return console::exit_success;
}

}  // namespace

int clogfit_units(int argc, const char* const* argv) {
  cli::CommandLine line("clogfit units", units_usage);
  line.word("file", "lab.cfg")
      .option("length",
              "length of the model, such as lambda, to convert [sigma]; this and the next four options take "
              "lists")
      .option("time", "time of the model to convert [t0]")
      .option("line-tension", "Gamma of the model to convert")
      .option("terminal-speed", "V_t of the model to convert")
      .option("wall-stiffness", "E_w of a soft disk to convert")
      .option("format", "text or json", "text");
  if (!cli::parse_command(line, argc, argv)) return console::exit_success;
  const std::string format = line.get_word("format", {"text", "json"});
  const std::vector<Laboratory> all = laboratory::read_laboratories(line.require("file"));
  const Laboratory& lab = all.front();
  if (const std::string words = laboratory::unusual_density(lab); !words.empty())
    console::say(fmt::format("clogfit units: {}: {}", line.get("file"), words));
  const Scales scales = laboratory::scales_of(lab);
  const std::vector<Conversion> known = conversions(lab, scales);
  if (all.size() > 1) {
    for (const Conversion& conversion : known)
      if (line.has(conversion.option))
        throw Error(
            fmt::format("cannot convert --{} for {} droplets; give a file with one diameter and one angle",
                        conversion.option, all.size()));
    return show_droplets(all, format);
  }
  if (format == "json") {
    Json document = json_of(lab, scales);
    for (const Conversion& conversion : known) {
      const std::vector<double> models = line.get_positives(conversion.option);
      if (models.empty()) continue;
      Json& values = document["given"][conversion.name];
      for (const double model : models) values.push_back(conversion.convert(model));
      if (models.size() == 1) values = Json(values.front());
    }
    std::cout << console::json_text(rounded(document));
    return console::exit_success;
  }
  std::vector<Line> lines = lines_of(lab, scales);
  const std::size_t num_scales = lines.size();
  for (const Conversion& conversion : known)
    for (const double model : line.get_positives(conversion.option)) {
      if (lines.size() == num_scales) lines.push_back({"", "", ""});
      lines.push_back(line_of(conversion, model));
    }
  std::cout << lines_text(lines) << advice_of(scales);
  return console::exit_success;
}

}  // namespace clog::programs
