/// clogsweep: many independent runs, handed out to MPI ranks, gathered into one table.

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/core/error.hpp"
#include "clog/core/instruction_set.hpp"
#include "clog/core/systems.hpp"
#include "clog/parallel/communicator.hpp"
#include "clog/parallel/scheduler.hpp"
#include "clog/store/journal.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_job.hpp"
#include "clog/sweep/value_list.hpp"
#include "sweep_doctor.hpp"
#include "sweep_ledger.hpp"
#include "sweep_progress.hpp"
#include "sweep_reports.hpp"

namespace {

using namespace clog;

using Clock = std::chrono::steady_clock;
constexpr const char* program = "clogsweep";
constexpr const char* usage = R"(clogsweep runs droplets through obstacle arrays for every combination of the
given values, on all MPI ranks, and gathers the results in one HDF5 table.

  mpirun -np 4 clogsweep --config sweep.cfg --output sweep.h5 line-tension=0.2,1,5
  clogsweep --config sweep.cfg --dry-run
  clogsweep status sweep.h5         how far it is: lambda, <v_g>, time left; also while it runs
  clogsweep verify sweep.h5         is the file whole?
  clogsweep replay sweep.h5 TASK    one run once more: the same bits?
  mpirun -np 4 clogsweep doctor     will a sweep started like this go well here?

A sweep that was stopped or killed goes on with the same command.
)";

void parse(cli::CommandLine& line, int argc, char** argv) {
  namespace po = boost::program_options;
  line.add_options()("output", po::value<std::string>(), "HDF5 file to make")(
      "dry-run", "print the tasks, their number and cost, run nothing")("print-config",
                                                                        "print the settings, run nothing")(
      "master-computes", po::value<std::string>()->default_value("auto"),
      "does rank 0 run tasks too: auto (with up to 16 ranks), yes, no")(
      "max-hours", po::value<std::string>(),
      "stop after so many hours, as after a signal; the same command goes on")(
      "attempts", po::value<std::string>()->default_value("2"), "how often a run that fails is tried")(
      "report-seconds", po::value<std::string>()->default_value("10"),
      "how often a running task reports how far it has come; a kill loses no more than that");
  line.parse(argc, argv);
}

