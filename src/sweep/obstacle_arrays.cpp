#include "clog/sweep/obstacle_arrays.hpp"

#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "clog/core/model/model.hpp"
#include "clog/core/parameters/schema.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/sweep/columns.hpp"
#include "shared_memory.hpp"

namespace clog::sweep {
namespace {

/// Smaller arrays are not shared, because building such an array is faster than asking other processes for
/// it.
constexpr double fewest_shared = 1e5;
constexpr std::chrono::milliseconds pause{5};
constexpr std::chrono::milliseconds pause_between_looks{500};

/// Upper bound of the number of obstacles. It follows from the largest fraction of an area that discs can
/// cover.
double num_places(const ObstacleParameters& parameters) {
  const double per_side = parameters.box / (parameters.smallest_diameter() + parameters.gap);
  return parameters.boxes * per_side * per_side;
}

/// Name under which processes of this executable share the array. Other programs use other names, because
/// they may build or arrange arrays differently.
std::optional<std::string> shared_name(const RunParameters& run) {
  struct stat executable;
  if (stat("/proc/self/exe", &executable) != 0) return std::nullopt;
  return fmt::format("clogsweep-{:x}-{:x}-{:x}-{}", executable.st_ino, executable.st_mtim.tv_sec,
                     executable.st_mtim.tv_nsec, array_key(run));
}

/// The header of a shared array. The obstacles and the starts of the cells follow the header.
struct Header {
  Period period;
  double largest_radius;
  std::uint64_t num_obstacles;
};

std::shared_ptr<const SharedMemory> publish(const std::string& name, const ObstacleArray& array) {
  const BinnedObstacles& binned = array.binned();
  const Header header{binned.period, binned.largest_radius, binned.obstacles.size()};
  return SharedMemory::publish(
      name, std::array{std::as_bytes(std::span(&header, 1)), std::as_bytes(binned.obstacles),
                       std::as_bytes(binned.cell_start)});
}

ObstacleArray array_over(std::shared_ptr<const SharedMemory> memory) {
  Header header;
  std::memcpy(&header, memory->bytes().data(), sizeof header);
  const auto* obstacles = reinterpret_cast<const Obstacle*>(memory->bytes().data() + sizeof header);
  const auto* cell_start = reinterpret_cast<const std::uint32_t*>(obstacles + header.num_obstacles);
  return ObstacleArray({header.period,
                        header.largest_radius,
                        {obstacles, header.num_obstacles},
                        {cell_start, ObstacleArray::num_cells(header.period) + 1}},
                       std::move(memory));
}

}  // namespace

std::string array_key(const RunParameters& run) {
  std::string key;
  for (const Parameter& parameter : parameter_schema())
    if (parameter.shapes_array) key += text_of(parameter.get(run)) + ',';
  return key;
}

ObstacleArray ObstacleArrays::build(const RunParameters& run) {
  ++num_built_;
  return scene_of(run).walls(run);
}

std::chrono::duration<double> ObstacleArrays::longest_wait(const ObstacleParameters& parameters) {
  // Building takes 0.5 to 1 microseconds for each pair of possible places of obstacles that are within reach
  // of each other.
  constexpr double ten_builds = 10 * 1e-6;
  const double reach =
      (parameters.largest_diameter() + parameters.gap) / (parameters.smallest_diameter() + parameters.gap);
  return std::chrono::duration<double>(std::max(10.0, ten_builds * num_places(parameters) * reach * reach));
}

ObstacleArray ObstacleArrays::find_or_build(const RunParameters& run) {
  const bool is_sampled = scene_of(run).walls_from == WallsFrom::parameters;
  const std::optional<std::string> name = shared_name(run);
  if (!name || !is_sampled || num_places(run.obstacles) < fewest_shared) return build(run);
  const auto begin = std::chrono::steady_clock::now();
  const auto end = begin + longest_wait(run.obstacles);
  auto next_look = begin;
  bool has_waited = false;
  do {
    const NameLock lock(*name);
    if (lock.state() == NameLock::State::impossible) return build(run);
    if (lock.state() == NameLock::State::held) {
      // The lock prevents other processes from building the array. Processes that wait for the lock do not
      // search for the array, because searching would slow the builder down.
      if (auto memory = SharedMemory::find(*name)) {
        is_waiting_worthwhile_ = true;
        return array_over(std::move(memory));
      }
      // The builder has been killed, or its array is not visible, for example because it runs in another
      // container.
      if (has_waited) is_waiting_worthwhile_ = false;
      ObstacleArray array = build(run);
      auto memory = publish(*name, array);
      return memory ? array_over(std::move(memory)) : array;
    }
    if (!is_waiting_worthwhile_) return build(run);
    if (const auto now = std::chrono::steady_clock::now(); now >= next_look) {
      if (lock.is_taken_by_another_user()) return build(run);
      next_look = now + pause_between_looks;
    }
    std::this_thread::sleep_for(pause);
    has_waited = true;
  } while (std::chrono::steady_clock::now() < end);
  // A builder that takes longer than longest_wait() probably hangs. This process then builds the array
  // itself.
  is_waiting_worthwhile_ = false;
  return build(run);
}

std::shared_ptr<const ObstacleArray> ObstacleArrays::get(const RunParameters& run) {
  const Scene& scene = scene_of(run);
  if (scene.walls_from == WallsFrom::droplet) return std::make_shared<ObstacleArray>(scene.walls(run));
  // In a device with side walls, the droplet's reach limits the places where the droplet may start. The array
  // is shifted according to this start, so the reach is a part of the key.
  std::string key = array_key(run);
  if (scene.walls_from == WallsFrom::circles) key += shortest(model_of(run).reach(run));
  if (key != key_) {
    array_.reset();  // frees memory for the next array
    key_.clear();
    array_ = std::make_shared<ObstacleArray>(find_or_build(run));
    key_ = key;
  }
  return array_;
}

}  // namespace clog::sweep
