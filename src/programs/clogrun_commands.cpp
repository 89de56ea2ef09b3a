#include "clogrun_commands.hpp"

#include <fmt/ostream.h>

#include <cmath>
#include <iostream>
#include <optional>

#include "clog/cli/program.hpp"
#include "clog/console/rounded.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/laboratory/lab_file.hpp"
#include "clog/laboratory/scales.hpp"
#include "clog/sweep/row_limits.hpp"

namespace clog::programs {

void refuse_options(const cli::CommandLine& line, const std::string& system,
                    std::initializer_list<const char*> options) {
  for (const char* option : options)
    if (line.has(option))
      throw Error(fmt::format("--{} has no meaning for clogrun {}; leave it out", option, system));
}

single_run::RecordedRun::Intervals intervals(const cli::CommandLine& line, double time_step) {
  std::optional<double> polygons;
  if (line.has("polygon-interval")) polygons = line.get_positive("polygon-interval");
  const auto often =
      single_run::RecordedRun::every(line.get_positive("sample-interval"), polygons, time_step);
  if (polygons) {
    constexpr double tolerated = 0.05;
    const double check = DropletRun::steps_per_check * time_step;
    const double stored = check * static_cast<double>(often.polygons);
    if (std::abs(stored - *polygons) > tolerated * *polygons)
      console::say(fmt::format(
          "the polygons are {:.4g} t0 apart, not {:.4g} (a whole number of checks of {:.4g} t0 each); a "
          "smaller time-step has shorter checks",
          stored, *polygons, check));
  }
  return often;
}

int report(const cli::CommandLine& line, const single_run::RecordedRun& watched) {
  const int exit_code = watched.report();
  if (!line.has("lab")) return exit_code;
  const laboratory::Scales scales = laboratory::scales_of(laboratory::read_laboratory(line.get("lab")));
  constexpr double milli = 1e-3;
  const RunResult result = watched.result();
  fmt::print(std::cout, "in the laboratory: r = {:.4g} mm, t = {:.4g} s\n",
             result.distance * scales.length / milli, result.time * scales.time);
  return exit_code;
}

void warn_of_untested_parameters(const sweep::Plan& plan) {
  if (const std::string words = sweep::untested_parameters(plan); !words.empty()) console::say(words);
}

void choose_layout(cli::CommandLine& line, const std::string& layout) {
  const std::string key = "obstacle-layout";
  if (line.has(key) && line.get(key) != layout)
    throw Error(fmt::format("clogrun {} means {}={}, not {}; leave it out", line.get("system"), key, layout,
                            line.get(key)));
  line.settings().set(key, layout);
}

}  // namespace clog::programs
