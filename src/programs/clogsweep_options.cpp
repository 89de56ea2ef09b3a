#include "clogsweep_options.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clog/cli/obstacle_file.hpp"
#include "clog/cli/points_file.hpp"
#include "clog/cli/program.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/results/run_list.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/value_list.hpp"
#include "clogsweep_commands.hpp"
#include "laboratory_option.hpp"

namespace clog::programs {
namespace {

scheduler::MasterComputes master_computes(const cli::CommandLine& line) {
  const std::string word = line.get_word("master-computes", {"auto", "yes", "no"});
  return word == "auto"  ? scheduler::MasterComputes::automatic
         : word == "yes" ? scheduler::MasterComputes::yes
                         : scheduler::MasterComputes::no;
}

scheduler::Log::Level log_level(const cli::CommandLine& line) {
  if (line.has("verbose") && line.has("quiet"))
    throw Error("--verbose and --quiet exclude each other; give one");
  return line.has("verbose") ? scheduler::Log::Level::verbose
         : line.has("quiet") ? scheduler::Log::Level::quiet
                             : scheduler::Log::Level::normal;
}

std::chrono::milliseconds report_interval(const cli::CommandLine& line) {
  constexpr double shortest = 0.001, longest = 1e9;
  const double seconds = line.get_positive("report-seconds");
  if (seconds < shortest || seconds > longest)
    throw Error(fmt::format("invalid --report-seconds={} (must be {} to {}) try 10",
                            line.get("report-seconds"), shortest, longest));
  return std::chrono::milliseconds(std::llround(1000 * seconds));
}

double max_hours(const cli::CommandLine& line) {
  return line.has("max-hours") ? line.get_positive("max-hours") : std::numeric_limits<double>::infinity();
}

double precision(const cli::CommandLine& line) {
  std::string text = line.get("until-precision");
  const bool is_percent = text.ends_with('%');
  if (is_percent) text.pop_back();
  double number = 0;
  try {
    number = sweep::to_number(text) / (is_percent ? 100 : 1);
  } catch (const Error&) {
    // the code below reports it with the option's name
  }
  if (number >= 0.001 && number < 1) return number;
  throw Error("invalid --until-precision=" + line.get("until-precision") +
              " (must lie between 0.1% and 100%) try 20%");
}

/// Whether every point has a text for this key. The key's text on the command line then has no effect.
bool is_full(const sweep::Points& points, std::size_t place) {
  return std::ranges::none_of(points.rows, [&](const auto& row) { return row[place].empty(); });
}

/// Adds the laboratory, points and shard of --lab, --points and --shard to the settings.
void add_plan_options(cli::CommandLine& line) {
  sweep::Settings& settings = line.settings();
  sweep::Points points = settings.points();
  std::string path = line.has("lab") ? line.get("lab") : "";
  if (line.has("points")) {
    path = line.get("points");
    points = cli::read_points(path);
    for (std::size_t i = 0; i < points.keys.size(); ++i)
      if (const std::string& key = points.keys[i]; line.has(key) && is_full(points, i))
        throw Error(fmt::format(
            "{0} names the key {1}, and so does the command line; give {1} in one of them only", path, key));
  }
  use_laboratories(line, points);
  if (!path.empty() && !points.empty()) {
    points.file = path;
    settings.set_points(points);
    for (const std::string& file : settings.missing_files()) settings.attach(file, cli::read_circles(file));
  }
  if (!line.has("shard")) return;
  try {
    settings.set_shard(sweep::Shard::from(line.get("shard")));
  } catch (const Error& error) {
    throw Error(fmt::format("invalid --shard={} ({})", line.get("shard"), error.what()));
  }
}

/// Refuses the suffix of another format, because the table is always an HDF5 file.
void refuse_other_format(const cli::CommandLine& line) {
  if (!line.has("output")) return;
  const std::string name = line.get("output");
  for (const char* ending : {".csv", ".txt", ".json", ".xlsx", ".cfg"})
    if (name.ends_with(ending))
      throw Error(
          fmt::format("invalid --output={} (a sweep is stored as HDF5) give --output {}.h5; clogfit --format "
                      "csv makes a table of its results",
                      name, name.substr(0, name.size() - std::string(ending).size())));
}

/// Implements --seeds-per-set: keeps the seeds that the keys give and those of the rows in the output, and
/// adds the smallest unused seeds. So a killed sweep gets the same seeds again.
void fill_seeds(cli::CommandLine& line) {
  if (!line.has("seeds-per-set")) return;
  for (const char* other : {"until-precision", "shard"})
    if (line.has(other))
      throw Error(fmt::format("--seeds-per-set and --{} both choose seeds; give one of them", other));
  constexpr long long most = 100'000;
  const std::int64_t number = line.get_whole("seeds-per-set", 1, 1, most);
  const sweep::Settings& settings = line.settings();
  results::RunList runs;
  runs.add(sweep::Plan(settings));
  if (const std::string path = line.has("output") ? line.get("output") : ""; std::filesystem::exists(path))
    for (const sweep::RunRow& row : results::read_with_caution(path).rows)
      if (sweep::fault_of(row).empty()) runs.add_seed(row);
  runs.fill_seeds(static_cast<std::size_t>(number));
  line.settings() = runs.settings();
}

}  // namespace

bool parse_sweep_options(cli::CommandLine& line, int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]).starts_with("--refine"))
      throw Error(
          "--refine is a command of its own: python3 -m clogsweep refine KEY KEY=FROM,TO --until curve=20% "
          "--output sweep.h5 -- mpirun -np 4");
  line.option("output", "HDF5 file to create or to resume")
      .option(
          "lab",
          "file that describes the laboratory, see clogfit units; determines terminal-speed and line-tension "
          "or\nwall-stiffness unless these keys are set; clogfit then prints laboratory units, too")
      .flag("dry-run", "print the tasks, the number of tasks and their cost, run nothing")
      .option("format",
              "format of --dry-run: text, or json for a line with the tasks and a line with the cost")
      .flag("print-config", "print the settings, run nothing")
      .flag("schema", "print all keys and columns as JSON: meaning, unit, range, default; run nothing")
      .option("master-computes", "whether rank 0 also runs tasks: auto (with up to 16 ranks), yes, no",
              "auto")
      .option("max-hours", "stop the sweep after this number of hours; the same command resumes it")
      .option("points",
              "CSV file with parameter sets in place of lists: the first line names keys, each further line "
              "has their values")
      .option("shard", "run one part of the sweep, e.g. 2/5 for the second of five parts")
      .option(
          "until-precision",
          "add seeds to each parameter set until the half-width of lambda's 95 % interval is at most this "
          "fraction of lambda, e.g. 10%")
      .option("most-seeds",
              "largest number of seeds of a parameter set with --until-precision (20 times the number of "
              "`seeds`)")
      .option("seeds-per-set",
              "add seeds to every parameter set until it has this number, including seeds in the output file")
      .option("attempts", "number of attempts for a run that crashes", "2")
      .option("report-seconds",
              "interval at which a running task reports its progress; a killed task loses at most this time",
              "10")
      .option(
          "isolate",
          "run each task in a separate process, so that a crash costs one task and not the sweep: yes, no",
          "yes")
      .flag("verbose", "print a line for every task that starts or ends")
      .flag("quiet", "print errors only");
  std::vector<std::string> commands = cli::names_of(file_commands);
  commands.emplace_back("doctor");
  line.add_commands(std::move(commands));
  line.explain_surplus_words(
      "--output names the file of a sweep, and clogsweep status FILE prints its progress");
  if (!cli::parse_command(
          line, argc, argv,
          {{"MPI", scheduler::Communicator::library_version()}, {"HDF5", store::library_version()}}))
    return false;
  refuse_other_format(line);
  add_plan_options(line);
  fill_seeds(line);
  return true;
}

