/// clogfit: from the table of runs to clogging lengths and mean speeds.

#include <fmt/core.h>

#include <array>
#include <filesystem>
#include <iostream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/cli/python_command.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/results/group_table.hpp"
#include "clog/results/merger.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/store/run_table.hpp"
#include "clogfit_compare.hpp"
#include "clogfit_lengths.hpp"
#include "clogfit_units.hpp"
#include "laboratory_option.hpp"

namespace {

using namespace clog;
using namespace clog::programs;
using results::SharedParameters;

constexpr const char* program = "clogfit";
constexpr const char* usage =
    R"(clogfit prints, for every parameter set of a sweep, the clogging length with its
confidence interval and the mean speed with its standard error.

  clogfit sweep.h5
  clogfit sweep.h5 --format csv > table.csv
  clogfit a.h5 b.h5                            several files as one sweep
  clogfit lengths distances.csv                the same from distances that you measured
  clogfit compare a.h5 b.h5                    ratios of clogging lengths, paired by seed
  clogfit calibrate trial.csv --orifice 0.7    line tension and near-wall drag from measured speeds
  clogfit deviation a.csv b.csv                Delta_v and Delta_A of one profile from others
  clogfit drag speeds.csv                      exponent of the near-wall drag from speeds along a wall
  clogfit units lab.cfg                        between a laboratory's quantities and the model's numbers
  clogfit curve sweep.h5                       a smooth curve through the lengths, its peak, where it crosses a length
  clogfit report sweep.h5 --output page.html   curves, doubts, example clogs, table, provenance on one page

Runs that did not clog count as censored at the distance they reached. Where no run clogged, lambda is a lower
bound. Letters in the last column name what may spoil a length. The mean speed is in units of the terminal speed, its
error comes from the scatter between runs. For lattices, lateral/r is the lateral displacement per distance travelled, the
tangent of the migration angle, positive towards +y. csv and json have more: intervals by profile likelihood, the
published least squares (biased), Weibull's shape with its p-value, capillary numbers; json also P(r).

Runs of the same seed met the same obstacles in every row with the same array, so the errors of such rows are
correlated: overlapping intervals do not mean that they agree. clogfit compare uses this, and pairs runs by seed.

An experiment calls a droplet clogged if it has not moved for a waiting time. --dwell applies this rule: a droplet that
advanced no farther than dwell-length (0.05 sigma by default) for longer than this time counts as clogged where it first
did so, even if it moved on.
)";

int body(int argc, char** argv) {
  namespace po = boost::program_options;
  cli::CommandLine line(program, usage, cli::CommandLine::SweepKeys::none);
  line.add_options()("file", po::value<std::vector<std::string>>(), "sweep files")(
      "format", po::value<std::string>()->default_value("text"), "text, csv or json")(
      "confidence", po::value<std::string>()->default_value("0.95"), "of the intervals")(
      "all-parameters",
      "in the text, also list the parameters that all runs share with their default values")(
      "from-distance", po::value<std::string>(),
      "count lambda from this distance on; runs that ended before are left out [sigma]")(
      "lab", po::value<std::string>(),
      "file that describes the laboratory, see clogfit units: lengths, speeds and times in its units, too")(
      "pool", po::value<std::string>(),
      "max-time, boxes or both, with a comma between: join groups that differ in these keys only")(
      "lines", po::value<std::string>(),
      "x1,x2,...: lines across a device that droplets pass, in place of the rows of its posts [sigma]")(
      "dwell", po::value<std::string>(), "droplets that have not moved for so long count as clogged [t0]");
  line.add_positional("file", -1);
  line.add_commands({"calibrate", "compare", "curve", "deviation", "drag", "lengths", "report", "units"});
  line.parse(argc, argv);
  if (cli::answer_help_or_version(line, {{"HDF5", store::library_version()}})) return console::exit_success;
  if (!line.has("file")) throw Error("missing sweep file; try clogfit sweep.h5");
  const std::string format = line.get_word("format", {"text", "csv", "json"});
  const double confidence = line.get_share("confidence");

  const double from_distance = line.has("from-distance") ? line.get_positive("from-distance") : 0;

  const double dwell =
      line.has("dwell") ? line.get_positive("dwell") : std::numeric_limits<double>::infinity();

  const std::vector<std::string> paths = line.get_all("file");
  for (const std::string& path : paths)
    if (path.find('=') != std::string::npos && !std::filesystem::exists(path))
      throw Error(fmt::format(
          "no place for '{}' (clogfit reads files; clogsweep select takes some rows of one)", path));
  const store::SweepFile sweep = results::read_together(paths);
  if (sweep.rows.empty()) throw Error(joined(paths) + " has no runs yet; let the sweep finish some first");
  if (line.has("dwell") && !results::has_clogging_length(sweep.rows.front()))
    throw Error(
        "no place for --dwell (droplets in a channel or on a wall have no clogging length) leave it out");
  const std::vector<const sweep::Column*> pooled =
      line.has("pool") ? results::pooled_columns(line.get("pool")) : std::vector<const sweep::Column*>();
  const std::vector<double> lines = line.has("lines") ? line.get_positives("lines") : std::vector<double>();
  std::vector<results::Group> groups =
      results::group_runs(sweep.rows, confidence, from_distance, dwell, pooled, lines);
  set_scales(line, groups);
  const SharedParameters shared =
      line.has("all-parameters") ? SharedParameters::all : SharedParameters::unusual;
  std::cout << (format == "csv"    ? results::to_csv(groups)
                : format == "json" ? results::to_json(groups, confidence, sweep.provenance)
                                   : results::to_text(groups, confidence, shared));
  if (format == "text" && line.has("pool"))
    std::cout << fmt::format("   groups that differ only in {} are joined (--pool)\n", line.get("pool"));
  return console::exit_success;
}

constexpr std::array python_commands = {"calibrate", "curve", "deviation", "drag", "report"};

/// Runs python3 -m clogsweep COMMAND, which asks these very programs for numbers.
int become_python(const std::string& command, int argc, char** argv) {
  // The user's own --programs comes later and has the last word.
  std::vector<std::string> arguments = {command, "--programs", cli::own_folder()};
  arguments.insert(arguments.end(), argv + 2, argv + argc);
  cli::become_python("clogfit " + command, cli::find_python_module(), arguments);
}

}  // namespace

int main(int argc, char** argv) {
  console::prepare_streams();
  for (const std::string command : python_commands)
    if (argc > 1 && argv[1] == command)
      return cli::run_program("clogfit " + command, [&] { return become_python(command, argc, argv); });
  if (argc > 1 && std::string_view(argv[1]) == "compare")
    return cli::run_program("clogfit compare", [&] { return clogfit_compare(argc, argv); });
  if (argc > 1 && std::string_view(argv[1]) == "lengths")
    return cli::run_program("clogfit lengths", [&] { return clogfit_lengths(argc, argv); });
  if (argc > 1 && std::string_view(argv[1]) == "units")
    return cli::run_program("clogfit units", [&] { return clogfit_units(argc, argv); });
  return cli::run_program(program, [&] { return body(argc, argv); });
}
