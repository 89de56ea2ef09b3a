#include "clog/results/cost.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "clog/fit/clogging_length.hpp"
#include "confidence.hpp"

namespace clog::results {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Residual time of unfinished runs, estimated from late ends of the sample.
class ResidualTime {
 public:
  enum class Case { lowest, middle, highest };

  explicit ResidualTime(std::span<const RunCost> sample) {
    double shortest = infinite;
    for (const RunCost& run : sample)
      if (run.is_over)
        sets_with_ends_.insert(run.parameter_set);
      else
        shortest = std::min(shortest, run.seconds);
    std::vector<fit::Observation> times, logarithms;
    for (const RunCost& run : sample)
      if (const double begin = shortest / 2; run.seconds > begin) {
        times.push_back({run.seconds - begin, run.is_over});
        logarithms.push_back({std::log(run.seconds / begin), run.is_over});
      }
    even_ = fit::fit_clogging_length(times, default_confidence);
    slowing_ = fit::fit_clogging_length(logarithms, default_confidence);
  }

  /// Mean remaining time of a run that lasts at most `longest`, because of max-time.
  double seconds_left(const RunCost& run, double longest, Case which) const {
    const double most = longest - run.seconds;
    const bool may_never_end = !sets_with_ends_.contains(run.parameter_set);
    switch (which) {
      case Case::lowest:
        return if_even(even_.interval.lower, most);
      case Case::highest:
        return may_never_end ? most : if_slowing(slowing_.interval.upper, run.seconds, longest);
      case Case::middle:
        break;
    }
    // Without any end, every order of magnitude of the remaining time is assumed to be equally likely.
    if (may_never_end) return most / std::log(longest / run.seconds);
    return std::sqrt(if_even(mean(even_), most) * if_slowing(mean(slowing_), run.seconds, longest));
  }

 private:
  std::set<std::int64_t> sets_with_ends_;
  fit::CloggingLength even_;     // fit to the times: every run is equally likely to end next
  fit::CloggingLength slowing_;  // fit to their logarithms: the remaining time grows with the time so far

  /// Mean of a fitted law. Half an end is added to the number of ends, so that the mean is finite even
  /// without any end.
  static double mean(const fit::CloggingLength& fit) { return fit.total_distance / (fit.num_clogs + 0.5); }

  /// Mean remaining time for exponential ends, P = exp(-t/mean).
  static double if_even(double mean, double most) {
    return std::isinf(mean) ? most : mean * -std::expm1(-most / mean);
  }
  /// Mean remaining time for ends with the power law P = (t/seconds)^(-1/mean), which is a mixture of
  /// exponentials.
  static double if_slowing(double mean, double seconds, double longest) {
    const double power = 1 - 1 / mean;
    const double logarithm = std::log(longest / seconds);
    return seconds * (power == 0 ? logarithm : std::expm1(power * logarithm) / power);
  }
};

/// Estimated cost of a sample divided by its upper bound.
class Share {
 public:
  Share(std::span<const RunCost> sample, double seconds_per_work, const ResidualTime& residual,
        ResidualTime::Case which) {
    for (const RunCost& run : sample) {
      const double longest = seconds_per_work * run.longest_work;
      const double left =
          run.is_over || run.seconds >= longest ? 0 : residual.seconds_left(run, longest, which);
      expected_.push_back(run.begin_seconds + run.seconds + left);
      longest_.push_back(run.begin_seconds + longest);
      expected_sum_ += expected_.back();
      longest_sum_ += longest_.back();
      left_ += left;
    }
  }
  double value() const { return expected_sum_ / longest_sum_; }
  /// Remaining time of the runs in the sample.
  double seconds_left() const { return left_; }

  /// Relative standard error of a ratio of sums, for a sample without replacement.
  double relative_error(std::int64_t population) const {
    const auto n = static_cast<double>(expected_.size());
    const auto all = static_cast<double>(population);
    if (n >= all) return 0;
    if (n < 2) return 1;
    double squares = 0;
    for (std::size_t i = 0; i < expected_.size(); ++i)
      squares += std::pow(expected_[i] - value() * longest_[i], 2);
    return std::sqrt(squares / (n - 1) * n * (1 - n / all)) / expected_sum_;
  }

 private:
  std::vector<double> expected_, longest_;
  double expected_sum_ = 0;
  double longest_sum_ = 0;
  double left_ = 0;
};

/// Mean time before a droplet moves, and mean time per unit of work after that.
struct Pace {
  double begin_seconds = 0;
  double seconds_per_work = 0;

  explicit Pace(std::span<const RunCost> sample) {
    double seconds = 0, work = 0;
    for (const RunCost& run : sample) {
      begin_seconds += run.begin_seconds / static_cast<double>(sample.size());
      seconds += run.seconds;
      work += run.work;
    }
    seconds_per_work = seconds / work;
  }
  double longest(double work, std::int64_t num_runs) const {
    return seconds_per_work * work + begin_seconds * static_cast<double>(num_runs);
  }
};

/// Expected seconds for each ResidualTime::Case, and the standard error of the middle case.
struct Expectation {
  double lowest = 0;
  double middle = 0;
  double highest = 0;
  double variance = 0;

