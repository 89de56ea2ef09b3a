#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "clog/campaign/round_rule.hpp"
#include "clog/cli/command_line.hpp"
#include "clog/conduct/lead.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::programs {

/// Declares --refine, --until, --budget, --same-seeds.
void add_refine_options(cli::CommandLine& line);
/// The rule that these options ask for; nothing without --refine. @throws Error if they are invalid
std::unique_ptr<campaign::RoundRule> refiner(const cli::CommandLine& line);

class RefinedSweep;
/// The refined sweep of a command, with the rounds in its output file; nothing without --refine.
/// @throws Error if an option is invalid or the file cannot be read
std::optional<RefinedSweep> refined_sweep(const cli::CommandLine& line);

/// A sweep that is refined: its settings with all rounds so far, and its plans, of which the last counts.
class RefinedSweep {
 public:
  /// Continues with the rounds that the output file has if its points are the same (other keys are not
  /// compared). @throws Error if it cannot be read
  RefinedSweep(std::unique_ptr<campaign::RoundRule> refiner, const std::string& output);
  RefinedSweep(const RefinedSweep&) = delete;

  campaign::RoundRule& refiner() { return *refiner_; }
  const campaign::RoundRule& refiner() const { return *refiner_; }
  const sweep::Settings& settings() const { return settings_; }
  const sweep::Plan& plan() const { return plans_.back(); }
  /// One more round. Earlier plans stay.
  void grow(const sweep::Points& round);

 private:
  std::unique_ptr<campaign::RoundRule> refiner_;
  sweep::Settings settings_;
  std::deque<sweep::Plan> plans_;
};

}  // namespace clog::programs
