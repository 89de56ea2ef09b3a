#include "clogsweep_refine.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "clog/campaign/angle_search.hpp"
#include "clog/campaign/refiner.hpp"
#include "clog/campaign/stored_sweep.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/split.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::programs {
namespace {

using campaign::RefinementGoal;
using campaign::RefinementOptions;

/// NaN if the text is not a number.
double number_of(const std::string& text) {
  try {
    return sweep::to_number(text);
  } catch (const Error&) {
    return std::nan("");
  }
}

/// `20%` or `0.2`. NaN if it is neither.
double share(std::string text) {
  const bool is_percent = text.ends_with('%');
  if (is_percent) text.pop_back();
  return number_of(text) / (is_percent ? 100 : 1);
}

RefinementGoal goal_of(const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    throw Error(
        fmt::format("invalid --until={} ({}) try curve=20%, peak=10%, crossing=10:5% or, for a lattice, "
                    "critical-angle=0.5",
                    text, why));
  };
  const std::size_t equals = std::min(text.find('='), text.size());
  const std::string kind = text.substr(0, equals);
  std::string rest = equals < text.size() ? text.substr(equals + 1) : "";
  RefinementGoal goal;
  if (kind == "curve") {
    goal.kind = RefinementGoal::Kind::curve;
  } else if (kind == "peak") {
    goal.kind = RefinementGoal::Kind::peak;
  } else if (kind == "crossing") {
    goal.kind = RefinementGoal::Kind::crossing;
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    goal.length = number_of(rest.substr(0, colon));
    rest = colon < rest.size() ? rest.substr(colon + 1) : "";
    if (!(goal.length > 0)) refuse("a crossing has a length and a precision");
  } else {
    refuse("is not one of curve, peak, crossing, critical-angle");
  }
  goal.precision = share(rest);
  if (!(goal.precision >= 0.001 && goal.precision < 1))
    refuse("the precision must lie between 0.1% and 100%");
  return goal;
}

/// `critical-angle=0.5`: the width of the bracket [degrees].
double bracket_of(const std::string& text) {
  constexpr double narrowest = 1e-3;
  constexpr double widest = 20;
  const double width = number_of(text.substr(std::min(text.find('=') + 1, text.size())));
  if (width >= narrowest && width <= widest) return width;
  throw Error(
      fmt::format("invalid --until={} (the width of the bracket must lie between {} and {} degrees) try "
                  "critical-angle=0.5",
                  text, narrowest, widest));
}

/// The budget in seconds.
double budget_of(std::string text) {
  const std::string given = text;
  if (text.ends_with('h')) text.pop_back();
  const double hours = number_of(text);
  if (hours > 0) return hours * campaign::hour;
  throw Error("invalid --budget=" + given + " (must be a number of core-hours above zero) try 10h");
}

std::int64_t most_seeds_of(const cli::CommandLine& line, std::int64_t block) {
  constexpr std::int64_t usual_blocks = 50;
  const double number = line.get_number("most-seeds", static_cast<double>(usual_blocks * block));
  if (number >= static_cast<double>(block) && number <= 1e5 && number == std::floor(number))
    return static_cast<std::int64_t>(number);
  throw Error(
      fmt::format("invalid --most-seeds={} (must be a whole number from {}, the number of `seeds`, to 1e5)",
                  line.get("most-seeds"), block));
}

bool asks_for_angle(const std::string& goal) { return goal.starts_with("critical-angle="); }

/// A search for the critical angle of a lattice, which is all that its angle is refined for.
std::unique_ptr<campaign::RoundRule> angle_search(const cli::CommandLine& line) {
  const std::string goal = line.has("until") ? line.get("until") : "critical-angle=";
  const auto refuse = [](const char* option, const std::string& value) {
    throw Error(
        fmt::format("invalid --{}={} (lattice-angle is refined alone, for the critical angle) try "
                    "--refine lattice-angle --until critical-angle=0.5",
                    option, value));
  };
  if (line.get("refine").find(',') != std::string::npos) refuse("refine", line.get("refine"));
  if (!asks_for_angle(goal)) refuse("until", goal);
  for (const char* option : {"same-seeds", "most-seeds"})
    if (line.has(option))
      throw Error(fmt::format("invalid --{} (each angle gets the seeds of `seeds`) leave it out", option));
  campaign::AngleSearch::Options options;
  if (line.has("until")) options.width = bracket_of(goal);
  if (line.has("budget")) options.budget = budget_of(line.get("budget"));
  return std::make_unique<campaign::AngleSearch>(line.settings(), options);
}

