/// How busy is a master with a thousand workers whose tasks take a second? What it has to do depends on the
/// messages alone: a thousand rows a second, each answered with a task. Here a few workers send as many, with
/// tasks that sleep; everything else is clogsweep's own: the scheduler, MPI, the table of runs on the disk.
///   tests/mpirun.sh 5 bench_master [tasks per second] [seconds]
/// With 0 tasks per second every worker sleeps in one long task: what does waiting cost?

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

#include "clog/parallel/scheduler.hpp"
#include "clog/store/run_table.hpp"
#include "row_writer.hpp"
#include "sweep_progress.hpp"

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

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Sleeps, in slices as a run computes in slices.
class SleepingJob final : public sweep::Job {
 public:
  SleepingJob(std::int64_t task, double seconds) : seconds_(seconds) {
    row_.task = task;
    row_.status = "clogged";
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

}  // namespace

int main(int argc, char** argv) {
  const parallel::Communicator ranks(argc, argv);
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
  std::optional<store::RunTable> table;
  std::optional<RowWriter> writer;
  std::ostringstream screen;  // progress goes nowhere, but is made
  SweepProgress progress(screen, SweepProgress::Screen::terminal, num_tasks, num_workers);
  parallel::SweepEvents events;
  if (ranks.rank() == 0) {
    table = store::RunTable::create(path, {});
    writer.emplace(*table);
    events.started = [&](std::int64_t task, int) { progress.started(task); };
    events.ended = [&](const sweep::RunRow& row) {
      writer->add(row);
      progress.ended(row);
    };
    events.idle = [&] {
      writer->tick();
      progress.tick();
      screen.str("");
    };
  }
  const Clock::time_point begin = Clock::now();
  const double cpu_before = cpu_seconds();
  // A hundred parameter sets, as a large sweep has.
  parallel::run_tasks(
      ranks, parallel::TaskOrder(num_tasks, std::min<std::int64_t>(num_tasks, 100)),
      [&](std::int64_t task) { return std::make_unique<SleepingJob>(task, task_seconds); }, events, false);
  if (ranks.rank() != 0) return 0;
  writer->finish();
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
