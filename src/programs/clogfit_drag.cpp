#include "clogfit_drag.hpp"

#include <fmt/ostream.h>

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/console/build_info.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/json_text.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/fit/near_wall_drag.hpp"
#include "clog/laboratory/experiment.hpp"
#include "clog/laboratory/profile_file.hpp"

namespace clog::programs {
namespace {

constexpr const char* drag_usage =
    R"(clogfit drag finds the exponent alpha and the strength b_0/b_inf of the near-wall drag from the speeds of a droplet
that moves along a wall: a straight line through log(v/(v_t - v)) against log d, by least squares.

  clogfit drag speeds.csv
  clogfit drag speeds.csv --diameter 0.98mm --speed 0.65mm/s

The CSV file has the header d [sigma], v [v_t] or, with --diameter and --speed, laboratory units such as d [mm], v [mm/s];
d is the distance between wall and droplet surface.
)";

double scale(const cli::CommandLine& line, const char* option, const char* units) {
  if (!line.has(option)) return 0;
  try {
    const double value = laboratory::to_si(line.get(option), units);
    if (value > 0) return value;
    throw Error("must be positive");
  } catch (const Error& error) {
    throw Error(fmt::format("invalid --{}={} ({})", option, line.get(option), error.what()));
  }
}

fit::NearWallDrag fit_file(const std::string& path, const std::vector<fit::NearWallSpeed>& speeds) {
  try {
    return fit::fit_near_wall_drag(speeds);
  } catch (const std::invalid_argument& error) {
    throw Error(fmt::format("{} cannot be fitted ({})", path, error.what()));
  }
}

}  // namespace

int clogfit_drag(int argc, const char* const* argv) {
  namespace po = boost::program_options;
  cli::CommandLine line("clogfit drag", drag_usage, cli::CommandLine::SweepKeys::none);
  const auto text = [] { return po::value<std::string>(); };
  line.add_options()("file", text(), "CSV file")("diameter", text(),
                                                 "of the undeformed droplet, e.g. 0.98mm")(
      "speed", text(), "terminal, far from walls, e.g. 0.65mm/s")("format", text()->default_value("text"),
                                                                  "text or json");
  line.add_positional("file", 1);
  line.parse(argc - 1, argv + 1);
  if (cli::answer_help_or_version(line, {})) return console::exit_success;
  if (!line.has("file")) throw Error("missing file; try clogfit drag speeds.csv");
  const std::string format = line.get_word("format", {"text", "json"});

  const std::string path = line.get("file");
  const auto speeds = laboratory::read_near_wall_speeds(
      path, {scale(line, "diameter", "length"), scale(line, "speed", "speed")});
  const fit::NearWallDrag fit = fit_file(path, speeds);
  if (format == "text") {
    fmt::print(std::cout, "alpha = {:.4g} +- {:.2g}, b_0/b_inf = {:.4g} +- {:.2g}, from {} speeds\n",
               fit.exponent, fit.exponent_error, fit.drag, fit.drag_error, speeds.size());
    return console::exit_success;
  }
  const auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  const console::BuildInfo build = console::build_info();
  const nlohmann::ordered_json document = {{"version", build.version},
                                           {"git_describe", build.git_describe},
                                           {"near_wall_exponent", fit.exponent},
                                           {"near_wall_exponent_error", number(fit.exponent_error)},
                                           {"near_wall_drag", fit.drag},
                                           {"near_wall_drag_error", number(fit.drag_error)},
                                           {"speeds", speeds.size()}};
  std::cout << console::json_text(document);
  return console::exit_success;
}

}  // namespace clog::programs
