#include "clogfit_lengths.hpp"

#include <fmt/core.h>

#include <iostream>
#include <optional>
#include <string>
#include <utility>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/results/distance_file.hpp"
#include "clog/results/distance_table.hpp"
#include "laboratory_of_results.hpp"

namespace clog::programs {
namespace {

constexpr const char* lengths_usage =
    R"(clogfit lengths estimates clogging lengths from distances that you measured, exactly as clogfit
does from a sweep: maximum likelihood for censored distances, chi-squared intervals, survival, doubts.

  clogfit lengths distances.csv
  clogfit lengths distances.csv --lab lab.cfg            lengths in mm and in droplet diameters
  clogfit lengths distances.csv --format csv > table.csv
  clogfit compare distances.csv sweep.h5 --lab lab.cfg   in comparison with simulated distances

The first line of the table names its columns, and each further line is one droplet:

  distance [mm],clogged,wall
  41.5,1,glass
  120,0,glass

distance: how far the droplet travelled, in nm, um, mm, cm, m or sigma (droplet diameters); clogged: 1 if the
droplet clogged, 0 if it left the picture or was still moving (censored). Droplets with the same values in all other
columns form a group. A column diameter [mm] gives lengths in the diameters of each group's own droplets, too.
)";

}  // namespace

int clogfit_lengths(int argc, const char* const* argv) {
  cli::CommandLine line("clogfit lengths", lengths_usage);
  line.word("file", "table of distances (CSV)")
      .option("format", "text, csv or json", "text")
      .option("confidence", "confidence level of the intervals", "0.95")
      .option("from-distance",
              "count distances only from this distance on; droplets that ended before it are excluded [mm, "
              "or sigma if the table is in sigma]")
      .option("lab",
              "file that describes the laboratory, see clogfit units; the diameter in this file is sigma");
  if (!cli::parse_command(line, argc, argv)) return console::exit_success;
  const std::string format = line.get_word("format", {"text", "csv", "json"});
  const double confidence = line.get_share("confidence");
  const std::string path = line.require("file");
  if (path.ends_with(".h5"))
    throw Error(fmt::format("cannot read {0} (a table of distances is CSV); clogfit {0} fits a sweep", path));
  results::DistanceTable table = results::read_distances(path, results::names_of_lengths());
  if (line.has("from-distance"))
    table = results::counted_from(line.get_positive("from-distance"), std::move(table));
  const std::optional<double> sigma_mm = sigma_in_mm(line, {});
  std::cout << (format == "csv"    ? results::lengths_csv(table, confidence, sigma_mm)
                : format == "json" ? results::lengths_json(table, confidence, sigma_mm)
                                   : results::lengths_text(table, confidence, sigma_mm));
  return console::exit_success;
}

}  // namespace clog::programs
