/// clogsweep: many independent runs, handed out to MPI ranks, gathered into one table.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/core/error.hpp"
#include "clog/core/instruction_set.hpp"
#include "clog/parallel/communicator.hpp"
#include "clog/parallel/isolated_jobs.hpp"
#include "clog/parallel/scheduler.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_job.hpp"
#include "clog/sweep/schema_json.hpp"
#include "clog/sweep/value_list.hpp"
#include "seed_rule.hpp"
#include "sweep_doctor.hpp"
#include "sweep_lead.hpp"
#include "sweep_ledger.hpp"
#include "sweep_preview.hpp"
#include "sweep_reports.hpp"

namespace {

using namespace clog;

constexpr const char* program = "clogsweep";
constexpr const char* usage = R"(clogsweep runs droplets through obstacle arrays for every combination of the
given values, on all MPI ranks, and gathers the results in one HDF5 table.

  mpirun -np 4 clogsweep --config sweep.cfg --output sweep.h5 line-tension=0.2,1,5
  clogsweep --config sweep.cfg --dry-run
  clogsweep status sweep.h5         how far it is: lambda, <v_g>, time left; also while it runs
  clogsweep verify sweep.h5         is the file whole?
  clogsweep salvage sweep.h5 --output whole.h5     what is whole of a damaged one
  clogsweep replay sweep.h5 TASK    one run once more: the same bits?
  mpirun -np 4 clogsweep doctor     will a sweep started like this go well here?

A sweep that was stopped or killed goes on with the same command.
)";

void parse(cli::CommandLine& line, int argc, char** argv) {
  namespace po = boost::program_options;
  line.add_options()("output", po::value<std::string>(), "HDF5 file to make")(
      "dry-run", "print the tasks, their number and cost, run nothing")("print-config",
                                                                        "print the settings, run nothing")(
      "schema", "print all keys and columns as JSON: meaning, unit, range, default; run nothing")(
      "master-computes", po::value<std::string>()->default_value("auto"),
      "does rank 0 run tasks too: auto (with up to 16 ranks), yes, no")(
      "max-hours", po::value<std::string>(),
      "stop after so many hours, as after a signal; the same command goes on")(
      "until-precision", po::value<std::string>(),
      "add seeds until lambda is known so well, e.g. 10%: half its 95 % interval over lambda")(
      "most-seeds", po::value<std::string>(), "with --until-precision: per parameter set (20 times `seeds`)")(
      "attempts", po::value<std::string>()->default_value("2"), "how often a run that fails is tried")(
      "report-seconds", po::value<std::string>()->default_value("10"),
      "how often a running task reports how far it has come; a kill loses no more than that")(
      "isolate", po::value<std::string>()->default_value("yes"),
      "tasks run in processes of their own, so that a crash costs one task and not the sweep: yes, no")(
      "verbose", "a line for every task that starts or ends")("quiet", "errors only");
  line.add_commands({"status", "verify", "replay", "salvage", "doctor"});
  line.explain_surplus_words(
      "--output names the file of a sweep, and clogsweep status FILE tells how far it is");
  line.parse(argc, argv);
}

parallel::MasterComputes master_computes(const std::string& word) {
  if (word == "auto") return parallel::MasterComputes::automatic;
  if (word == "yes") return parallel::MasterComputes::yes;
  if (word == "no") return parallel::MasterComputes::no;
  throw Error("invalid --master-computes=" + word + " (is not one of auto, yes, no)");
}

void check_isolate(const cli::CommandLine& line) {
  const std::string word = line.get("isolate");
  if (word != "yes" && word != "no") throw Error("invalid --isolate=" + word + " (is not one of yes, no)");
}

SweepLog::Level log_level(const cli::CommandLine& line) {
  if (line.has("verbose") && line.has("quiet"))
    throw Error("--verbose and --quiet exclude each other; give one");
  return line.has("verbose") ? SweepLog::Level::verbose
         : line.has("quiet") ? SweepLog::Level::quiet
                             : SweepLog::Level::normal;
}

std::chrono::milliseconds seconds_from(const std::string& text) {
  return std::chrono::milliseconds(std::llround(1000 * sweep::to_number(text)));
}

std::chrono::milliseconds report_interval(const cli::CommandLine& line) {
  const std::chrono::milliseconds interval = seconds_from(line.get("report-seconds"));
  if (interval.count() < 1)
    throw Error("invalid --report-seconds=" + line.get("report-seconds") + " (must be 0.001 or more) try 10");
  return interval;
}

double max_hours(const cli::CommandLine& line) {
  return line.has("max-hours") ? line.get_positive("max-hours") : std::numeric_limits<double>::infinity();
}

