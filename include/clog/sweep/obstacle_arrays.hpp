#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "clog/core/world/obstacle_array.hpp"

namespace clog::sweep {

/// The values of all parameters that shape a run's walls, as text. Runs with equal texts have the same walls.
std::string array_key(const RunParameters& run);

/// The walls of a sweep's runs, usually obstacle arrays. The last array is kept, because a sweep requests the
/// same array many times in a row. Large arrays are shared by all processes of the same user and executable
/// on a machine: one process builds the array while the others wait, and memory holds it only once. If
/// sharing fails, every process waits once until the longest_wait() is over, and then builds a separate
/// array.
class ObstacleArrays {
 public:
  /// @param run  resolved
  /// @throws Error as Scene::walls()
  std::shared_ptr<const ObstacleArray> get(const RunParameters& run);

  /// Number of arrays that this process has built.
  int num_built() const { return num_built_; }

  /// Longest time to wait until another process has built the array. It is at least 10 s, and at least ten
  /// times the usual time for building the array, because processors may be shared and memory may be slow.
  static std::chrono::duration<double> longest_wait(const ObstacleParameters& parameters);

 private:
  std::string key_;  ///< key of the array that is kept; empty if there is none
  std::shared_ptr<const ObstacleArray> array_;
  int num_built_ = 0;
  bool is_waiting_worthwhile_ = true;  ///< false after a wait that was in vain, until a shared array is found

  ObstacleArray build(const RunParameters& run);
  ObstacleArray find_or_build(const RunParameters& run);
};

}  // namespace clog::sweep
