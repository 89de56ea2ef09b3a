/// Measures how the order of the tasks affects the end of a sweep. The lengths of the runs come from a real
/// sweep. 64 simulated workers take tasks from the scheduler's own TaskOrder, as real workers do.
///   bench_tail run-lengths-dp.csv [workers] [seeds]

#include <algorithm>
#include <boost/random/uniform_int_distribution.hpp>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <queue>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "../scheduler/order_of.hpp"

namespace {

using clog::scheduler::order_of, clog::scheduler::TaskOrder;

constexpr int num_groups = 20;  // number of parameter sets in each of the two tables

/// Lengths of the tasks, by task.
std::vector<double> read_lengths(const char* path) {
  std::ifstream file(path);
  std::string line;
  std::vector<double> lengths;
  std::getline(file, line);
  while (std::getline(file, line))
    lengths.push_back(std::strtod(line.substr(line.find(',') + 1).c_str(), nullptr));
  return lengths;
}

/// The time at which the last task is done.
double finish_time(const std::vector<double>& lengths, int num_workers, TaskOrder tasks) {
  using Running = std::pair<double, std::int64_t>;  // end, task
  std::priority_queue<Running, std::vector<Running>, std::greater<>> running;
  double now = 0;
  const auto start = [&] {
    const std::int64_t task = tasks.take(now);
    running.emplace(now + lengths[task], task);
  };
  for (int worker = 0; worker < num_workers && !tasks.empty(); ++worker) start();
  while (!running.empty()) {
    const auto [end, task] = running.top();
    running.pop();
    now = end;
    tasks.ended(task, now);
    if (!tasks.empty()) start();
  }
  return now;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// The lengths of the tasks of a random sweep. For each task, one of the recorded lengths of its group is
/// drawn.
std::vector<double> resample(const std::vector<double>& recorded, std::int64_t num_seeds,
                             std::mt19937_64& engine) {
  const boost::random::uniform_int_distribution<std::int64_t> pick(
      0, static_cast<std::int64_t>(recorded.size()) / num_groups - 1);
  std::vector<double> lengths(num_seeds * num_groups);
  for (std::int64_t task = 0; task < static_cast<std::int64_t>(lengths.size()); ++task)
    lengths[task] = recorded[task % num_groups + num_groups * pick(engine)];
  return lengths;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<double> recorded = argc > 1 ? read_lengths(argv[1]) : std::vector<double>();
  const int num_workers = argc > 2 ? std::atoi(argv[2]) : 64;
  const std::int64_t num_seeds = argc > 3 ? std::atoi(argv[3]) : 50;
  if (recorded.empty() || recorded.size() % num_groups != 0 || num_workers < 1 || num_seeds < 1) {
    std::fprintf(stderr, "bench_tail: give a table of %d groups of runs, workers, seeds\n", num_groups);
    return 2;
  }
  std::mt19937_64 engine(1);
  std::vector<double> planned, expected, known;
  for (int sample = 0; sample < 101; ++sample) {
    std::vector<double> lengths = resample(recorded, num_seeds, engine);
    const auto num_tasks = static_cast<std::int64_t>(lengths.size());
    // No order of the tasks can take less time. This bound is seldom reached, because some workers are
    // usually idle at the end.
    const double least = std::max(std::accumulate(lengths.begin(), lengths.end(), 0.0) / num_workers,
                                  *std::max_element(lengths.begin(), lengths.end()));
    planned.push_back(finish_time(lengths, num_workers, order_of(num_tasks)) / least);
    expected.push_back(finish_time(lengths, num_workers, order_of(num_tasks, num_groups)) / least);
    std::sort(lengths.rbegin(), lengths.rend());
    known.push_back(finish_time(lengths, num_workers, order_of(num_tasks)) / least);
  }
  std::printf(
      "%lld runs, %d workers, time to the end over the least possible: as planned %.3f, "
      "longest expected first %.3f, lengths known beforehand %.3f\n",
      static_cast<long long>(num_seeds) * num_groups, num_workers, median(planned), median(expected),
      median(known));
}
