#include "clogfit_calibrate.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/console/build_info.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/json_text.hpp"
#include "clog/console/printable.hpp"
#include "clog/console/signals.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/fit/calibration.hpp"
#include "clog/laboratory/experiment.hpp"
#include "clog/laboratory/trials.hpp"
#include "clog/sweep/single_run.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::programs {
namespace {

using laboratory::Experiment;
using laboratory::Trial;

constexpr const char* calibrate_program = "clogfit calibrate";
constexpr const char* calibrate_usage =
    R"(clogfit calibrate finds the line tension Gamma and the near-wall drag b_0/b_inf of the simulated
droplet that passes a channel most like a measured one: those that minimise Delta_v, the relative
root-mean-square deviation of the speeds. One file per trial.

  clogfit calibrate trial1.csv trial2.csv orifice=0.7 terminal-speed=0.032
  clogfit calibrate channel.h5 orifice=0.7 terminal-speed=0.032
  clogfit calibrate trial*.csv orifice=0.4 --diameter 3.5mm --speed 7mm/s --angle 28deg
  ... --tension 10mN/m --other "1.98mm 8.5deg"

A profile is a CSV file with the header h [sigma], v [v_t], A or, with --diameter and --speed, in laboratory units such
as h [mm], v [mm/s], A; or what clogrun channel has written. With --angle the terminal speed V_t follows from the laboratory's quantities.

Errors (+-) come from the scatter of a trial's frames about the best run, treated as independent noise. They do not
contain errors of the model or its mesh: for frames without noise they are too small.
)";

using Text = std::string;

cli::CommandLine parse_calibration(int argc, const char* const* argv) {
  namespace po = boost::program_options;
  cli::CommandLine line(calibrate_program, calibrate_usage, cli::CommandLine::SweepKeys::accepted);
  const auto text = [] { return po::value<Text>(); };
  line.add_options()("profiles", po::value<std::vector<Text>>()->composing(),
                     "CSV files, or files written by clogrun channel, one per trial")(
      "diameter", text(), "of the undeformed droplet, e.g. 3.5mm")(
      "speed", text(), "terminal, far from walls, e.g. 7mm/s")("angle", text(),
                                                               "of the plates to the horizontal, e.g. 28deg")(
      "density", text()->default_value("0.703g/ml"), "of the droplet")(
      "outer-density", text()->default_value("0.997g/ml"), "of the liquid around it")(
      "tension", text(), "interfacial, e.g. 10mN/m: for Gamma_exp")(
      "other", text(), "another experiment's diameter and angle, to scale Gamma to")(
      "format", text()->default_value("text"), "text or json");
  line.add_positional("profiles", -1);
  line.settings().set("obstacle-layout", "channel");
  line.parse(argc - 1, argv + 1);
  return line;
}

std::optional<double> quantity(const cli::CommandLine& line, const char* option, const char* units) {
  if (!line.has(option)) return std::nullopt;
  try {
    const double value = laboratory::to_si(line.get(option), units);
    if (value > 0) return value;
    throw Error("must be positive");
  } catch (const Error& error) {
    throw Error(fmt::format("invalid --{}={} ({})", option, line.get(option), error.what()));
  }
}

Experiment experiment(const cli::CommandLine& line) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const Experiment lab{.diameter = quantity(line, "diameter", "length").value_or(0),
                       .terminal_speed = quantity(line, "speed", "speed").value_or(0),
                       .tilt = quantity(line, "angle", "angle").value_or(0),
                       .droplet_density = *quantity(line, "density", "density"),
                       .outer_density = *quantity(line, "outer-density", "density"),
                       .interfacial_tension = quantity(line, "tension", "tension").value_or(unknown)};
  if (lab.tilt > std::numbers::pi / 2)
    throw Error("invalid --angle=" + line.get("angle") + " (beyond 90 degrees)");
  if (lab.droplet_density == lab.outer_density)
    throw Error("--density and --outer-density are equal: nothing drives the droplet");
  for (const char* option : {"tension", "other"})
    if (line.has(option) && (lab.tilt == 0 || lab.diameter == 0))
      throw Error("--" + Text(option) + " needs --diameter and --angle");
  if (lab.tilt > 0 && (lab.diameter == 0 || lab.terminal_speed == 0))
    throw Error("--angle needs --diameter and --speed");
  return lab;
}