/// Checked, the output's name excepted.
LeadOptions lead_options(const cli::CommandLine& line) {
  return {.output = line.has("output") ? line.get("output") : "",
          .master_computes = master_computes(line.get("master-computes")),
          .report_interval = report_interval(line),
          .max_hours = max_hours(line),
          .log = log_level(line)};
}

std::int64_t attempts(const cli::CommandLine& line) {
  const double number = line.get_number("attempts", 2);
  if (!(number >= 1 && number <= 1000 && number == std::floor(number)))
    throw Error("invalid --attempts=" + line.get("attempts") + " (must be a whole number, 1..1000) try 2");
  return static_cast<std::int64_t>(number);
}

double precision(const cli::CommandLine& line) {
  std::string text = line.get("until-precision");
  const bool is_percent = text.ends_with('%');
  if (is_percent) text.pop_back();
  double number = 0;
  try {
    number = sweep::to_number(text) / (is_percent ? 100 : 1);
  } catch (const Error&) {
    // said below, with the option's name
  }
  if (number >= 0.001 && number < 1) return number;
  throw Error("invalid --until-precision=" + line.get("until-precision") +
              " (must lie between 0.1% and 100%) try 20%");
}

std::int64_t most_seeds(const cli::CommandLine& line, std::int64_t first_seeds) {
  const double number = line.get_number("most-seeds", static_cast<double>(20 * first_seeds));
  if (!(number >= static_cast<double>(first_seeds) && number <= 1e5 && number == std::floor(number)))
    throw Error("invalid --most-seeds=" + line.get("most-seeds") + " (must be a whole number from " +
                std::to_string(first_seeds) + ", the number of `seeds`, to 1e5)");
  return static_cast<std::int64_t>(number);
}

/// A sweep that --until-precision may enlarge: its plan has all seeds that it may come to, those of the
/// settings first.
struct Enlarged {
  sweep::Settings settings;
  std::int64_t num_first = 0;  ///< tasks to begin with
  std::optional<SeedRule> rule;
};
/// @param plan  of the settings
Enlarged enlarge(const cli::CommandLine& line, const sweep::Plan& plan) {
  Enlarged sweep{line.settings(), plan.size(), std::nullopt};
  if (!line.has("until-precision")) {
    if (line.has("most-seeds")) throw Error("--most-seeds needs --until-precision");
    return sweep;
  }
  const std::vector<std::string>& seeds = line.settings().values("seeds");
  const auto first_seeds = static_cast<std::int64_t>(seeds.size());
  const std::int64_t most = most_seeds(line, first_seeds);
  sweep.rule.emplace(precision(line), sweep.num_first / first_seeds, first_seeds, most);
  if (most == first_seeds) return sweep;
  long long last = 0;
  for (const std::string& seed : seeds) last = std::max(last, sweep::to_integer(seed));
  constexpr long long largest_seed = 4'294'967'295;
  if (last + most - first_seeds > largest_seed)
    throw Error("invalid --most-seeds=" + std::to_string(most) + " (seeds after " + std::to_string(last) +
                " would exceed " + std::to_string(largest_seed) + ") begin with smaller seeds");
  sweep.settings.set("seeds", line.settings().text("seeds") + "," + std::to_string(last + 1) + ".." +
                                  std::to_string(last + most - first_seeds));
  return sweep;
}

store::Provenance provenance(const cli::CommandLine& line, const Enlarged& sweep, int num_ranks) {
  store::Provenance all = cli::origin(line);
  all.emplace_back("mpi_version", parallel::Communicator::library_version());
  all.emplace_back("hdf5_version", store::library_version());
  all.emplace_back("num_ranks", std::to_string(num_ranks));
  if (!sweep.rule) return all;
  for (auto& [name, text] : all)
    if (name == "config") text = sweep.settings.to_config(false);
  all.emplace_back("stopping_rule", sweep.rule->text());
  all.emplace_back("num_wanted", std::to_string(sweep.num_first));
  return all;
}

/// What rank 0 does before the sweep: everything a user can get wrong is found here, before any rank
/// computes. Returns the exit code if there is nothing to run.
std::optional<int> prepare(const cli::CommandLine& line) {
  if (cli::answer_help_or_version(
          line, {{"MPI", parallel::Communicator::library_version()}, {"HDF5", store::library_version()}}))
    return cli::exit_success;
  if (line.has("schema")) {
    std::cout << sweep::schema_json().dump(2) << '\n';
    return cli::exit_success;
  }
  lead_options(line);
  attempts(line);
  check_isolate(line);
  const sweep::Plan plan(line.settings());
  enlarge(line, plan);
  if (line.has("print-config")) print_config(line.settings(), plan);
  if (line.has("dry-run")) {
    print_tasks(plan);
    cli::flush_output();
    if (cli::stop_signalled()) return cli::exit_incomplete;
    print_limits(plan);
    return print_cost(plan, lead_options(line).output);
  }
  if (line.has("print-config")) return cli::exit_success;
  line.require("output");
  return std::nullopt;
}

