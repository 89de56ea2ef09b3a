#pragma once

#include <deque>
#include <optional>
#include <string>

#include "clog/campaign/refiner.hpp"
#include "clog/cli/command_line.hpp"
#include "clog/conduct/lead.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::programs {

/// Declares --refine, --until, --budget, --same-seeds.
void add_refine_options(cli::CommandLine& line);
/// The refiner that these options ask for; nothing without --refine. @throws Error if they are invalid
std::optional<campaign::Refiner> refiner(const cli::CommandLine& line);

class RefinedSweep;
/// The refined sweep of a command, with the rounds in its output file; nothing without --refine.
/// @throws Error if an option is invalid or the file cannot be read
std::optional<RefinedSweep> refined_sweep(const cli::CommandLine& line);

/// A sweep that is refined: its settings with all rounds so far, and its plans, of which the last counts.
class RefinedSweep {
 public:
  /// Continues with the rounds that the output file has if its points are the same (other keys are not
  /// compared). @throws Error if it cannot be read
  RefinedSweep(campaign::Refiner refiner, const std::string& output);
  RefinedSweep(const RefinedSweep&) = delete;

  campaign::Refiner& refiner() { return refiner_; }
  const campaign::Refiner& refiner() const { return refiner_; }
  const sweep::Settings& settings() const { return settings_; }
  const sweep::Plan& plan() const { return plans_.back(); }
  /// One more round. Earlier plans stay.
  void grow(const sweep::Points& round);

 private:
  campaign::Refiner refiner_;
  sweep::Settings settings_;
  std::deque<sweep::Plan> plans_;
};

}  // namespace clog::programs
