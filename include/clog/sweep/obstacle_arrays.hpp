#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "clog/core/world/obstacle_array.hpp"

namespace clog::sweep {

/// The walls of two runs are the same if their keys are: the values of all parameters that shape them.
std::string array_key(const RunParameters& run);

/// The walls of a sweep's runs, obstacle arrays mostly. The last one is kept: a sweep asks for the same one
/// many times in a row. Large ones are shared by all processes of the same user and executable on a machine:
/// each is built by one of them, while the others wait, and is in memory once. Where sharing fails every
/// process waits in vain once, and builds its own; nothing else depends on it.
class ObstacleArrays {
 public:
  /// @param run  resolved
  /// @throws Error as Scene::walls()
  std::shared_ptr<const ObstacleArray> get(const RunParameters& run);

  /// How many of the arrays so far were built here.
  int num_built() const { return num_built_; }

  /// How long another process that builds the array is waited for: at least ten times as long as that takes,
  /// as the processors may be shared and the memory slow, and never less than 10 s.
  static std::chrono::duration<double> longest_wait(const ObstacleParameters& parameters);

 private:
  std::string key_;  ///< of the array that is kept; empty: there is none
  std::shared_ptr<const ObstacleArray> array_;
  int num_built_ = 0;
  bool is_waiting_worthwhile_ = true;  ///< until a wait was for nothing, and again once another's is found

  ObstacleArray build(const RunParameters& run);
  ObstacleArray find_or_build(const RunParameters& run);
};

}  // namespace clog::sweep