parallel::MasterComputes master_computes(const std::string& word) {
  if (word == "auto") return parallel::MasterComputes::automatic;
  if (word == "yes") return parallel::MasterComputes::yes;
  if (word == "no") return parallel::MasterComputes::no;
  throw Error("invalid --master-computes=" + word + " (is not one of auto, yes, no)");
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

std::int64_t attempts(const cli::CommandLine& line) {
  const double number = line.get_number("attempts", 2);
  if (!(number >= 1 && number <= 1000 && number == std::floor(number)))
    throw Error("invalid --attempts=" + line.get("attempts") + " (must be a whole number, 1..1000) try 2");
  return static_cast<std::int64_t>(number);
}

std::string number(double value) { return sweep::shortest(value); }

void print_tasks(const sweep::Plan& plan) {
  std::cout << "# task model line_tension wall_stiffness obstacle_gap obstacle_diameter obstacle_density "
               "near_wall_drag "
               "terminal_speed vertices time_step max_time seed\n";
  for (std::int64_t i = 0; i < plan.size() && !cli::stop_signalled(); ++i) {
    const sweep::RunRow row = sweep::describe(plan.task(i));
    std::cout << i << ' ' << row.model.view() << ' ' << number(row.line_tension) << ' '
              << number(row.wall_stiffness) << ' ' << number(row.obstacle_gap) << ' '
              << number(row.obstacle_diameter) << ' '
              << (row.obstacle_filling.view() == "saturated" ? "saturated" : number(row.obstacle_density))
              << ' ' << number(row.near_wall_drag) << ' ' << number(row.terminal_speed) << ' ' << row.vertices
              << ' ' << number(row.time_step) << ' ' << number(row.max_time) << ' ' << row.seed << '\n';
  }
  if (cli::stop_signalled()) return;
  const std::int64_t seeds = plan.size() / plan.num_groups();
  std::cout << "# " << plan.size() << " tasks: " << plan.num_groups()
            << (plan.num_groups() == 1 ? " parameter set" : " parameter sets") << ", " << seeds
            << (seeds == 1 ? " seed" : " seeds") << " each\n";
}

/// How long the sweep takes at most, from a short piece of the first and the last parameter set: what a step
/// costs per vertex there, times the steps of all runs if none of them ends before max-time.
void print_cost(const sweep::Plan& plan) {
  const auto vertex_steps = [](const RunParameters& run, double time) {
    return time / *run.time_step * (run.model == Model::dp ? run.dp.vertices : 1);
  };
  double seconds = 0;
  double work = 0;
  for (const std::int64_t group : std::set<std::int64_t>{0, plan.num_groups() - 1}) {
    const RunParameters run = plan.task(group);
    try {
      DropletRun droplet = run_in_array(run);
      const Clock::time_point begin = Clock::now();
      const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
      while (elapsed() < 0.5 && !droplet.advance(8)) continue;
      seconds += elapsed();
      work += vertex_steps(run, droplet.time());
    } catch (const Error&) {  // a droplet that cannot be released; its row would say so
    }
  }
  if (work == 0) {
    std::cout << "# core-hours not known: no droplet could be released\n";
    return;
  }
  double all_work = 0;
  for (std::int64_t group = 0; group < plan.num_groups(); ++group) {
    const RunParameters run = plan.task(group);
    all_work += vertex_steps(run, run.max_time);
  }
  all_work *= static_cast<double>(plan.size() / plan.num_groups());
  const double core_hours = seconds / work * all_work / 3600;
  std::printf(
      "# at most %.3g core-hours on this machine, %.3g us per step measured; runs that clog end sooner\n",
      core_hours, 1e6 * seconds / work * vertex_steps(plan.task(0), *plan.task(0).time_step));
}

store::Provenance provenance(const cli::CommandLine& line, int num_ranks) {
  store::Provenance all = cli::origin(line);
  all.emplace_back("mpi_version", parallel::Communicator::library_version());
  all.emplace_back("hdf5_version", store::library_version());
  all.emplace_back("num_ranks", std::to_string(num_ranks));
  return all;
}

void print_config(const sweep::Settings& settings, const sweep::Plan& plan) {
  const sweep::RunRow first = sweep::describe(plan.task(0));
  std::cout << settings.to_config(true);
  std::cout << "\n# Values behind `auto` in the first task:\n# wall-stiffness = "
            << number(first.wall_stiffness) << "\n# time-step = " << number(first.time_step) << '\n';
  if (first.model.view() == "dp")
    std::cout << "# area-stiffness = " << number(first.area_stiffness)
              << "\n# perimeter-stiffness = " << number(first.perimeter_stiffness) << '\n';
}

/// What rank 0 does before the sweep: everything a user can get wrong is found here, before any rank
/// computes. Returns the exit code if there is nothing to run.
std::optional<int> prepare(const cli::CommandLine& line) {
  if (cli::answer_help_or_version(
          line, {{"MPI", parallel::Communicator::library_version()}, {"HDF5", store::library_version()}}))
    return cli::exit_success;
  master_computes(line.get("master-computes"));
  report_interval(line);
  attempts(line);
  max_hours(line);
  const sweep::Plan plan(line.settings());
  if (line.has("print-config")) print_config(line.settings(), plan);
  if (line.has("dry-run")) {
    print_tasks(plan);
    std::cout.flush();
    if (cli::stop_signalled()) return cli::exit_incomplete;
    print_cost(plan);
  }
  if (line.has("print-config") || line.has("dry-run")) return cli::exit_success;
  line.require("output");
  return std::nullopt;
}

void announce(const std::string& output, std::int64_t num_runs, const SweepLedger& ledger, int num_ranks) {
  const auto num_left = static_cast<std::int64_t>(ledger.tasks_left().size());
  if (num_left < num_runs)
    std::cerr << output << " has " << num_runs - num_left << " of " << num_runs << " runs"
              << (num_left == 0 ? "; there is nothing left to do" : "") << std::endl;
  if (ledger.num_unreadable() > 0)
    std::cerr << store::journal_path(output) << ": " << ledger.num_unreadable()
              << (ledger.num_unreadable() == 1 ? " record is" : " records are")
              << " damaged; what was in there is computed again" << std::endl;
  if (ledger.num_resumed() > 0) std::cerr << ledger.num_resumed() << " go on where they were" << std::endl;
  if (num_left > 0)
    std::cerr << num_left << " runs on " << num_ranks
              << (num_ranks == 1 ? " computing rank" : " computing ranks") << ", results go to " << output
              << std::endl;
}

/// Rank 0's part of the sweep.
int lead(const parallel::Communicator& ranks, const cli::CommandLine& line, const sweep::Plan& plan,
         SweepLedger& ledger) {
  const bool computes = parallel::computes(ranks.size(), master_computes(line.get("master-computes")));
  const int computing_ranks = ranks.size() - (computes ? 0 : 1);
  const auto num_left = static_cast<std::int64_t>(ledger.tasks_left().size());
  announce(line.get("output"), plan.size(), ledger, computing_ranks);
  SweepProgress progress(
      std::cerr, isatty(STDERR_FILENO) ? SweepProgress::Screen::terminal : SweepProgress::Screen::plain,
      num_left, computing_ranks);
  bool interrupted = false;
  const Clock::time_point begin = Clock::now();
  const double hours = max_hours(line);
  parallel::SweepEvents events;
  events.started = [&](std::int64_t task, int rank) {
    progress.started(task);
    return ledger.start(task, rank);
  };
  events.progressed = [&](const parallel::Report& report) { ledger.report(report); };
  events.ended = [&](const parallel::Report& report) {
    ledger.report(report);
    if (report.row.status.view() == "failed" && ledger.tries_again(report.row)) {
      progress.tried(report.row.task);
      return;
    }
    progress.ended(report.row);
    interrupted = interrupted || report.row.status.view() == "interrupted";
  };
  events.tries_again = [&](const sweep::RunRow& failed) { return ledger.tries_again(failed); };
  events.idle = [&] {
    ledger.tick();
    progress.tick();
  };
  events.stop_requested = [&] {
    return cli::stop_signalled() ||
           std::chrono::duration<double, std::ratio<3600>>(Clock::now() - begin).count() >= hours;
  };
  const bool all_started =
      parallel::run_tasks(ranks, parallel::TaskOrder(ledger.tasks_left(), plan.num_groups()),
                          sweep::run_jobs(plan), events, computes, report_interval(line));
  ledger.finish();
  if (num_left > 0) progress.finish();
  if (all_started && !interrupted) return cli::exit_success;
  std::cerr << program << ": stopped by " << (cli::stop_signalled() ? "a signal" : "--max-hours")
            << "; the same command goes on. Finished rows and the distances so far are in "
            << line.get("output") << std::endl;
  return cli::exit_incomplete;
}

int sweep_on_all_ranks(const parallel::Communicator& ranks, int argc, char** argv) {
  // Rank 0 reads and checks; the others wait for its word: a config to run, or an exit code.
  cli::CommandLine line(program, usage, cli::CommandLine::SweepKeys::accepted);
  std::optional<sweep::Plan> plan;
  std::optional<SweepLedger> ledger;
  std::string word;
  if (ranks.rank() == 0) {
    const int exit_code = cli::run_program(program, [&] {
      parse(line, argc, argv);
      if (const auto over = prepare(line)) return *over;
      refuse_to_be_alone(ranks.size());
      plan.emplace(line.settings());
      ledger.emplace(line.get("output"), *plan, line.settings(), provenance(line, ranks.size()),
                     attempts(line));
      return cli::exit_success;
    });
    if (ledger && exit_code == cli::exit_success)
      word = "run " + line.get("report-seconds") + ' ' +
             (line.has("instruction-set") ? line.get("instruction-set") : "auto") + '\n' +
             line.settings().to_config(false);
    else
      word = "exit " + std::to_string(exit_code);
  }
  word = ranks.broadcast(word);
  if (word.starts_with("exit ")) return std::stoi(word.substr(5));

  if (ranks.rank() == 0) return lead(ranks, line, *plan, *ledger);
  const std::size_t end_of_line = word.find('\n');
  const std::size_t space = word.find(' ', 4);
  use_instruction_set(word.substr(space + 1, end_of_line - space - 1));
  plan.emplace(sweep::Settings::from_config(word.substr(end_of_line + 1)));
  parallel::run_tasks(ranks, parallel::TaskOrder(0), sweep::run_jobs(*plan), {}, false,
                      seconds_from(word.substr(4, space - 4)));
  return cli::exit_success;
}

}  // namespace

