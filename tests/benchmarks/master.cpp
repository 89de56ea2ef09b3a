/// Measures how busy the master (rank 0) is with a thousand workers that have tasks of a second each. The
/// work of the master depends only on the messages. The master receives a thousand rows per second, and
/// answers each row with a new task. Here a few workers send the same number of rows, because their tasks are
/// shorter and only sleep. Everything else is as in clogsweep: the scheduler, MPI, and the table of runs on
/// the disk.
///   tests/mpirun.sh 5 bench_master [tasks per second] [seconds]
/// With 0 tasks per second every worker sleeps in one long task. This case measures the cost of waiting.
///   bench_master rows 1000000
/// Simulates a sweep of soft disks. Measures the memory per row, and the times to stop and to restart the
/// sweep. Also measures the longest time for which the master does not answer because it is busy with the
/// table and its journal.

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "../results/ended_row.hpp"
#include "../scheduler/order_of.hpp"
#include "clog/results/progress.hpp"
#include "clog/results/sweep_state.hpp"
#include "clog/scheduler/scheduler.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/run_row.hpp"

namespace {

using namespace clog;
using Clock = std::chrono::steady_clock;

double cpu_seconds() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// The largest resident memory so far.
double peak_kilobytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss);
}

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A job that sleeps instead of computing, in slices like those of a run.
class SleepingJob final : public sweep::Job {
 public:
  SleepingJob(const sweep::Plan& plan, std::int64_t task, double seconds)
      : seconds_(seconds), row_(sweep::describe(plan.task(task))) {
    row_.task = task;
    row_.status = RunStatus::clogged;
  }
  bool advance() override {
    const double left = seconds_ - seconds_since(begin_);
    if (left > 0) std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, 0.005)));
    return seconds_since(begin_) >= seconds_;
  }
  sweep::RunRow row() const override { return row_; }

 private:
  double seconds_;
  Clock::time_point begin_ = Clock::now();
  sweep::RunRow row_;
};

/// A sweep without workers, in which runs begin and end one after the other.
int measure_rows(std::int64_t num_rows) {
  const auto kilobytes = [num_rows, before = peak_kilobytes()] {
    return (peak_kilobytes() - before) / static_cast<double>(num_rows);
  };
  const std::string path =
      (std::filesystem::temp_directory_path() / ("bench_rows_" + std::to_string(getpid()) + ".h5")).string();
  sweep::Settings settings;
  settings.set("model", "sp");
  settings.set("wall-stiffness", "lin(0.5,3,100)");
  settings.set("seeds", "1.." + std::to_string(num_rows / 100));
  const sweep::Plan plan(settings);
  const auto open = [&] {
    return std::make_unique<results::SweepState>(path, plan, settings, store::Provenance(), plan.size(), 1);
  };
  auto state = open();
  double silence = 0;
  const Clock::time_point begin = Clock::now();
  for (std::int64_t task = 0; task < plan.size(); ++task) {
    const Clock::time_point last = Clock::now();
    state->start(task, 1);
    sweep::Report report{state->row(task), {}};
    results::end_run(report.row, RunStatus::flowing, 1);
    state->report(report);
    state->tick();
    silence = std::max(silence, seconds_since(last));
  }
  const double cost = seconds_since(begin) / static_cast<double>(num_rows);
  const double memory = kilobytes();
  const Clock::time_point stop = Clock::now();
  state->finish();
  const double stop_seconds = seconds_since(stop), memory_at_stop = kilobytes();
  state.reset();
  const Clock::time_point restart = Clock::now();
  state = open();
  if (state->num_faulty() > 0) return 1;
  std::printf(
      "%lld rows: %.0f us each, silent for %.3f s, stop %.2f s, restart %.2f s; memory of a row: %.2f kB, "
      "%.2f kB to the stop, %.2f kB with the restart; %.1f s of CPU in all\n",
      static_cast<long long>(num_rows), 1e6 * cost, silence, stop_seconds, seconds_since(restart), memory,
      memory_at_stop, kilobytes(), cpu_seconds());
  state->finish();
  std::filesystem::remove(path);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && argv[1] == std::string("rows")) return measure_rows(std::atoll(argv[2]));
  const scheduler::Communicator ranks(argc, argv);
  const double rate = argc > 1 ? std::atof(argv[1]) : 1000;
  const double duration = argc > 2 ? std::atof(argv[2]) : 10;
  const int num_workers = ranks.size() - 1;
  if (num_workers < 1) {
    std::fprintf(stderr, "bench_master: give two ranks or more\n");
    return 2;
  }
  const std::int64_t num_tasks =
      rate > 0 ? static_cast<std::int64_t>(rate * duration) : static_cast<std::int64_t>(num_workers);
  const double task_seconds = rate > 0 ? num_workers / rate : duration;

  const std::string path =
      (std::filesystem::temp_directory_path() / ("bench_master_" + std::to_string(getpid()) + ".h5"))
          .string();
  sweep::Settings settings;  // like a large sweep: as many tasks as requested, in a hundred parameter sets
  const std::int64_t num_groups = std::min<std::int64_t>(num_tasks, 100);
  settings.set("line-tension", "lin(0.1,10," + std::to_string(num_groups) + ")");
  settings.set("seeds", "1.." + std::to_string(num_tasks / num_groups));
  const sweep::Plan plan(settings);
  std::optional<results::SweepState> state;
  std::ostringstream screen;  // progress is computed but not printed
  results::Progress progress(screen, results::Progress::Screen::terminal, num_workers,
                             [num_groups](std::int64_t task) { return task % num_groups; });
  std::vector<std::int64_t> tasks(num_tasks);
  std::iota(tasks.begin(), tasks.end(), std::int64_t{0});
  progress.expect(tasks, num_tasks);
  scheduler::SweepEvents events;
  if (ranks.rank() == 0) {
    state.emplace(path, plan, settings, store::Provenance(), plan.size(), 1);
    events.started = [&](std::int64_t task, int rank) {
      progress.started(task);
      return state->start(task, rank);
    };
    events.progressed = [&](const scheduler::Report& report) { state->report(report); };
    events.ended = [&](const scheduler::Report& report) {
      state->report(report);
      progress.ended(report.row);
    };
    events.idle = [&] {
      state->tick();
      progress.tick();
      screen.str("");
    };
  }
  const Clock::time_point begin = Clock::now();
  const double cpu_before = cpu_seconds();
  scheduler::Schedule schedule(scheduler::order_of(plan.size(), plan.num_groups()),
                               ranks.gather(ranks.host_name()), false);
  scheduler::run_tasks(
      ranks, schedule,
      [&](std::int64_t task, std::span<const std::byte>) {
        return std::make_unique<SleepingJob>(plan, task, task_seconds);
      },
      events);
  if (ranks.rank() != 0) return 0;
  state->finish();
  const double cpu = cpu_seconds() - cpu_before;
  const double wall = seconds_since(begin);
  if (rate > 0)
    std::printf("master: %.0f tasks/s, %.1f us of CPU per task, busy %.1f %% of a core\n",
                static_cast<double>(num_tasks) / wall, 1e6 * cpu / static_cast<double>(num_tasks),
                100 * cpu / wall);
  else
    std::printf("waiting master: busy %.2f %% of a core\n", 100 * cpu / wall);
  std::filesystem::remove(path);
}