/// "1.98mm 8.5deg"
Experiment other_experiment(const cli::CommandLine& line, Experiment lab) {
  const Text text = line.get("other");
  const auto space = text.find_last_of(' ');
  if (space == Text::npos)
    throw Error("invalid --other=" + text + " (needs a diameter and an angle) try \"1.98mm 8.5deg\"");
  lab.diameter = laboratory::to_si(text.substr(0, space), "length");
  lab.tilt = laboratory::to_si(text.substr(space + 1), "angle");
  if (!(lab.diameter > 0 && lab.tilt > 0)) throw Error("invalid --other=" + text + " (must be positive)");
  return lab;
}

std::string channel_text(const RunParameters& run) {
  const ChannelParameters& channel = run.channel;
  return fmt::format("orifice={} wedge-angle={} tip-radius={}", sweep::shortest(channel.orifice),
                     sweep::shortest(channel.wedge_angle), sweep::shortest(channel.tip_radius));
}

/// Gamma hangs on the orifice; a file of clogrun says which it was.
void require_channel(const std::vector<Trial>& trials, const sweep::Settings& settings) {
  const bool is_stored = std::ranges::none_of(trials, &Trial::is_of_laboratory);
  if (is_stored || settings.is_given("orifice")) return;
  throw Error(
      "missing orifice (the line tension that is found depends on the channel) give its width in droplet "
      "diameters, e.g. orifice=0.8, and wedge-angle, tip-radius unless they are those of --help");
}

void print_text(std::vector<Text> files, const std::vector<fit::Calibration>& found, const fit::Trials& all,
                const Experiment& lab, const std::optional<Experiment>& other) {
  std::size_t width = 7;
  for (Text& file : files) {
    file = console::printable(file);
    width = std::max(width, file.size());
  }
  fmt::print(std::cout, "{:{}}    Gamma*        +-  b_0/b_inf        +-   Delta_v   Delta_A\n", "profile",
             width);
  for (std::size_t i = 0; i < files.size(); ++i)
    fmt::print(std::cout, "{:{}}  {:>8.4g}  {:>8.2g}  {:>9.4g}  {:>8.2g}  {:>8.3g}  {:>8.3g}\n", files[i],
               width, found[i].line_tension, found[i].line_tension_error, found[i].near_wall_drag,
               found[i].near_wall_drag_error, found[i].deviation.speed, found[i].deviation.shape);
  for (std::size_t i = 0; i < files.size(); ++i)
    for (const Text& warning : laboratory::warnings(found[i]))
      fmt::print(std::cout, "note: {}: {}\n", files[i], warning);
  if (found.size() > 1)
    fmt::print(std::cout,
               "\nmean of {} trials and their standard deviation: Gamma* = {:.3g} +- {:.2g}, b_0*/b_inf = "
               "{:.3g} +- {:.2g}\n",
               found.size(), all.line_tension, all.line_tension_deviation, all.near_wall_drag,
               all.near_wall_drag_deviation);
  else
    std::cout << "\none trial: errors are from the scatter of its frames\n";
  if (lab.tilt > 0) fmt::print(std::cout, "g_exp = {:.3g} m/s^2\n", lab.gravity());
  if (!std::isnan(lab.interfacial_tension))
    fmt::print(std::cout, "Gamma_exp = {:.3g}, Gamma*/Gamma_exp = {:.3g}\n", lab.line_tension(),
               all.line_tension / lab.line_tension());
  if (other)
    fmt::print(std::cout, "Gamma** = {:.3g} for a droplet of {:.3g} mm at {:.3g} degrees\n",
               laboratory::scaled_line_tension(all.line_tension, lab, *other), 1e3 * other->diameter,
               other->tilt * 180 / std::numbers::pi);
}