int main(int argc, char** argv) {
  // What needs no ranks.
  const std::map<std::string_view, int (*)(int, const char* const*)> reports = {
      {"status", clogsweep_status}, {"verify", clogsweep_verify}, {"replay", clogsweep_replay}};
  if (const auto report = argc > 1 ? reports.find(argv[1]) : reports.end(); report != reports.end())
    return cli::run_program(std::string(program) + ' ' + argv[1], [&] { return report->second(argc, argv); });
  cli::catch_stop_signals();  // one that comes before the sweep begins stops it then
  const parallel::Communicator ranks(argc, argv);
  try {
    if (argc > 1 && std::string_view(argv[1]) == "doctor") return clogsweep_doctor(ranks, argc, argv);
    return sweep_on_all_ranks(ranks, argc, argv);
  } catch (const std::exception& error) {
    // Once the sweep runs, ranks wait for each other: a fault of one must end all.
    std::cerr << program << ": rank " << ranks.rank() << " on " << parallel::Communicator::host_name() << ": "
              << error.what() << std::endl;
    if (ranks.size() > 1)
      ranks.abort(dynamic_cast<const Error*>(&error) ? cli::exit_user_fault : cli::exit_internal_fault);
    return dynamic_cast<const Error*>(&error) ? cli::exit_user_fault : cli::exit_internal_fault;
  }
}
