#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clog/core/parameters/parameters.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::sweep {

/// The product of a sweep's lists: a description, from which any task can be had in any order.
/// Seeds vary slowest, so that every curve fills evenly and neighbouring tasks share their obstacle array.
class Plan {
 public:
  /// Checks every parameter set of the sweep.
  /// @throws Error if one of them is impossible, or if the lists would repeat a run
  explicit Plan(const Settings& settings);

  std::int64_t size() const { return size_; }
  /// Resolved parameters of task `index`, 0 <= index < size().
  RunParameters task(std::int64_t index) const;
  /// Circles that its tasks are among.
  const CircleFiles& circle_files() const { return circle_files_; }
  /// Lists that were typed like a decimal with a comma, 0,5, one line each.
  const std::vector<std::string>& possible_decimals() const { return possible_decimals_; }
  /// Number of parameter sets without the seeds.
  std::int64_t num_groups() const;

 private:
  struct Axis {
    const Key* key;
    std::vector<std::string> values;
  };
  std::vector<Axis> axes_;  // the first varies slowest
  CircleFiles circle_files_;
  std::vector<std::string> possible_decimals_;
  std::int64_t size_ = 1;

  /// Before automatic values are known.
  RunParameters unresolved(std::int64_t index) const;
  void refuse_misfitting_angles() const;
};

}  // namespace clog::sweep
