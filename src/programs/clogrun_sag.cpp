#include <fmt/ostream.h>

#include <functional>
#include <iostream>
#include <string>

#include "clog/cli/program.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/signals.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/plan.hpp"
#include "clogrun_commands.hpp"

namespace clog::programs {
namespace {

int preview(const cli::CommandLine& line, const sweep::Plan& plan, single_run::RecordedRun::Intervals often) {
  single_run::MostCost cost;
  for (std::int64_t task = 0; task < plan.size(); ++task)
    cost += single_run::RecordedRun(DropletRun(plan.task(task)), often).measure_cost();
  return single_run::print_preview(line.settings().to_config(), cost);
}

/// Finds out whether a droplet rests on the wall although its run does not end. With friction the wall holds
/// the droplet at any place, and round-off decides whether this neutral balance counts as unstable. Droplets
/// in an unstable balance have not clogged, so the run would go on until max-time.
class RestOnWall {
 public:
  bool operator()(const DropletRun& run) {
    constexpr double long_rest = 300;  // [t0]; a droplet that comes to rest needs 20 to 400
    if (!(run.kinetic_energy_ratio() < run.parameters().clog_energy)) rests_since_ = run.time();
    has_rested_ = run.time() - rests_since_ >= long_rest;
    return has_rested_;
  }
  bool has_rested() const { return has_rested_; }

 private:
  double rests_since_ = 0;
  bool has_rested_ = false;
};

}  // namespace

int clogrun_sag(cli::CommandLine& line) {
  refuse_options(line, "sag", {"write-obstacles", "frames", "most-frames"});
  const sweep::Plan plan(line.settings());
  if (line.has("output")) sweep::single_run(line.settings());
  const auto often = intervals(line, *plan.task(0).time_step);
  if (line.has("output")) store::refuse_unwritable(line.get("output"));
  if (line.has("dry-run")) return preview(line, plan, often);

  warn_of_untested_parameters(plan);
  console::catch_stop_signals();
  std::cout << "model,line_tension,wall_stiffness,sag,top_sag,shape_parameter,time,status\n";
  bool all_at_rest = true;
  for (std::int64_t task = 0; task < plan.size(); ++task) {
    const RunParameters parameters = plan.task(task);
    single_run::RecordedRun watched(DropletRun(parameters), often);
    RestOnWall rest;
    watched.follow(std::ref(rest));
    const RunResult result = watched.result();
    const bool is_at_rest = result.status == RunStatus::clogged || rest.has_rested();
    const bool is_polygon = parameters.model == Model::dp;
    fmt::print(std::cout, "{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{}\n", name(parameters.model),
               is_polygon ? parameters.dp.line_tension : sweep::RunRow::not_known, *parameters.wall_stiffness,
               result.sag.centre, result.sag.top, result.shape_parameter, result.time,
               is_at_rest ? "at_rest" : name(result.status));
    console::flush_output();
    if (result.status == RunStatus::failed) throw Error(result.message);
    if (line.has("output"))
      store::write_trajectory(line.get("output"),
                              watched.trajectory(sweep::describe(parameters), cli::origin(line)));
    if (result.status == RunStatus::interrupted && !is_at_rest) return console::exit_incomplete;
    all_at_rest &= is_at_rest;
  }
  if (all_at_rest) return console::exit_success;
  console::say("clogrun: not every droplet has come to rest; give a longer max-time");
  return console::exit_incomplete;
}

}  // namespace clog::programs
