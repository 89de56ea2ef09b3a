#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "clog/campaign/groups.hpp"
#include "clog/campaign/refinement.hpp"
#include "clog/campaign/round_rule.hpp"
#include "clog/sweep/points.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::campaign {

/// A user's settings of a refinement.
struct RefinementOptions {
  std::vector<std::string> keys;  ///< one or two; the outermost values of their lists are the bounds
  RefinementGoal goal;
  double budget = std::numeric_limits<double>::infinity();  ///< computing time of all runs [s]
  /// Whether each value has its own seeds, so that their errors are independent, or all have the same.
  enum class Seeds { own, same };
  Seeds seeds = Seeds::own;
  std::int64_t most_seeds = 0;  ///< of each value
};

/// A sweep over one or two keys that puts values and seeds where its fitted curve needs them, in rounds: each
/// is decided when the one before it is over, by clogs, distances and steps alone (and, with a budget, by the
/// time they took), and is stored before it begins. So a round that has begun does not change, on whatever
/// ranks it goes on.
class Refiner final : public RoundRule {
 public:
  /// @param settings  of the command: one value of every other key. Its seeds are a block: the next ones
  /// follow the last of them
  /// @throws Error that names the key or option
  Refiner(const sweep::Settings& settings, RefinementOptions options);

  /// Its first round: the values that the lists give, or, if these are bounds only, seven values between them
  /// (four of each of two keys).
  const sweep::Settings& first() const override { return first_; }
  std::optional<sweep::Points> next_round(std::span<const sweep::RunRow> rows) override;

  /// Values that rounds may take: preferred numbers of three figures (IEC 60063), so that files of two people
  /// meet. By key.
  const std::vector<std::vector<std::string>>& candidates() const { return values_; }
  std::string text() const override;
  std::vector<std::string> rounds_in_words(double seconds_per_run) const override;
  std::string known(std::span<const sweep::RunRow> rows) const override;

 private:
  struct Look;

  RefinementOptions options_;
  std::vector<std::vector<std::string>> values_;  // candidates of each key
  std::int64_t first_seed_ = 0;
  std::int64_t block_ = 0;
  sweep::Settings first_;
  std::string end_;  // why there is no further round

  std::vector<std::vector<std::string>> combinations(
      const std::vector<std::vector<std::string>>& lists) const;
  sweep::Points points_of(const std::vector<std::vector<std::string>>& places,
                          std::span<const std::int64_t> blocks,
                          std::span<const std::int64_t> next_seeds) const;
  Look look(std::span<const sweep::RunRow> rows) const;
};

}  // namespace clog::campaign
