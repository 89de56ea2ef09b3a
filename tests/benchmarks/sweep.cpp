/// Measures the cost per vertex and step for runs of real sweeps, and the cost from release to verdict. For
/// comparison, the program measures a bare step on the same core. The bare step consists of the two passes
/// (kick and drift) of a step without contacts. No real step can be faster. The program alternates between
/// short parts of the run and bare steps.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "clog/core/droplet/time_step.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/run/resolve.hpp"
#include "core/polygon/step/dp_step_kernel.hpp"
#include "core/polygon/step/step_input.hpp"
#include "core/polygon/step/step_memory.hpp"

namespace {

using namespace clog;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The kick and the drift of a free circle at rest, with the terms of a run.
class BareStep {
 public:
  explicit BareStep(RunParameters run)
      : n_(*run.dp.vertices),
        terms_(terms_of(std::move(run))),
        kernel_(kernel::step_kernel(terms_)),
        memory_(n_),
        a_(memory_.arrays()) {
    for (int i = -1; i < n_ + kernel::edges_per_group; ++i) {
      const double angle = 2 * std::numbers::pi * i / n_;
      a_.position.x[i] = std::cos(angle) / 2;
      a_.position.y[i] = std::sin(angle) / 2;
    }
    sums_ = kernel_.measure(n_, a_);
  }

  /// @return duration of one step divided by the number of vertices [ns]
  double time(int steps) {
    constexpr double time_step = 1e-3;
    const kernel::KickCoefficients coefficients{.closing_ratio = 1,
                                                .h1 = time_step / 2,
                                                .h2 = time_step / 2,
                                                .weight = 2,
                                                .half_step = time_step / 2,
                                                .keeps_kicked = false};
    const double begin = cpu_seconds();
    for (int step = 0; step < steps; ++step) {
      const kernel::AreaForce force = area_force(sums_, {0, 0});
      const kernel::Coupling coupling = kernel_.kick(n_, terms_, {}, force, coefficients, a_);
      sums_ = kernel_.drift(n_, terms_, coefficients, coupling, time_step, a_);
    }
    return 1e9 * (cpu_seconds() - begin) / (static_cast<double>(steps) * n_);
  }

