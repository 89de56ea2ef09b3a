/// clogfit: computes clogging lengths and mean speeds from the table of runs.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/cli/python_command.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/laboratory/scales.hpp"
#include "clog/results/distance_file.hpp"
#include "clog/results/distance_table.hpp"
#include "clog/results/group_table.hpp"
#include "clog/results/merger.hpp"
#include "clog/results/mixture.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/sweep/value_list.hpp"
#include "clogfit_compare.hpp"
#include "clogfit_lengths.hpp"
#include "clogfit_units.hpp"
#include "file_command.hpp"
#include "laboratory_of_results.hpp"

namespace {

using namespace clog;
using namespace clog::programs;
using results::SharedParameters;

constexpr const char* clogfit_usage =
    R"(clogfit prints, for every parameter set of a sweep, the clogging length with its
confidence interval and the mean speed with its standard error.

  clogfit sweep.h5
  clogfit sweep.h5 --format csv > table.csv
  clogfit a.h5 b.h5                            several files as one sweep
  clogfit lengths distances.csv                clogging lengths from distances that you measured
  clogfit compare a.h5 b.h5                    ratios of clogging lengths, paired by seed
  clogfit calibrate trial.csv --orifice 0.7    line tension and near-wall drag from measured speeds
  clogfit deviation a.csv b.csv                deviations Delta_v and Delta_A of one profile from others
  clogfit drag speeds.csv                      exponent of the near-wall drag from speeds along a wall
  clogfit units lab.cfg                        converts a laboratory's quantities into the model's numbers
  clogfit curve sweep.h5                       a smooth curve through the lengths, and its peak
  clogfit report sweep.h5 --output page.html   curves, doubts, example clogs, table, provenance on one page

Runs that did not clog count as censored at the distance they reached. If no run clogged, lambda is a lower bound.
Letters in the last column are doubts: reasons why a length may be wrong. The mean speed is in units of the terminal
speed; its error comes from the scatter between runs. For lattices, "lateral/r" is the lateral displacement per distance
travelled, the tangent of the migration angle, positive towards +y. "along rows" is lateral/r divided by the tangent of
the rows' angle: 1 for droplets that follow the rows (bump mode), 0 for droplets that go straight on (zigzag).
--row-angle adds these columns for other arrays. The formats csv and json also contain intervals by profile likelihood,
lambda by least squares (as published, biased), Weibull's shape with its p-value, and capillary numbers; json also
contains the survival P(r).

If several lines of the table have the same arrays, their runs of equal seed met the same obstacles. So the errors of
these lines are correlated, and overlapping intervals do not mean that the lengths agree. Use clogfit compare, which
pairs runs by seed.

An experiment calls a droplet clogged if it has not moved for a waiting time. --dwell T applies this rule: a droplet
that advanced by at most dwell-length (0.05 sigma by default) for longer than T counts as clogged at the place of its
first such rest, even if it moved on later.
)";

/// Runs python3 -m clogsweep COMMAND, which calls the C++ programs to compute numbers.
int in_python(int argc, const char* const* argv) {
  const std::string command = argv[1];
  // The user's own --programs comes later and overrides this value.
  std::vector<std::string> arguments = {command, "--programs", cli::own_folder()};
  arguments.insert(arguments.end(), argv + 2, argv + argc);
  cli::become_python("clogfit " + command, cli::find_python_module(), arguments);
}

constexpr cli::Command clogfit_commands[] = {
    {"calibrate", in_python}, {"compare", clogfit_compare}, {"curve", in_python},  {"deviation", in_python},
    {"drag", in_python},      {"lengths", clogfit_lengths}, {"report", in_python}, {"units", clogfit_units}};

void set_row_angle(const std::string& text, std::vector<results::Group>& groups) {
  const double angle = sweep::to_number(text);
  if (angle == 0 || !(std::abs(angle) < 90))
    throw Error(
        fmt::format("invalid --row-angle={} (rows along or across the flow displace no droplet) use "
                    "an angle between 0 and 90 degrees, or between -90 and 0",
                    text));
  for (results::Group& group : groups) group.row_angle = angle;
}

/// @throws Error if there are neither devices nor families, or if a line is downstream of a device's exit,
/// where droplets are no longer followed
void require_place_for_lines(const std::string& text, const results::LinesOf& lines,
                             const std::vector<results::Group>& groups) {
  bool is_any = false, is_said = false;
  for (const results::Group& group : groups) {
    const RunParameters& run = group.first_row.parameters;
    is_any = is_any || (run.model == Model::dp && run.dp.break_up == BreakUp::daughters);
    if (!results::is_device(run)) continue;
    is_any = true;
    const std::vector<double> places = lines(group.first_row);
    const double entrance = run.obstacles.entrance, exit = run.obstacles.exit;
    const auto [first, last] = std::ranges::minmax(places);
    const bool is_upstream = run.obstacles.release == Release::entrance && first < entrance;
    if (is_upstream && !is_said)
      console::say(
          fmt::format("clogfit: --lines={}: {} is upstream of the release at x = {}, where no droplet counts",
                      text, shortest(first), shortest(twelve_digits(entrance))));
    is_said = is_said || is_upstream;
    if (exit > 0 && last > exit)
      throw Error(fmt::format(
          "invalid --lines={} ({} is behind the exit at x = {}, where runs end) give lines up to the exit{}",
          text, shortest(last), shortest(twelve_digits(exit)),
          groups.size() > 1 ? " of every group, or choose groups with clogsweep select" : ""));
  }
  if (!is_any)
    throw Error(
        "no place for --lines (no run has release=entrance, an exit or break-up=daughters); leave it out");
}