/// What rank 0 tells the others: what they are to do, and how. Travels as text.
struct Assignment {
  std::string report_seconds;
  std::string instruction_set;
  std::string isolate;
  std::string config;

  std::string text() const { return report_seconds + ' ' + instruction_set + ' ' + isolate + '\n' + config; }
  static Assignment from(const std::string& text) {
    Assignment assignment;
    std::istringstream words(text);
    words >> assignment.report_seconds >> assignment.instruction_set >> assignment.isolate;
    assignment.config = text.substr(text.find('\n') + 1);
    return assignment;
  }
};

/// The jobs of an assignment, in whichever process they are to be worked on.
sweep::JobFactory assigned_jobs(const std::string& text) {
  const Assignment assignment = Assignment::from(text);
  use_instruction_set(assignment.instruction_set);
  const auto plan = std::make_shared<sweep::Plan>(sweep::Settings::from_config(assignment.config));
  return [plan, make_job = sweep::run_jobs(*plan)](std::int64_t task, std::span<const std::byte> snapshot) {
    return make_job(task, snapshot);
  };
}

int sweep_on_all_ranks(const parallel::Communicator& ranks, parallel::IsolatedJobs& isolated, int argc,
                       char** argv) {
  // Rank 0 reads and checks; the others wait for its word: a config to run, or an exit code.
  cli::CommandLine line(program, usage, cli::CommandLine::SweepKeys::accepted);
  Enlarged sweep;
  std::optional<sweep::Plan> plan;
  std::optional<SweepLedger> ledger;
  std::string word;
  if (ranks.rank() == 0) {
    const int exit_code = cli::run_program(program, [&] {
      parse(line, argc, argv);
      if (const auto over = prepare(line)) return *over;
      refuse_to_be_alone(ranks.size());
      sweep = enlarge(line, sweep::Plan(line.settings()));
      plan.emplace(sweep.settings);
      ledger.emplace(line.get("output"), *plan, sweep.settings, provenance(line, sweep, ranks.size()),
                     sweep.num_first, attempts(line));
      return cli::exit_success;
    });
    if (ledger && exit_code == cli::exit_success)
      word = Assignment{line.get("report-seconds"),
                        line.has("instruction-set") ? line.get("instruction-set") : "auto",
                        line.get("isolate"), sweep.settings.to_config(false)}
                 .text();
    else
      word = "exit " + std::to_string(exit_code);
  }
  word = ranks.broadcast(word);
  if (word.starts_with("exit ")) return std::stoi(word.substr(5));

  const Assignment assignment = Assignment::from(word);
  const sweep::JobFactory make_job = assignment.isolate == "yes" ? isolated.jobs(word) : assigned_jobs(word);
  if (ranks.rank() == 0) return lead_sweep(ranks, lead_options(line), *plan, make_job, *ledger, sweep.rule);
  follow_sweep(ranks, make_job, seconds_from(assignment.report_seconds));
  return cli::exit_success;
}

}  // namespace

int main(int argc, char** argv) {
  cli::prepare_streams();
  // What needs no ranks.
  const std::map<std::string_view, int (*)(int, const char* const*)> reports = {
      {"status", clogsweep_status},
      {"verify", clogsweep_verify},
      {"replay", clogsweep_replay},
      {"salvage", clogsweep_salvage}};
  if (const auto report = argc > 1 ? reports.find(argv[1]) : reports.end(); report != reports.end())
    return cli::run_program(std::string(program) + ' ' + argv[1], [&] { return report->second(argc, argv); });
  cli::catch_stop_signals();  // one that comes before the sweep begins stops it then
  std::optional<parallel::IsolatedJobs> isolated;
  const int exit_code = cli::run_program(program, [&] {
    isolated.emplace(assigned_jobs);  // before MPI begins
    return cli::exit_success;
  });
  if (exit_code != cli::exit_success) return exit_code;
  const parallel::Communicator ranks(argc, argv);
  try {
    if (argc > 1 && std::string_view(argv[1]) == "doctor") return clogsweep_doctor(ranks, argc, argv);
    return sweep_on_all_ranks(ranks, *isolated, argc, argv);
  } catch (const std::exception& error) {
    // Once the sweep runs, ranks wait for each other: a fault of one must end all.
    cli::say(std::string(program) + ": rank " + std::to_string(ranks.rank()) + " on " +
             parallel::Communicator::host_name() + ": " + error.what());
    if (ranks.size() > 1)
      ranks.abort(dynamic_cast<const Error*>(&error) ? cli::exit_user_fault : cli::exit_internal_fault);
    return dynamic_cast<const Error*>(&error) ? cli::exit_user_fault : cli::exit_internal_fault;
  }
}
