/// clogsweep: many independent runs, handed out to MPI ranks, gathered into one table.

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <set>
#include <sstream>
#include <string>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/core/error.hpp"
#include "clog/core/systems.hpp"
#include "clog/parallel/communicator.hpp"
#include "clog/parallel/scheduler.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_job.hpp"
#include "row_writer.hpp"
#include "sweep_progress.hpp"

namespace {

using namespace clog;

constexpr const char* program = "clogsweep";
constexpr const char* usage = R"(clogsweep runs droplets through obstacle arrays for every combination of the
given values, on all MPI ranks, and gathers the results in one HDF5 table.

  mpirun -np 4 clogsweep --config sweep.cfg --output sweep.h5 line-tension=0.2,1,5
  clogsweep --config sweep.cfg --dry-run
)";

void parse(cli::CommandLine& line, int argc, char** argv) {
  namespace po = boost::program_options;
  line.add_options()("output", po::value<std::string>(), "HDF5 file to make")(
      "dry-run", "print the tasks, their number and cost, run nothing")("print-config",
                                                                        "print the settings, run nothing")(
      "master-computes", po::value<std::string>()->default_value("auto"),
      "does rank 0 run tasks too: auto (with up to 16 ranks), yes, no");
  line.parse(argc, argv);
}

parallel::MasterComputes master_computes(const std::string& word) {
  if (word == "auto") return parallel::MasterComputes::automatic;
  if (word == "yes") return parallel::MasterComputes::yes;
  if (word == "no") return parallel::MasterComputes::no;
  throw Error("invalid --master-computes=" + word + " (is not one of auto, yes, no)");
}

std::string number(double value) { return sweep::shortest(value); }

void print_tasks(const sweep::Plan& plan) {
  std::cout << "# task model line_tension wall_stiffness obstacle_gap obstacle_diameter obstacle_density "
               "near_wall_drag "
               "terminal_speed vertices time_step max_time seed\n";
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    const sweep::RunRow row = sweep::describe(plan.task(i));
    std::cout << i << ' ' << row.model.view() << ' ' << number(row.line_tension) << ' '
              << number(row.wall_stiffness) << ' ' << number(row.obstacle_gap) << ' '
              << number(row.obstacle_diameter) << ' '
              << (row.obstacle_filling.view() == "saturated" ? "saturated" : number(row.obstacle_density))
              << ' ' << number(row.near_wall_drag) << ' ' << number(row.terminal_speed) << ' ' << row.vertices
              << ' ' << number(row.time_step) << ' ' << number(row.max_time) << ' ' << row.seed << '\n';
  }
  const std::int64_t seeds = plan.size() / plan.num_groups();
  std::cout << "# " << plan.size() << " tasks: " << plan.num_groups()
            << (plan.num_groups() == 1 ? " parameter set" : " parameter sets") << ", " << seeds
            << (seeds == 1 ? " seed" : " seeds") << " each\n";
}

/// How long the sweep takes at most, from a short piece of the first and the last parameter set: what a step
/// costs per vertex there, times the steps of all runs if none of them ends before max-time.
void print_cost(const sweep::Plan& plan) {
  using Clock = std::chrono::steady_clock;
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
  const sweep::Plan plan(line.settings());
  if (line.has("print-config")) print_config(line.settings(), plan);
  if (line.has("dry-run")) {
    print_tasks(plan);
    std::cout.flush();
    print_cost(plan);
  }
  if (line.has("print-config") || line.has("dry-run")) return cli::exit_success;
  line.require("output");
  return std::nullopt;
}

/// Rank 0's part of the sweep.
int lead(const parallel::Communicator& ranks, const cli::CommandLine& line, const sweep::Plan& plan,
         store::RunTable& table) {
  const bool computes = parallel::computes(ranks.size(), master_computes(line.get("master-computes")));
  const int computing_ranks = ranks.size() - (computes ? 0 : 1);
  std::cerr << plan.size() << " runs on " << computing_ranks
            << (computing_ranks == 1 ? " computing rank" : " computing ranks") << ", results go to "
            << line.get("output") << std::endl;
  SweepProgress progress(
      std::cerr, isatty(STDERR_FILENO) ? SweepProgress::Screen::terminal : SweepProgress::Screen::plain,
      plan.size(), computing_ranks);
  RowWriter writer(table);
  bool interrupted = false;
  parallel::SweepEvents events;
  events.started = [&](std::int64_t task, int) { progress.started(task); };
  events.ended = [&](const sweep::RunRow& row) {
    writer.add(row);
    progress.ended(row);
    interrupted = interrupted || row.status.view() == "interrupted";
  };
  events.idle = [&] {
    writer.tick();
    progress.tick();
  };
  events.stop_requested = [] { return cli::stop_signalled(); };
  const bool all_started = parallel::run_tasks(ranks, parallel::TaskOrder(plan.size(), plan.num_groups()),
                                               sweep::run_jobs(plan), events, computes);
  writer.finish();
  progress.finish();
  if (all_started && !interrupted) return cli::exit_success;
  std::cerr << program << ": stopped by a signal; finished rows and the distances so far are in "
            << line.get("output") << std::endl;
  return cli::exit_incomplete;
}

int sweep_on_all_ranks(const parallel::Communicator& ranks, int argc, char** argv) {
  // Rank 0 reads and checks; the others wait for its word: a config to run, or an exit code.
  cli::CommandLine line(program, usage, cli::CommandLine::SweepKeys::accepted);
  std::optional<store::RunTable> table;
  std::string word;
  if (ranks.rank() == 0) {
    const int exit_code = cli::run_program(program, [&] {
      parse(line, argc, argv);
      if (const auto over = prepare(line)) return *over;
      table = store::RunTable::create(line.get("output"), provenance(line, ranks.size()));
      return cli::exit_success;
    });
    if (table)
      word = "run\n" + line.settings().to_config(false);
    else
      word = "exit " + std::to_string(exit_code);
  }
  word = ranks.broadcast(word);
  if (word.starts_with("exit ")) return std::stoi(word.substr(5));

  cli::catch_stop_signals();
  if (ranks.rank() == 0) return lead(ranks, line, sweep::Plan(line.settings()), *table);
  const sweep::Plan plan(sweep::Settings::from_config(word.substr(4)));
  parallel::run_tasks(ranks, parallel::TaskOrder(0), sweep::run_jobs(plan), {}, false);
  return cli::exit_success;
}

}  // namespace

int main(int argc, char** argv) {
  const parallel::Communicator ranks(argc, argv);
  try {
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