/// Do both describe the same curve? Then its rounds are those of the other.
bool have_same_curve(const sweep::Settings& one, const sweep::Settings& other) {
  return one.points().keys == other.points().keys && one.points().rows == other.points().rows &&
         std::ranges::all_of(sweep::keys(), [&](const sweep::Key& key) {
           return one.values(key.name) == other.values(key.name);
         });
}

/// The settings, with the rounds of the output file if that has the same curve.
sweep::Settings continued(sweep::Settings settings, const std::string& output) {
  if (output.empty() || !std::filesystem::exists(output)) return settings;
  const store::SweepFile file = store::read_sweep(output);
  if (campaign::attribute(file.provenance, "config").empty()) return settings;
  const sweep::Settings stored = campaign::stored_settings(output, file.provenance);
  if (!have_same_curve(stored, settings)) return settings;
  for (const sweep::Points& round : stored.rounds()) settings.add_round(round);
  return settings;
}

}  // namespace

void add_refine_options(cli::CommandLine& line) {
  namespace po = boost::program_options;
  const auto text = [] { return po::value<std::string>(); };
  line.add_options()("refine", text(),
                     "key, or two with a comma between: put values and seeds where the curve of lambda needs "
                     "them, between the "
                     "outermost values of the key's list")(
      "until", text(),
      "with --refine: what is to be known, curve=20%, peak=10% or crossing=10:5% (where lambda is 10 sigma); "
      "with "
      "--refine lattice-angle: critical-angle=0.5, where droplets leave the rows, in a bracket of 0.5 "
      "degrees")("budget", text(), "with --refine: core-hours that all runs may take, e.g. 10h")(
      "same-seeds", "with --refine: all values have the same seeds, not seeds of their own");
}

std::unique_ptr<campaign::RoundRule> refiner(const cli::CommandLine& line) {
  if (!line.has("refine")) {
    for (const char* option : {"until", "budget", "same-seeds"})
      if (line.has(option)) throw Error(fmt::format("--{} needs --refine", option));
    return nullptr;
  }
  for (const char* option : {"until-precision", "points", "shard"})
    if (line.has(option)) throw Error(fmt::format("--refine and --{} exclude each other; give one", option));
  if (!line.has("until") && !line.has("budget"))
    throw Error("--refine needs an end; try --until curve=20%, or --budget 10h");
  RefinementOptions options;
  options.keys = split_at_commas(line.get("refine"));
  for (std::string& key : options.keys) std::ranges::replace(key, '_', '-');
  if (std::ranges::find(options.keys, "lattice-angle") != options.keys.end()) return angle_search(line);
  if (line.has("until") && asks_for_angle(line.get("until")))
    throw Error(
        fmt::format("invalid --until={} (is found over the angle of a lattice) try --refine lattice-angle",
                    line.get("until")));
  if (line.has("until")) options.goal = goal_of(line.get("until"));
  if (line.has("budget")) options.budget = budget_of(line.get("budget"));
  if (line.has("same-seeds")) options.seeds = RefinementOptions::Seeds::same;
  options.most_seeds = most_seeds_of(line, static_cast<std::int64_t>(line.settings().values("seeds").size()));
  return std::make_unique<campaign::Refiner>(line.settings(), options);
}

std::optional<RefinedSweep> refined_sweep(const cli::CommandLine& line) {
  std::unique_ptr<campaign::RoundRule> rule = refiner(line);
  if (!rule) return std::nullopt;
  return std::optional<RefinedSweep>(std::in_place, std::move(rule), line.get("output"));
}

RefinedSweep::RefinedSweep(std::unique_ptr<campaign::RoundRule> refiner, const std::string& output)
    : refiner_(std::move(refiner)), settings_(continued(refiner_->first(), output)) {
  plans_.emplace_back(settings_);
}

void RefinedSweep::grow(const sweep::Points& round) {
  settings_.add_round(round);
  plans_.emplace_back(settings_);
}

}  // namespace clog::programs