  double relative_error() const { return std::sqrt(variance) / middle; }
};

SweepCost cost_with_interval(const Pace& pace, double bound, const Expectation& seconds) {
  SweepCost cost{.seconds_per_work = pace.seconds_per_work, .bound = bound};
  if (seconds.middle == 0) return cost;
  const double sampling = 1.96 * seconds.relative_error();
  const auto factor = [&](double ratio) { return std::exp(std::hypot(std::log(ratio), sampling)); };
  // The estimate is limited, because a run of the sample may have taken longer than its bound at the mean
  // pace.
  cost.expected = std::min(bound, seconds.middle);
  cost.lower = cost.expected / factor(seconds.middle / seconds.lowest);
  cost.upper = std::min(bound, cost.expected * factor(seconds.highest / seconds.middle));
  return cost;
}

/// The share of a sample for each ResidualTime::Case.
class Shares {
 public:
  Shares(std::span<const RunCost> runs, const Pace& pace, const ResidualTime& residual)
      : lowest_(runs, pace.seconds_per_work, residual, ResidualTime::Case::lowest),
        middle_(runs, pace.seconds_per_work, residual, ResidualTime::Case::middle),
        highest_(runs, pace.seconds_per_work, residual, ResidualTime::Case::highest),
        num_runs_(static_cast<std::int64_t>(runs.size())) {}

  /// Remaining time of the runs in the sample.
  Expectation left() const {
    return {lowest_.seconds_left(), middle_.seconds_left(), highest_.seconds_left()};
  }
  /// Estimate for runs that would take `longest` if all of them lasted to max-time.
  Expectation of(double longest, double relative_error) const {
    const double middle = longest * middle_.value();
    return {longest * lowest_.value(), middle, longest * highest_.value(),
            std::pow(middle * relative_error, 2)};
  }
  double error_of_all(std::int64_t population) const { return middle_.relative_error(population); }
  /// Only runs outside the sample contribute to the error, because the cost of the runs in the sample is
  /// known.
  double error_of_others(std::int64_t number) const {
    const std::int64_t all = num_runs_ + number;
    return middle_.relative_error(all) * static_cast<double>(all) / static_cast<double>(number);
  }

 private:
  Share lowest_, middle_, highest_;
  std::int64_t num_runs_;
};

void add(Expectation& sum, const Expectation& more) {
  sum.lowest += more.lowest;
  sum.middle += more.middle;
  sum.highest += more.highest;
  sum.variance += more.variance;
}

}  // namespace

SweepCost sweep_cost(std::span<const RunCost> sample, double all_work, std::int64_t num_runs) {
  const Pace pace(sample);
  const double bound = pace.longest(all_work, num_runs);
  const Shares shares(sample, pace, ResidualTime(sample));
  return cost_with_interval(pace, bound, shares.of(bound, shares.error_of_all(num_runs)));
}

SweepCost cost_left(std::span<const RunCost> begun, std::span<const WaitingRuns> waiting) {
  const Pace pace_of_all(begun);
  const ResidualTime residual_of_all(begun);
  std::map<std::int64_t, std::vector<RunCost>> runs_of;
  for (const RunCost& run : begun) runs_of[run.parameter_set].push_back(run);

  double bound = 0;
  Expectation seconds;
  std::map<std::int64_t, Shares> sets;
  std::map<std::int64_t, Pace> paces;  // with a common pace, a slow set would exceed its bound
  for (const auto& [set, runs] : runs_of) {
    const Pace& pace = paces.emplace(set, Pace(runs)).first->second;
    const bool has_end =
        std::any_of(runs.begin(), runs.end(), [](const RunCost& run) { return run.is_over; });
    const Shares& shares =
        sets.emplace(set, Shares(runs, pace, has_end ? ResidualTime(runs) : residual_of_all)).first->second;
    add(seconds, shares.left());
    for (const RunCost& run : runs)
      if (!run.is_over) bound += std::max(0.0, pace.seconds_per_work * run.longest_work - run.seconds);
  }
  const Shares all(begun, pace_of_all, residual_of_all);
  constexpr double error_of_strangers = 1;
  for (const WaitingRuns& runs : waiting) {
    if (runs.number == 0) continue;
    const auto set = sets.find(runs.parameter_set);
    const Pace& pace = set == sets.end() ? pace_of_all : paces.at(runs.parameter_set);
    const double longest = pace.longest(static_cast<double>(runs.number) * runs.longest_work, runs.number);
    add(seconds, set == sets.end() ? all.of(longest, error_of_strangers)
                                   : set->second.of(longest, set->second.error_of_others(runs.number)));
    bound += longest;
  }
  return cost_with_interval(pace_of_all, bound, seconds);
}

}  // namespace clog::results
