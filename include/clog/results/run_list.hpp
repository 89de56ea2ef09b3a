#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::results {

/// Runs of one or several sweeps, and the settings of a sweep with exactly these runs.
class RunList {
 public:
  /// Adds all runs of a plan. @throws Error if another plan has other circles under the same name
  void add(const sweep::Plan& plan);
  /// Adds runs that may be outside the plan, for instance runs of an earlier command of the sweep. A run
  /// outside the plan gets the texts of the plan's first parameter set, except where its row has other
  /// values. Prints the number of runs that these texts do not describe. @throws Error as add()
  /// @param path  path of the file that contains the rows
  void add_rows(const std::string& path, const sweep::Plan& plan, const std::vector<sweep::RunRow>& rows);

  /// Adds the seed of a run if its parameter set is known. Returns whether the set is known.
  bool add_seed(const sweep::RunRow& row);
  /// Adds the smallest unused seeds to every parameter set until it has `number` seeds. Parameter sets in
  /// which nothing is random are not changed.
  void fill_seeds(std::size_t number);

  bool empty() const { return sets_.empty(); }
  /// The settings of a sweep with exactly these runs. If the runs are the product of lists, the settings
  /// contain these lists; otherwise they contain points. Values and points are in increasing order. The list
  /// must not be empty.
  sweep::Settings settings() const;

 private:
  struct ParameterSet {
    std::vector<std::string> texts;  // texts by place in sweep::keys(); empty for the seeds
    std::set<std::uint32_t> seeds;
    bool is_random = true;  // whether runs depend on the seed
  };
  std::vector<ParameterSet> sets_;
  std::unordered_map<std::string, std::size_t> places_;  // places in sets_, by the content of the set
  sweep::CircleFiles circle_files_;

  /// Returns whether the run is added.
  bool add(const sweep::Plan& plan, const sweep::RunRow& row);
  ParameterSet& set_of(const sweep::Plan& plan, const sweep::RunRow& run, std::vector<std::string> texts);
  sweep::Points points(const std::vector<std::size_t>& differing) const;
};

}  // namespace clog::results