void print_json(const std::vector<Text>& files, const std::vector<fit::Calibration>& found,
                const fit::Trials& all, const Experiment& lab, const RunParameters& run,
                const std::optional<Experiment>& other) {
  nlohmann::ordered_json trials = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < files.size(); ++i)
    trials.push_back({{"profile", files[i]},
                      {"line_tension", found[i].line_tension},
                      {"line_tension_error", found[i].line_tension_error},
                      {"near_wall_drag", found[i].near_wall_drag},
                      {"near_wall_drag_error", found[i].near_wall_drag_error},
                      {"delta_v", found[i].deviation.speed},
                      {"delta_a", found[i].deviation.shape},
                      {"speed_correlation", found[i].correlation.speed},
                      {"shape_correlation", found[i].correlation.shape},
                      {"converged", found[i].is_converged},
                      {"clogging_tension", found[i].clogging_tension},
                      {"simulations", found[i].num_simulations},
                      {"warnings", laboratory::warnings(found[i])}});
  const console::BuildInfo build = console::build_info();
  nlohmann::ordered_json document = {{"version", build.version},
                                     {"git_describe", build.git_describe},
                                     {"trials", trials},
                                     {"line_tension", all.line_tension},
                                     {"line_tension_deviation", all.line_tension_deviation},
                                     {"near_wall_drag", all.near_wall_drag},
                                     {"near_wall_drag_deviation", all.near_wall_drag_deviation},
                                     {"orifice", run.channel.orifice},
                                     {"wedge_angle", run.channel.wedge_angle},
                                     {"tip_radius", run.channel.tip_radius},
                                     {"terminal_speed", run.drag.terminal_speed}};
  if (lab.tilt > 0) document["gravity"] = lab.gravity();
  if (!std::isnan(lab.interfacial_tension)) document["line_tension_experiment"] = lab.line_tension();
  if (other) document["line_tension_scaled"] = laboratory::scaled_line_tension(all.line_tension, lab, *other);
  std::cout << console::json_text(document);
}

}  // namespace

int clogfit_calibrate(int argc, const char* const* argv) {
  cli::CommandLine line = parse_calibration(argc, argv);
  if (cli::answer_help_or_version(line, {})) return console::exit_success;
  if (!fit::can_calibrate())
    throw Error(
        "not in this build (NLopt was not found when clogsweep was built) install NLopt and build again");
  const std::vector<Text> files = line.get_all("profiles");
  if (files.empty()) throw Error("missing profile; try clogfit calibrate trial.csv --orifice 0.7");
  for (const char* key : {"line-tension", "near-wall-drag"})
    if (line.has(key))
      throw Error(fmt::format("--{} is what {} finds; leave it out", key, calibrate_program));
  if (line.has("angle") && line.has("terminal-speed"))
    throw Error("--angle and terminal-speed contradict each other; give one of them");
  const Text format = line.get_word("format", {"text", "json"});
  const Experiment lab = experiment(line);
  std::optional<Experiment> other;
  if (line.has("other")) other = other_experiment(line, lab);
  if (lab.tilt > 0) line.settings().set("terminal-speed", sweep::shortest(lab.reduced_terminal_speed()));
  const RunParameters usual = sweep::single_run(line.settings());
  const double terminal_speed = usual.drag.terminal_speed;
  const std::vector<Trial> trials = laboratory::read_trials(files, {lab.diameter, lab.terminal_speed}, usual);
  require_channel(trials, line.settings());
  if (format == "text")
    fmt::print(std::cout, "channel: {}, V_t = {:.4g}\n\n", channel_text(usual), terminal_speed);

  console::catch_stop_signals();
  const std::vector<fit::Calibration> found = laboratory::calibrate(trials, line.settings());
  const fit::Trials all = fit::combine(found);
  if (format == "json")
    print_json(files, found, all, lab, usual, other);
  else
    print_text(files, found, all, lab, other);
  return console::exit_success;
}

}  // namespace clog::programs
