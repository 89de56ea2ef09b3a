#include "sweep_cost.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "clog/fit/clogging_length.hpp"

namespace clog {
namespace {

constexpr double confidence = 0.95;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// How unfinished runs may go on, by how the sample fared lately.
class Outlook {
 public:
  enum class Case { lowest, middle, highest };

  explicit Outlook(std::span<const RunCost> sample) {
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
    even_ = fit::fit_clogging_length(times, confidence);
    slowing_ = fit::fit_clogging_length(logarithms, confidence);
  }

  /// Mean time that a run still takes if nothing but max-time ends it after `longest`.
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
    // Not known at all: every order of magnitude of what is left is as likely as any other.
    if (may_never_end) return most / std::log(longest / run.seconds);
    return std::sqrt(if_even(mean(even_), most) * if_slowing(mean(slowing_), run.seconds, longest));
  }

 private:
  std::set<std::int64_t> sets_with_ends_;
  fit::CloggingLength even_;     // of times: one run ends as likely as any other
  fit::CloggingLength slowing_;  // of their logarithms: the longer a run has lasted, the longer it will

  /// Half an end more: without any the mean is long, but not infinite.
  static double mean(const fit::CloggingLength& fit) { return fit.total_distance / (fit.num_clogs + 0.5); }

  /// Ends are exponential, P = exp(-t/mean).
  static double if_even(double mean, double most) {
    return std::isinf(mean) ? most : mean * -std::expm1(-most / mean);
  }
  /// Ends follow the power law that mixes all exponentials alike, P = (t/seconds)^(-1/mean).
  static double if_slowing(double mean, double seconds, double longest) {
    const double power = 1 - 1 / mean;
    const double logarithm = std::log(longest / seconds);
    return seconds * (power == 0 ? logarithm : std::expm1(power * logarithm) / power);
  }
};

/// Of what a sample costs over what it costs at most.
class Share {
 public:
  Share(std::span<const RunCost> sample, double seconds_per_work, const Outlook& outlook,
        Outlook::Case which) {
    for (const RunCost& run : sample) {
      const double longest = seconds_per_work * run.longest_work;
      const double left =
          run.is_over || run.seconds >= longest ? 0 : outlook.seconds_left(run, longest, which);
      expected_.push_back(run.begin_seconds + run.seconds + left);
      longest_.push_back(run.begin_seconds + longest);
      expected_sum_ += expected_.back();
      longest_sum_ += longest_.back();
    }
  }
  double value() const { return expected_sum_ / longest_sum_; }

  /// Standard error over the value, as of a ratio of sums over a sample without replacement.
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
};

}  // namespace

SweepCost sweep_cost(std::span<const RunCost> sample, double all_work, std::int64_t num_runs) {
  double begin_seconds = 0, seconds = 0, work = 0;
  for (const RunCost& run : sample) {
    begin_seconds += run.begin_seconds;
    seconds += run.seconds;
    work += run.work;
  }
  SweepCost cost;
  cost.seconds_per_work = seconds / work;
  cost.bound = cost.seconds_per_work * all_work +
               begin_seconds / static_cast<double>(sample.size()) * static_cast<double>(num_runs);

  const Outlook outlook(sample);
  const auto share = [&](Outlook::Case which) {
    return Share(sample, cost.seconds_per_work, outlook, which);
  };
  const Share middle = share(Outlook::Case::middle);
  const double sampling = 1.96 * middle.relative_error(num_runs);
  const auto factor = [&](double outlooks) { return std::exp(std::hypot(std::log(outlooks), sampling)); };
  cost.expected = cost.bound * middle.value();
  cost.lower = cost.expected / factor(middle.value() / share(Outlook::Case::lowest).value());
  cost.upper =
      std::min(cost.bound, cost.expected * factor(share(Outlook::Case::highest).value() / middle.value()));
  return cost;
}

}  // namespace clog