scheduler::DriverOptions driver_options(const cli::CommandLine& line) {
  return {.output = line.has("output") ? line.get("output") : "",
          .master_computes = master_computes(line),
          .report_interval = report_interval(line),
          .max_hours = max_hours(line),
          .log = log_level(line)};
}

scheduler::Assignment assignment(const cli::CommandLine& line, const sweep::Settings& settings) {
  return {.report_interval = report_interval(line),
          .instruction_set = line.has("instruction-set") ? line.get("instruction-set") : "auto",
          .is_isolated = line.get_word("isolate", {"yes", "no"}) == "yes",
          .settings = settings.packed()};
}

results::PreviewFormat preview_format(const cli::CommandLine& line) {
  if (!line.has("format")) return results::PreviewFormat::text;
  if (!line.has("dry-run")) throw Error("--format needs --dry-run");
  if (line.get_word("format", {"text", "json"}) == "text") return results::PreviewFormat::text;
  if (line.has("print-config")) throw Error("--print-config prints no JSON; drop --format json");
  return results::PreviewFormat::json;
}

std::int64_t attempts(const cli::CommandLine& line) { return line.get_whole("attempts", 2, 1, 1000); }

std::optional<results::GrowingSweep> growing_sweep(const cli::CommandLine& line) {
  if (!line.has("until-precision")) {
    if (line.has("most-seeds")) throw Error("--most-seeds needs --until-precision");
    return std::nullopt;
  }
  const auto first_seeds = static_cast<std::int64_t>(line.settings().values("seeds").size());
  const std::int64_t most = line.get_whole("most-seeds", 20 * first_seeds, first_seeds, 100'000);
  return results::growing_sweep(line.settings(), precision(line), most);
}

}  // namespace clog::programs
