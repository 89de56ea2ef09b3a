#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "clog/sweep/points.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::campaign {

/// Decides which values a sweep gets, in rounds: each when the one before it is over, from the rows alone, so
/// that it does not depend on ranks or interruptions. A round is stored before it begins.
class RoundRule {
 public:
  RoundRule() = default;
  virtual ~RoundRule() = default;
  RoundRule(const RoundRule&) = delete;
  RoundRule& operator=(const RoundRule&) = delete;

  /// The first round.
  virtual const sweep::Settings& first() const = 0;
  /// The next round; nothing if what was asked is known, the budget is used up, or nothing is left to add.
  /// @param rows  all runs of the file
  virtual std::optional<sweep::Points> next_round(std::span<const sweep::RunRow> rows) = 0;
  /// The rule in words, as it is stored with the result.
  virtual std::string text() const = 0;
  /// What the rounds after the first may come to. @param seconds_per_run  mean of the first round's runs
  virtual std::vector<std::string> rounds_in_words(double seconds_per_run) const = 0;
  /// What is known after the last look, in words.
  virtual std::string known(std::span<const sweep::RunRow> rows) const = 0;
};

/// The unit of computing time in which costs and budgets are told [s].
inline constexpr double hour = 3600;
/// The goal, the budget, or both. @param budget  computing time of all runs [s]; infinite: there is none
std::string goal_or_budget(const std::string& goal, double budget);
/// @throws Error if a key other than these and the seeds has several values
void require_one_value_of_others(const sweep::Settings& settings, std::span<const std::string> keys);

}  // namespace clog::campaign
