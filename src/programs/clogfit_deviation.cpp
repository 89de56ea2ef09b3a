#include "clogfit_deviation.hpp"

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/console/build_info.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/json_text.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/laboratory/profile_file.hpp"

namespace clog::programs {
namespace {

constexpr const char* deviation_usage =
    R"(clogfit deviation prints Delta_v and Delta_A of a measured passage through a channel from simulated ones, as JSON:
the relative root-mean-square deviations of speed and shape.

  clogfit deviation measured.csv simulated1.csv simulated2.csv

All are CSV files with the header h [sigma], v [v_t], A, or written by clogrun channel. Simulated frames are in the order
of time and interpolated to the measured h.
)";

}  // namespace

int clogfit_deviation(int argc, const char* const* argv) {
  namespace po = boost::program_options;
  cli::CommandLine line("clogfit deviation", deviation_usage, cli::CommandLine::SweepKeys::none);
  line.add_options()("profiles", po::value<std::vector<std::string>>()->composing(),
                     "CSV files or of clogrun channel, the measured one first");
  line.add_positional("profiles", -1);
  line.parse(argc - 1, argv + 1);
  if (cli::answer_help_or_version(line, {})) return console::exit_success;
  const std::vector<std::string> files = line.get_all("profiles");
  if (files.size() < 2) throw Error("missing profiles; try clogfit deviation measured.csv simulated.csv");

  const fit::Profile measured = laboratory::read_measured_profile(files[0], {}).frames;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 1; i < files.size(); ++i) {
    const fit::Deviation found = fit::deviation(measured, laboratory::read_profile(files[i], {}));
    list.push_back({{"profile", files[i]},
                    {"delta_v", found.speed},
                    {"delta_a", std::isnan(found.shape) ? nlohmann::ordered_json(nullptr)
                                                        : nlohmann::ordered_json(found.shape)}});
  }
  const console::BuildInfo build = console::build_info();
  const nlohmann::ordered_json document = {{"version", build.version},
                                           {"git_describe", build.git_describe},
                                           {"measured", files[0]},
                                           {"deviations", list}};
  std::cout << console::json_text(document);
  return console::exit_success;
}

}  // namespace clog::programs