/// The lines of --lines. In droplet diameters, the place of a line in mm depends on the size of the droplet.
results::LinesOf lines_of(const cli::CommandLine& line, const std::vector<sweep::RunRow>& rows) {
  if (!line.has("lines")) return {};
  return [&line, scales = scales_of_rows(line, rows)](const sweep::RunRow& row) {
    const std::optional<LaboratoryText>& own = row.parameters.laboratory;
    const auto scale = scales.find(line.has("lab") || !own ? "" : own->check_sum());
    constexpr double milli = 1e-3;
    const double diameter =
        scale == scales.end() ? std::numeric_limits<double>::quiet_NaN() : milli * scale->second.length;
    return line.get_positives(
        "lines", [diameter](const std::string& text) { return laboratory::in_diameters(text, diameter); });
  };
}

int clogfit(int argc, const char* const* argv) {
  cli::CommandLine line("clogfit", clogfit_usage);
  line.words("file", "sweep files")
      .option("format", "text, csv or json", "text")
      .option("confidence", "confidence level of the intervals", "0.95")
      .flag("all-parameters", "also list parameters that have their defaults in all runs")
      .option("from-distance",
              "count paths only from this distance on; runs that ended before it are excluded [sigma]")
      .option("lab",
              "file that describes the laboratory, see clogfit units; the table then has lengths, speeds and "
              "times in laboratory units, too")
      .option(
          "pool",
          "join groups that differ only in these keys: max-time, boxes, or both with a comma between them")
      .option("lines",
              "x1,x2,...: lines at which droplets that passed are counted: across a device (by default at "
              "every row of posts), and for daughters beside 10, 20, 50, 100, ... [sigma, or as in 60mm]")
      .option("row-angle", "tilt of the rows of user-supplied circles from the flow towards +y [degrees]")
      .option("dwell", "droplets that rest for this time count as clogged [t0]")
      .option("mixture",
              "COLUMN=VALUE:WEIGHT,...: length and survival curve of droplets mixed in these shares, such as "
              "diameter=2.8mm:0.3,3.2mm:0.7");
  line.add_commands(cli::names_of(clogfit_commands));
  if (!parse_file_command(line, argc, argv)) return console::exit_success;
  const std::vector<std::string> paths = line.require_all("file");
  const std::string format = line.get_word("format", {"text", "csv", "json"});
  const double confidence = line.get_share("confidence");
  const double from_distance = line.has("from-distance") ? line.get_positive("from-distance") : 0;
  const double dwell =
      line.has("dwell") ? line.get_positive("dwell") : std::numeric_limits<double>::infinity();
  for (const std::string& path : paths) {
    if (results::is_distance_table(path))
      throw Error(
          fmt::format("cannot read {0} (not a sweep); clogfit lengths {0} fits measured distances", path));
    if (path.find('=') != std::string::npos && !std::filesystem::exists(path))
      throw Error(fmt::format(
          "no place for '{}' (clogfit reads files; clogsweep select takes some rows of one)", path));
  }
  const store::SweepFile sweep = results::read_together(paths);
  if (sweep.rows.empty()) throw Error("no runs yet in " + joined(paths) + "; start or resume the sweep");
  for (const char* option : {"dwell", "mixture"})
    if (line.has(option) && std::ranges::none_of(sweep.rows, results::has_clogging_length))
      throw Error(fmt::format(
          "no place for --{} (droplets in a channel or on a wall have no clogging length); leave it out",
          option));
  const std::vector<const sweep::Column*> pooled =
      line.has("pool") ? results::pooled_columns(line.get("pool")) : std::vector<const sweep::Column*>();
  const results::LinesOf lines = lines_of(line, sweep.rows);
  std::vector<results::Group> groups =
      results::group_runs(sweep.rows, confidence, from_distance, dwell, pooled, lines);
  if (line.has("lines")) require_place_for_lines(line.get("lines"), lines, groups);
  if (line.has("row-angle")) set_row_angle(line.get("row-angle"), groups);
  set_scales(line, groups);
  std::optional<results::Mixture> mixture;
  if (line.has("mixture")) {
    if (format == "csv") throw Error("no place for --mixture in CSV; use --format text or json");
    mixture = results::mix(line.get("mixture"), groups, confidence);
  }
  const SharedParameters shared =
      line.has("all-parameters") ? SharedParameters::all : SharedParameters::unusual;
  std::cout << (format == "csv" ? results::to_csv(groups)
                : format == "json"
                    ? results::to_json(groups, confidence, sweep.provenance, mixture ? &*mixture : nullptr)
                    : results::to_text(groups, confidence, shared));
  if (format == "csv" && results::have_families(groups))
    console::say("clogfit: the table of daughters is not in CSV; --format text or json has it");
  if (format == "text" && line.has("pool"))
    std::cout << fmt::format("   groups that differ only in {} are joined (--pool)\n", line.get("pool"));
  if (format == "text" && mixture) std::cout << '\n' << results::to_text(*mixture, confidence);
  return console::exit_success;
}

}  // namespace

int main(int argc, char** argv) {
  console::prepare_streams();
  if (const auto exit_code = cli::run_command("clogfit", clogfit_commands, argc, argv)) return *exit_code;
  return cli::run_program("clogfit", [&] { return clogfit(argc, argv); });
}
