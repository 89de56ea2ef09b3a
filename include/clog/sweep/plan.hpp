#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clog/core/parameters/parameters.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::sweep {

/// Parameter set of a task, by its number.
using GroupOf = std::function<std::int64_t(std::int64_t task)>;

/// Describes the runs of a sweep. Any task can be computed without the others, in any order. A plan is a list
/// of parameter sets, called groups; each group has its seeds. The parameter sets are the product of the
/// settings' lists; with points, there is one such product for each point.
///
/// Seeds vary slowest, so that every curve fills evenly and neighbouring tasks share their obstacle array. If
/// all groups have equally many seeds, task s * num_groups() + g is seed s of group g.
class Plan {
 public:
  /// Checks every parameter set of the sweep.
  /// @throws Error if a parameter set is impossible, or if the lists would repeat a run
  explicit Plan(const Settings& settings);

  std::int64_t size() const { return size_; }
  /// Number of tasks without a twin, see twin(). This is the number of computed runs.
  std::int64_t num_runs() const { return num_runs_; }
  /// Resolved parameters of task `index`, 0 <= index < size().
  RunParameters task(std::int64_t index) const;
  /// Number of parameter sets without the seeds.
  std::int64_t num_groups() const { return static_cast<std::int64_t>(groups_.size()); }
  /// Resolved parameters of the group's first task.
  RunParameters group(std::int64_t group) const;
  std::int64_t group_of(std::int64_t task) const;
  std::int64_t num_seeds(std::int64_t group) const;
  std::vector<std::uint32_t> seeds(std::int64_t group) const;
  /// The group's values, as texts of the lists, in the order of keys(); the text of the seeds is empty.
  std::vector<std::string> texts(std::int64_t group) const;
  /// @param place  place of the task's seed among the seeds of the group, 0 <= place < num_seeds(group)
  std::int64_t task_of(std::int64_t group, std::int64_t place) const;
  /// The first task that has the same run in another laboratory. (Runs do not depend on the laboratory.)
  /// Empty if `task` itself is the first.
  std::optional<std::int64_t> twin(std::int64_t task) const;
  /// Whether each of the group's tasks has a twin.
  bool has_twin(std::int64_t group) const { return groups_[static_cast<std::size_t>(group)].twin >= 0; }
  /// Whether every group has equally many seeds, and task s * num_groups() + g is seed s of group g.
  bool has_equal_seeds() const { return layers_.size() == 1; }

  /// The circles of the plan's tasks, by file.
  const CircleFiles& circle_files() const { return circle_files_; }
  /// One line for each list that looks like a decimal with a comma, such as 0,5.
  const std::vector<std::string>& possible_decimals() const { return possible_decimals_; }

 private:
  struct Axis {
    const Key* key;
    std::vector<std::string> values;
  };
  /// The lists of one branch of the settings that differ from the lists of the first branch. The key of the
  /// map is the list's place in axes_.
  using OwnLists = std::map<std::size_t, std::vector<std::string>>;
  using Seeds = std::shared_ptr<const std::vector<std::uint32_t>>;
  struct Group {
    std::size_t product;
    std::int64_t place;  ///< place in the product of all lists except the seeds
    Seeds seeds;
    std::int64_t runs;  ///< the first group, before the division into shards, that has the same parameters
                        ///< apart from the laboratory
    std::int64_t twin = -1;  ///< group that contains the twins of this group's tasks; -1: no twins
  };
  /// Successive tasks that go through the same groups again and again, each time with the next seed.
  struct Layer {
    std::int64_t first_task;
    std::int64_t first_seed;  ///< place of the first seed among the seeds of a group
    std::vector<std::int64_t> groups;
  };
  class Builder;

  std::vector<Axis> axes_;  // all axes except the seeds; the first varies slowest
  std::vector<OwnLists> products_;
  std::vector<Group> groups_;
  std::vector<Layer> layers_;
  CircleFiles circle_files_;
  std::vector<std::string> possible_decimals_;
  std::int64_t size_ = 0;
  std::int64_t num_runs_ = 0;

  const Layer& layer_of(std::int64_t task) const;
  std::int64_t seed_place(std::int64_t task) const;
  std::vector<const std::string*> texts(std::size_t product, std::int64_t place) const;
  /// The parameters without their automatic values.
  RunParameters unresolved(std::size_t product, std::int64_t place, std::uint32_t seed) const;
  RunParameters parameters(std::size_t product, std::int64_t place, std::uint32_t seed) const;
};

/// The single parameter set of the settings. @throws Error if there are several
RunParameters single_run(const Settings& settings);

}  // namespace clog::sweep
