/// Tests whether a finer polygon rests where a coarser one clogged.
///   build/release/tests/holds_finer sweep.h5 [PART PARTS]
/// Repeats each run that clogged. Puts a vertex into the middle of each edge of the droplet at rest, removes
/// the anchors by which walls hold the droplet, and lets the droplet move. Prints a line of CSV for each run,
/// with the droplet's distance after 600 t0, or its certified rest. A droplet may need its anchors to stay at
/// rest. To show this, the line also has the result without anchors for the unchanged number of vertices.
/// PART and PARTS divide the runs among processes.

#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>
#include <string>

#include "clog/core/model/model.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/results/stored_sweep.hpp"

namespace {

using namespace clog;

constexpr double time_given = 600;  // [t0]
constexpr int checks_at_once = 1000;

void finish(DropletRun& run) {
  while (!run.advance(checks_at_once)) {
  }
}

/// Inserts the middle of each edge between its ends. The middle is on the cubic through the ends of the edge
/// and their other neighbours.
Eigen::ArrayXd with_middles(const Eigen::Ref<const Eigen::ArrayXd>& coarse) {
  const Eigen::Index n = coarse.size();
  Eigen::ArrayXd fine(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index before = (i + n - 1) % n, next = (i + 1) % n, after = (i + 2) % n;
    fine[2 * i] = coarse[i];
    fine[2 * i + 1] = (9 * (coarse[i] + coarse[next]) - coarse[before] - coarse[after]) / 16;
  }
  return fine;
}

DropletState refined(const DropletState& coarse) {
  const Eigen::Index n = coarse.size();
  DropletState fine = coarse;
  fine.position.resize(4 * n);
  fine.position << with_middles(coarse.position.head(n)), with_middles(coarse.position.tail(n));
  fine.velocity = Eigen::ArrayXd::Zero(4 * n);
  fine.anchors.clear();
  return fine;
}

DropletState without_memory(DropletState state) {
  state.velocity.setZero();
  state.anchors.clear();
  return state;
}

/// The same run with another number of vertices. Stiffnesses and the time step become automatic again,
/// because they depend on this number.
RunParameters with_vertices(RunParameters run, int vertices) {
  run.dp.vertices = vertices;
  run.wall_stiffness.reset();
  run.dp.area_stiffness.reset();
  run.time_step.reset();
  run.max_time = time_given;
  return resolve(run);
}

double way(const RunResult& result) { return std::hypot(result.distance, result.lateral); }

void try_finer(const sweep::RunRow& row) {
  const RunParameters& run = row.parameters;
  DropletRun coarse(run);
  finish(coarse);
  const DropletState last = coarse.droplet().state();
  const std::optional<DropletState> rest = model_of(run).equilibrium(run, coarse.obstacles(), last);
  const auto obstacles = std::make_shared<const ObstacleArray>(coarse.obstacles());
  const int vertices = *run.dp.vertices;
  DropletRun fine(with_vertices(run, 2 * vertices), obstacles, refined(rest.value_or(last)));
  finish(fine);
  DropletRun same(with_vertices(run, vertices), obstacles, without_memory(rest.value_or(last)));
  finish(same);
  const RunResult result = fine.result();
  fmt::print("{},{},{:g},{:g},{:g},{},{:.4g},{:.4g},{},{:.4g},{:.4g}\n", row.task, vertices,
             run.dp.line_tension, run.dp.friction, row.distance,
             name(row.hold.mechanism.value_or(ClogMechanism::none)), row.hold.geometry.mesh_hold, way(result),
             name(result.status), result.time, way(same.result()));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2 && argc != 4) throw Error("give a sweep file");
  const std::int64_t part = argc == 4 ? std::atoi(argv[2]) : 0, parts = argc == 4 ? std::atoi(argv[3]) : 1;
  const store::SweepFile file = results::read_with_caution(argv[1]);
  fmt::print(
      "task,vertices,line_tension,friction,distance,mechanism,mesh_hold,moved,status,time,"
      "moved_without_more_vertices\n");
  for (const sweep::RunRow& row : file.rows)
    if (row.status == RunStatus::clogged && row.task % parts == part) {
      const sweep::RunRow same = results::replayable_row(file, std::to_string(row.task));
      results::use_instruction_set_of(same);
      try_finer(same);
    }
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  fmt::print(stderr, "holds_finer: {}\n", error.what());
  return 2;
}
