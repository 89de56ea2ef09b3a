#pragma once

#include <string>
#include <vector>

#include "clog/fit/clogging_length.hpp"
#include "clog/results/groups.hpp"

namespace clog::results {

/// A mixture of droplets from several groups in given shares, for instance of droplets of several sizes.
/// Distances are in mm if the groups have different laboratories, otherwise in sigma.
struct Mixture {
  struct Part {
    std::string value;  ///< value of `column` in the group, e.g. "2.8 mm"
    double share;       ///< share of the droplets; the sum of all shares is 1
  };
  struct Step {
    double distance;
    double probability;  ///< P just beyond this distance
    fit::Interval interval;
  };
  std::string column;  ///< `diameter`, or the parameter that distinguishes the groups
  std::vector<Part> parts;
  std::string unit;
  double length = 0;         ///< NaN without clogs
  fit::Interval interval{};  ///< NaN if unknown; `upper` may be infinite
  /// Steps of P(r), up to the shortest distance to which the P(r) of all groups are known.
  std::vector<Step> survival;
  std::vector<double>
      censored_distances;  ///< distances of the runs that did not clog, up to the same distance
};

/// The clogging length and the survival curve of a mixture. The distance per run and the clogs per run of
/// each group are weighted with its share. Intervals are percentiles of 2000 bootstrap resamples of seeds.
/// Runs with the same seed stay together. Seeds that occur in the same groups form a stratum, and each
/// stratum has as many seeds in a resample as in the sweep. So the method works whether or not groups share
/// seeds.
/// @param text  a column and the weights of its values: `diameter=2.8mm:0.3,3.2mm:0.7`
/// @param groups  from group_runs(), not empty
/// @throws Error if the text has another form, or if not exactly one group has each of these values
Mixture mix(const std::string& text, const std::vector<Group>& groups, double confidence);

/// One line with the parts of the mixture and its clogging length.
std::string to_text(const Mixture& mixture, double confidence);

}  // namespace clog::results