 private:
  static kernel::KickTerms terms_of(RunParameters run) {
    run.drag.near_wall = 0;  // there are no walls
    return kick_terms(run, 1 / relaxation_time(run));
  }
  int n_;
  kernel::KickTerms terms_;
  kernel::StepKernel kernel_;
  StepMemory memory_;
  kernel::StepArrays a_;
  kernel::Sums sums_{};
};

struct Task {
  const char* name;
  void (*change)(RunParameters&);
  double time;  ///< longest simulated time of each run [t0]
};

void make_elastic(RunParameters& run) {
  run.dp.perimeter_spring = PerimeterSpring::rest;
  run.dp.perimeter_stiffness_ratio = 0.1;
  run.dp.gravity = Gravity::vertex;
}

void flow(RunParameters& run, double line_tension, double gap) {
  run.dp.line_tension = line_tension;
  run.obstacles.gap = gap;
}

void saturate(RunParameters& run) { run.obstacles.density = ObstacleDensity(); }

constexpr Task tasks[] = {
    {"Gamma 0.05, gap 0.2, dense", [](RunParameters& r) { flow(r, 0.05, 0.2), saturate(r); }, 300},
    {"Gamma 0.1, gap 0.3, dense", [](RunParameters& r) { flow(r, 0.1, 0.3), saturate(r); }, 400},
    {"Gamma 0.2, gap 0.3, dense", [](RunParameters& r) { flow(r, 0.2, 0.3), saturate(r); }, 500},
    {"Gamma 0.05, gap 0.2, dilute", [](RunParameters& r) { flow(r, 0.05, 0.2); }, 300},
    {"Gamma 0.1, gap 0.3, dilute", [](RunParameters& r) { flow(r, 0.1, 0.3); }, 400},
    {"wrapped, 256 vertices, Gamma 0.2, gap 0.2, dense",
     [](RunParameters& r) { flow(r, 0.2, 0.2), saturate(r), r.dp.vertices = 256; }, 150},
    {"elastic, Gamma 0.05, gap 0.3, dense",
     [](RunParameters& r) { flow(r, 0.05, 0.3), saturate(r), make_elastic(r); }, 300},
    {"elastic, Gamma 0.1, gap 0.3, dilute, friction 0.2",
     [](RunParameters& r) { flow(r, 0.1, 0.3), make_elastic(r), r.dp.friction = 0.2; }, 200},
    {"the same without friction", [](RunParameters& r) { flow(r, 0.1, 0.3), make_elastic(r); }, 200},
    {"Gamma 0.1, gap 0.3, dilute, near-wall drag",
     [](RunParameters& r) { flow(r, 0.1, 0.3), r.drag.near_wall = 0.1; }, 200},
    {"Gamma 0.1, gap 0.3, dilute, hysteresis",
     [](RunParameters& r) {
       flow(r, 0.1, 0.3), r.dp.wall_tension = 0.5, r.dp.receding_angle = 100, r.dp.advancing_angle = 140;
     },
     20},
    {"stiff clog, Gamma 1, gap 0.2, dense", [](RunParameters& r) { flow(r, 1, 0.2), saturate(r); }, 1e4},
    {"soft disk, E_w 1, gap 0.2",
     [](RunParameters& r) { flow(r, 1, 0.2), r.model = Model::sp, r.dp = {}, r.wall_stiffness = 1; }, 1e4}};

RunParameters parameters(const Task& task, std::uint32_t seed) {
  RunParameters run;
  run.obstacles.box = 60;
  task.change(run);
  run.max_time = task.time;
  run.seed = seed;
  return resolve(run);
}

struct Measured {
  double per_vertex_step;  ///< Cost per vertex and step of the run [ns].
  double seconds;          ///< Duration of a run, including its array and its release.
  double limit;            ///< Cost per vertex of a bare step [ns].
};

/// Measures a few runs one after another.
Measured measure(const Task& task) {
  constexpr std::uint32_t num_runs = 3;
  constexpr int checks_per_slice = 400, bare_steps = 3000;
  double steps = 0, stepping = 0, whole = 0;
  int points = 1;
  std::vector<double> limits;
  for (std::uint32_t seed = 1; seed <= num_runs; ++seed) {
    const RunParameters run = parameters(task, seed);
    const bool is_polygon = run.model == Model::dp;
    double begin = cpu_seconds();
    DropletRun droplet(run);
    whole += cpu_seconds() - begin;
    if (is_polygon) points = *run.dp.vertices;
    for (bool over = false; !over;) {
      begin = cpu_seconds();
      over = droplet.advance(checks_per_slice);
      stepping += cpu_seconds() - begin;
      if (is_polygon) limits.push_back(BareStep(run).time(bare_steps));
    }
    steps += static_cast<double>(droplet.result().steps);
  }
  return {1e9 * stepping / (steps * points), (whole + stepping) / num_runs,
          limits.empty() ? 0 : median(limits)};
}

double median_of(const std::vector<Measured>& rounds, double Measured::*what) {
  std::vector<double> values;
  values.reserve(rounds.size());
  for (const Measured& round : rounds) values.push_back(round.*what);
  return median(values);
}

void print(const char* name, const std::vector<Measured>& rounds) {
  const double step = median_of(rounds, &Measured::per_vertex_step),
               limit = median_of(rounds, &Measured::limit);
  std::printf("%-50s %8.2f %8.3f", name, step, median_of(rounds, &Measured::seconds));
  if (limit > 0)
    std::printf(" %8.2f %8.2f\n", limit, step / limit);
  else
    std::printf(" %8s %8s\n", "", "");
}

}  // namespace

/// bench_sweep [ROUNDS [WORD]]: WORD selects the tasks whose names contain this word.
int main(int argc, char** argv) {
  const int num_rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 3;
  const std::string_view word = argc > 2 ? argv[2] : "";
  std::vector<const Task*> wanted;
  for (const Task& task : tasks)
    if (std::string_view(task.name).find(word) != std::string_view::npos) wanted.push_back(&task);
  std::vector<std::vector<Measured>> measured(wanted.size());
  for (int round = 0; round < num_rounds; ++round)
    for (std::size_t task = 0; task < wanted.size(); ++task) measured[task].push_back(measure(*wanted[task]));
  std::printf("%-50s %8s %8s %8s %8s\n", "medians of CPU time", "ns", "s a run", "limit", "ratio");
  for (std::size_t task = 0; task < wanted.size(); ++task) print(wanted[task]->name, measured[task]);
}
