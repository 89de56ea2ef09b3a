#include "clogfit_curve.hpp"

#include <fmt/core.h>

#include <iostream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "clog/campaign/curve_table.hpp"
#include "clog/campaign/curves.hpp"
#include "clog/campaign/merger.hpp"
#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/rounded.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/value_list.hpp"
#include "laboratory_option.hpp"

namespace clog::programs {
namespace {

constexpr const char* curve_usage =
    R"(clogfit curve fits a smooth curve through the clogging lengths of a sweep, as a function of a key that it varies
(or of two), and says with intervals how long lambda is anywhere between, where it is highest, and where it crosses a
given length.

  clogfit curve sweep.h5
  clogfit curve sweep.h5 --key line-tension --crossing 10,100
  clogfit curve sweep.h5 --key line-tension,friction --format csv > surface.csv
  clogfit curve monday.h5 tuesday.h5           several files as one sweep

Runs that went a way S together and clogged d times are a Poisson count with exposure, so points without a clog inform
the curve as bounds. log lambda is a Gaussian process over the logarithm of the key. Keys that are not named tell curves
apart. csv and json have the whole curve, in 97 places (25 x 25 with two keys), and those of each mechanism.

Runs of the same seed met the same obstacles at every value of a key that does not change the array. Then the errors of
the points are correlated, but the band takes them for independent. Seeds of their own at each value (clogsweep --refine)
avoid this.
)";

std::vector<double> lengths_of(const cli::CommandLine& line) {
  std::vector<double> lengths;
  if (!line.has("crossing")) return lengths;
  std::string text = line.get("crossing");
  try {
    for (const std::string& word : sweep::expand_list(text, ValueKind::number, {}))
      lengths.push_back(sweep::to_number(word));
  } catch (const Error& error) {
    throw Error(fmt::format("invalid --crossing={} ({}) try 10,100", text, error.what()));
  }
  for (const double length : lengths)
    if (!(length > 0))
      throw Error(fmt::format("invalid --crossing={} (lengths must be positive) try 10,100", text));
  return lengths;
}

}  // namespace

int clogfit_curve(int argc, const char* const* argv) {
  namespace po = boost::program_options;
  cli::CommandLine line("clogfit curve", curve_usage, cli::CommandLine::SweepKeys::none);
  const auto text = [] { return po::value<std::string>(); };
  line.add_options()("file", po::value<std::vector<std::string>>(), "sweep files, fitted as one sweep")(
      "key", text(), "that the curve is drawn over, or two with a comma between")(
      "crossing", text(), "lengths that the curve may cross [sigma]")("format", text()->default_value("text"),
                                                                      "text, csv or json")(
      "confidence", text()->default_value("0.95"), "of the intervals")(
      "from-distance", text(), "see clogfit --help [sigma]")("dwell", text(), "see clogfit --help [t0]")(
      "lab", text(),
      "file that describes the laboratory, see clogfit units; its units are told below the curve");
  line.add_positional("file", -1);
  line.parse(argc - 1, argv + 1);
  if (cli::answer_help_or_version(line, {{"HDF5", store::library_version()}})) return console::exit_success;
  if (!line.has("file")) throw Error("missing sweep file; try clogfit curve sweep.h5");
  const std::string format = line.get_word("format", {"text", "csv", "json"});
  campaign::CurveQuestion question{{}, line.get_share("confidence"), lengths_of(line)};
  const double from_distance = line.has("from-distance") ? line.get_positive("from-distance") : 0;
  const double dwell =
      line.has("dwell") ? line.get_positive("dwell") : std::numeric_limits<double>::infinity();

  const std::vector<std::string> paths = line.get_all("file");
  const store::SweepFile sweep = campaign::read_together(paths);
  if (sweep.rows.empty()) throw Error(joined(paths) + " has no runs yet; let the sweep finish some first");
  if (!campaign::has_clogging_length(sweep.rows.front()))
    throw Error("cannot fit a curve (droplets in a channel or on a wall have no clogging length)");
  const std::vector<campaign::Group> groups =
      campaign::group_runs(sweep.rows, question.confidence, from_distance, dwell);
  question.keys = campaign::curve_keys(groups, line.has("key") ? line.get("key") : "");
  if (question.keys.size() > 1 && !question.crossed_lengths.empty())
    throw Error(
        "no place for --crossing (a surface over two keys crosses a length along lines); give one --key");
  const std::vector<campaign::FittedCurve> curves = campaign::fit_curves(groups, question);
  const std::optional<campaign::LaboratoryScale> lab = laboratory_scale(line, sweep, paths.front());
  std::cout << (format == "csv"    ? campaign::curves_to_csv(curves, question)
                : format == "json" ? campaign::curves_to_json(curves, groups, question)
                                   : campaign::curves_to_text(curves, groups, question));
  if (lab && format == "text")
    std::cout << fmt::format("in the laboratory: sigma = {} mm, Gamma = 1 is {} mN/m\n",
                             console::plain(lab->length), console::plain(lab->tension));
  return console::exit_success;
}

}  // namespace clog::programs
