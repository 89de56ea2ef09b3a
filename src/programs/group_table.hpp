#pragma once

#include <span>
#include <string>
#include <vector>

#include "clog/fit/clogging_length.hpp"
#include "clog/fit/mean_speed.hpp"
#include "clog/fit/migration.hpp"
#include "clog/sweep/run_row.hpp"

namespace clog {

/// The runs of a sweep that differ in their seed only, and what they say together.
struct Group {
  sweep::RunRow parameters;  ///< of its first run
  fit::CloggingLength clogging;
  fit::MeanSpeed speed;  ///< in units of the terminal speed
  fit::Migration migration;
  int num_flowing = 0;
  int num_interrupted = 0;
  int num_failed = 0;  ///< left out of all fits
};

/// Groups rows by everything but the seed, in the order of their parameters.
std::vector<Group> group_runs(std::span<const sweep::RunRow> rows, double confidence);

std::string to_text(const std::vector<Group>& groups, double confidence);
std::string to_csv(const std::vector<Group>& groups);
std::string to_json(const std::vector<Group>& groups, double confidence);

}  // namespace clog
