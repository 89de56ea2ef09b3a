#include "sweep_preview.hpp"

#include <chrono>
#include <cstdio>
#include <iostream>
#include <set>
#include <string>

#include "clog/cli/program.hpp"
#include "clog/core/error.hpp"
#include "clog/core/systems.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog {
namespace {

using Clock = std::chrono::steady_clock;

std::string number(double value) { return sweep::shortest(value); }

void print_task(const sweep::Plan& plan, std::int64_t task) {
  const sweep::RunRow row = sweep::describe(plan.task(task));
  std::cout << task << ' ' << row.model.view() << ' ' << number(row.line_tension) << ' '
            << number(row.wall_stiffness) << ' ' << number(row.obstacle_gap) << ' '
            << number(row.obstacle_diameter) << ' '
            << (row.obstacle_filling.view() == "saturated" ? "saturated" : number(row.obstacle_density))
            << ' ' << number(row.near_wall_drag) << ' ' << number(row.terminal_speed) << ' ' << row.vertices
            << ' ' << number(row.time_step) << ' ' << number(row.max_time) << ' ' << row.seed << '\n';
}

}  // namespace

void print_tasks(const sweep::Plan& plan) {
  constexpr std::int64_t most_lines = 1000;
  constexpr std::int64_t lines_at_an_end = 20;
  const std::int64_t num_skipped = plan.size() > most_lines ? plan.size() - 2 * lines_at_an_end : 0;
  std::cout << "# task model line_tension wall_stiffness obstacle_gap obstacle_diameter obstacle_density "
               "near_wall_drag "
               "terminal_speed vertices time_step max_time seed\n";
  for (std::int64_t task = 0; task < plan.size() && !cli::stop_signalled(); ++task) {
    if (num_skipped > 0 && task == lines_at_an_end) {
      std::cout << "# ... " << num_skipped << " more ...\n";
      task += num_skipped;
    }
    print_task(plan, task);
  }
  if (cli::stop_signalled()) return;
  const std::int64_t seeds = plan.size() / plan.num_groups();
  std::cout << "# " << plan.size() << " tasks: " << plan.num_groups()
            << (plan.num_groups() == 1 ? " parameter set" : " parameter sets") << ", " << seeds
            << (seeds == 1 ? " seed" : " seeds") << " each\n";
}

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

void print_config(const sweep::Settings& settings, const sweep::Plan& plan) {
  const sweep::RunRow first = sweep::describe(plan.task(0));
  std::cout << settings.to_config(true);
  std::cout << "\n# Values behind `auto` in the first task:\n# wall-stiffness = "
            << number(first.wall_stiffness) << "\n# time-step = " << number(first.time_step) << '\n';
  if (first.model.view() == "dp")
    std::cout << "# area-stiffness = " << number(first.area_stiffness)
              << "\n# perimeter-stiffness = " << number(first.perimeter_stiffness) << '\n';
}

}  // namespace clog
