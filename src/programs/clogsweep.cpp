/// clogsweep: distributes many independent runs to MPI ranks and collects them in one table.

#include <fmt/core.h>

#include <cstddef>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/json_text.hpp"
#include "clog/console/signals.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/instruction_set.hpp"
#include "clog/core/tools/memory.hpp"
#include "clog/diagnostics/examination.hpp"
#include "clog/diagnostics/limits.hpp"
#include "clog/results/preview.hpp"
#include "clog/results/sweep_state.hpp"
#include "clog/scheduler/assignment.hpp"
#include "clog/scheduler/communicator.hpp"
#include "clog/scheduler/driver.hpp"
#include "clog/scheduler/isolated_jobs.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_job.hpp"
#include "clog/sweep/schema_json.hpp"
#include "clogsweep_commands.hpp"
#include "clogsweep_options.hpp"
#include "laboratory_option.hpp"

namespace {

using namespace clog;
using namespace clog::programs;

constexpr std::size_t memory_of_mpi = 400'000'000;  // Open MPI 4.1 may crash with 200 MB
constexpr const char* clogsweep_usage =
    R"(clogsweep runs droplets through obstacle arrays for every combination of the
given values, on all MPI ranks, and gathers the results in one HDF5 table.

  mpirun -np 4 clogsweep --config sweep.cfg --output sweep.h5 line-tension=0.2,1,5
  clogsweep --config sweep.cfg --dry-run
  clogsweep status sweep.h5         prints lambda, <v_g> and the time left, also while the sweep runs
  clogsweep verify sweep.h5         checks the file for damage
  clogsweep salvage sweep.h5 --output whole.h5     copies the undamaged rows of a damaged file
  clogsweep replay sweep.h5 TASK    repeats a run and compares the bits of its result
  clogsweep merge a.h5 b.h5 --output c.h5          makes one file of several
  clogsweep select sweep.h5 'line_tension>1' --output stiff.h5     copies some rows of a file
  mpirun -np 4 clogsweep doctor     looks for problems of a sweep that is started in this way

The same command resumes a stopped or killed sweep.
)";

/// @param growing  nullopt unless the sweep adds runs automatically
store::Provenance provenance(const cli::CommandLine& line,
                             const std::optional<results::GrowingSweep>& growing, int num_ranks) {
  store::Provenance all = cli::origin(line);
  all.emplace_back("mpi_version", scheduler::Communicator::library_version());
  all.emplace_back("hdf5_version", store::library_version());
  all.emplace_back("num_ranks", std::to_string(num_ranks));
  if (!growing) return all;
  for (auto& [name, text] : all)
    if (name == "config") text = growing->settings.to_config();
  all.emplace_back("stopping_rule", growing->rule.text());
  all.emplace_back("num_wanted", std::to_string(growing->num_first));
  return all;
}

/// @throws Refusal; with the format JSON, first prints the refusal as JSON
sweep::Plan planned(const sweep::Settings& settings, results::PreviewFormat format) try {
  return sweep::Plan(settings);
} catch (const Refusal& refusal) {
  if (format == results::PreviewFormat::json) results::print_refusal(refusal);
  throw;
}

/// Rank 0's work before the sweep: it finds all errors of the user before any rank computes. Returns the exit
/// code if there is nothing to run, otherwise the plan.
std::variant<int, sweep::Plan> prepare(const cli::CommandLine& line, scheduler::IsolatedJobs& isolated) {
  if (line.has("schema")) {
    std::cout << console::json_text(sweep::schema_json());
    return console::exit_success;
  }
  driver_options(line);
  attempts(line);
  assignment(line, line.settings());
  const results::PreviewFormat format = preview_format(line);
  const std::optional<results::GrowingSweep> growing = growing_sweep(line);
  sweep::Plan plan = planned(line.settings(), format);
  if (line.has("print-config")) results::print_config(line.settings(), plan);
  if (line.has("dry-run")) {
    results::print_tasks(plan, format);
    console::flush_output();
    if (console::stop_signalled()) return console::exit_incomplete;
    // These jobs run in the process that was forked before MPI started.
    const sweep::JobFactory jobs =
        isolated.jobs(assignment(line, line.settings()).text(), sweep::run_jobs(plan));
    return results::print_cost(plan, driver_options(line).output, growing ? &growing->rule : nullptr, jobs,
                               format);
  }
  if (line.has("print-config")) return console::exit_success;
  line.require("output");
  return plan;
}

/// Rank 0's state of a sweep.
struct MasterState {
  std::optional<results::GrowingSweep> growing;
  sweep::Plan plan;
  results::SweepState state;

