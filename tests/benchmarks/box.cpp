/// Measures whether a step costs more in a larger box. The same droplet follows the same path through two
/// arrays. The first array has the period 60. The second array has the period 540, and consists of 81 copies
/// of the first array. The program alternates between short parts of the two runs.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <memory>
#include <vector>

#include "clog/core/run/droplet_run.hpp"
#include "clog/core/run/resolve.hpp"

namespace {

using namespace clog;

constexpr double small_box = 60;
constexpr int copies = 9;  // an odd number, so that the centres of both boxes have the same surroundings

std::shared_ptr<const ObstacleArray> tiled(const ObstacleArray& array) {
  std::vector<Obstacle> all;
  for (int row = 0; row < copies; ++row)
    for (int column = 0; column < copies; ++column)
      for (const Obstacle& obstacle : array.obstacles())
        all.push_back({obstacle.x + small_box * column, obstacle.y + small_box * row, obstacle.radius});
  return std::make_shared<ObstacleArray>(small_box * copies, std::move(all));
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double timed_advance(DropletRun& run, int num_checks) {
  const double begin = cpu_seconds();
  run.advance(num_checks);
  return cpu_seconds() - begin;
}

void compare(const char* name, RunParameters parameters, int num_checks) {
  parameters.obstacles.gap = 0.4;
  parameters.obstacles.box = small_box;
  parameters.max_time = 1e9;
  parameters.clog_energy = 1e-300;
  parameters = resolve(parameters);
  const auto array = std::make_shared<ObstacleArray>(sample_obstacles(parameters.obstacles, 1));
  // The time of a run depends by some percent on the addresses of its arrays in memory, so there are several
  // runs of each kind.
  constexpr int num_twins = 6;
  RunParameters in_large = parameters;
  in_large.obstacles.box = small_box * copies;
  const auto large_array = tiled(*array);
  std::vector<DropletRun> small, large;
  for (int twin = 0; twin < num_twins; ++twin) {
    small.emplace_back(parameters, array);
    large.emplace_back(in_large, large_array);
  }
  constexpr int num_slices = 7;
  std::vector<double> ratios, twin_ratios;
  for (int slice = 0; slice < num_slices; ++slice) {
    std::vector<double> small_times, large_times;
    for (int twin = 0; twin < num_twins; ++twin) {
      small_times.push_back(timed_advance(small[twin], num_checks));
      large_times.push_back(timed_advance(large[twin], num_checks));
    }
    ratios.push_back(median(large_times) / median(small_times));
    twin_ratios.push_back(*std::max_element(small_times.begin(), small_times.end()) / median(small_times));
  }
  std::printf(
      "%s: a step in a box of %.0f costs %.3f of one in a box of %.0f (after %.2f and %.2f sigma; slowest of "
      "%d "
      "twins %.3f)\n",
      name, small_box * copies, median(ratios), small_box, large[0].displacement()[0],
      small[0].displacement()[0], num_twins, median(twin_ratios));
}

}  // namespace

int main() {
  RunParameters polygon;
  polygon.dp.line_tension = 0.2;
  polygon.dp.vertices = 128;
  compare("polygon", polygon, 500);
  RunParameters disk;
  disk.model = Model::sp;
  disk.wall_stiffness = 0.5;
  compare("soft disk", disk, 40000);
}