  /// @param first  the plan of the command line, which may grow
  MasterState(const cli::CommandLine& line, sweep::Plan first, int num_ranks)
      : growing(growing_sweep(line)),
        plan(growing ? sweep::Plan(growing->settings) : std::move(first)),
        state(line.get("output"), plan, settings(line), provenance(line, growing, num_ranks),
              growing ? growing->num_first : plan.size(), attempts(line)) {}

  const sweep::Settings& settings(const cli::CommandLine& line) const {
    return growing ? growing->settings : line.settings();
  }
};

/// Exit code of prepare() if the sweep starts.
constexpr int sweep_starts = -1;

int sweep_on_all_ranks(const scheduler::Communicator& ranks, scheduler::IsolatedJobs& isolated, int argc,
                       char** argv) {
  // Rank 0 reads and checks the command line; the other ranks wait for an exit code or an assignment from
  // rank 0.
  cli::CommandLine line("clogsweep", clogsweep_usage, cli::CommandLine::SweepKeys::accepted);
  std::optional<MasterState> master;
  std::string task;  // the text of an assignment, see scheduler::Assignment::text()
  int exit_code = sweep_starts;
  if (ranks.rank() == 0) {
    exit_code = cli::run_program("clogsweep", [&] {
      if (!parse_sweep_options(line, argc, argv)) return console::exit_success;
      std::variant<int, sweep::Plan> prepared =
          with_typed_units(line, [&] { return prepare(line, isolated); });
      if (const int* const over = std::get_if<int>(&prepared)) return *over;
      diagnostics::refuse_to_be_alone(ranks.size());
      master.emplace(line, std::get<sweep::Plan>(std::move(prepared)), ranks.size());
      task = assignment(line, master->settings(line)).text();
      return console::exit_success;
    });
    if (master && exit_code == console::exit_success) exit_code = sweep_starts;
  }
  exit_code = ranks.broadcast(exit_code);
  if (exit_code != sweep_starts) return exit_code;
  task = ranks.broadcast(task);

  const auto assigned = scheduler::Assignment::from(task);
  use_instruction_set(assigned.instruction_set);
  sweep::JobFactory make_job = master ? sweep::run_jobs(master->plan) : scheduler::assigned_jobs(task);
  if (assigned.is_isolated) make_job = isolated.jobs(task, std::move(make_job));
  if (master)
    return scheduler::drive_sweep(ranks, driver_options(line), master->plan, make_job, master->state,
                                  master->growing ? &master->growing->rule : nullptr);
  scheduler::follow_sweep(ranks, make_job, assigned.report_interval);
  return console::exit_success;
}

/// The output that the user named, which the sweep may resume; empty if no output is given. This function
/// searches the command line before it is checked.
std::string named_output(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--output" && i + 1 < argc) return argv[i + 1];
    for (const std::string_view form : {"--output=", "output="})
      if (word.starts_with(form)) return std::string(word.substr(form.size()));
  }
  return "";
}

}  // namespace

int main(int argc, char** argv) {
  console::prepare_streams();
  if (const auto exit_code = cli::run_command("clogsweep", file_commands, argc, argv)) return *exit_code;
  console::catch_stop_signals();  // a signal before the sweep stops the program here
  std::optional<scheduler::IsolatedJobs> isolated;
  const int exit_code = cli::run_program("clogsweep", [&] {
    require_memory("start MPI", memory_of_mpi);
    diagnostics::require_open_files();
    // This must happen before MPI starts.
    isolated.emplace(scheduler::assigned_jobs);
    if (scheduler::Communicator::may_be_rank_0()) store::try_before_mpi(named_output(argc, argv));
    return console::exit_success;
  });
  if (exit_code != console::exit_success) return exit_code;
  const scheduler::Communicator ranks(argc, argv);
  try {
    if (argc > 1 && std::string_view(argv[1]) == "doctor") return clogsweep_doctor(ranks, argc, argv);
    return sweep_on_all_ranks(ranks, *isolated, argc, argv);
  } catch (const std::exception& error) {
    // Once the sweep runs, ranks wait for each other. So an error on one rank must end all ranks.
    console::say(fmt::format("clogsweep: rank {} on {}: {}", ranks.rank(),
                             scheduler::Communicator::host_name(), error.what()));
    const int code =
        dynamic_cast<const Error*>(&error) ? console::exit_user_fault : console::exit_internal_fault;
    if (ranks.size() > 1) ranks.abort(code);
    return code;
  }
}
