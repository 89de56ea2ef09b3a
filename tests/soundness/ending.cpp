#include "ending.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace clog::soundness {
namespace {

constexpr std::size_t fewest_samples = 40;

double quantile(std::span<const double> values, double fraction) {
  std::vector<double> sorted(values.begin(), values.end());
  const auto place =
      sorted.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), place, sorted.end());
  return *place;
}

/// The displacement of every vertex, with all x first and then all y [sigma].
Eigen::ArrayXd way_between(const DropletState& from, const DropletState& to) {
  const Eigen::Array2d shift = to.frame.displacement({0, 0}, from.frame, {0, 0});
  Eigen::ArrayXd way = to.position - from.position;
  way.head(to.size()) += shift[0];
  way.tail(to.size()) += shift[1];
  return way;
}

}  // namespace

const char* name(Ending ending) {
  switch (ending) {
    case Ending::moving:
      return "moving";
    case Ending::decaying:
      return "decaying";
    case Ending::steady:
      return "steady";
    case Ending::chattering:
      return "chattering";
  }
  return "unknown";
}

Ending Tail::ending() const {
  if (mean_speed > slowest_travel) return Ending::moving;
  if (fall > least_fall && last_fall >= 0) return Ending::decaying;
  return coherence < least_coherence ? Ending::chattering : Ending::steady;
}

void TailRecorder::add_energy(double energy_ratio, double interval) {
  constexpr double smallest = 1e-300;  // for a droplet at rest
  log_energy_.push_back(std::log10(std::max(energy_ratio, smallest)));
  time_ += interval;
  // E_k/E_t is the mean square speed of the vertices divided by V_t^2.
  expected_way_ += std::sqrt(energy_ratio) * terminal_speed_ * interval;
}

void TailRecorder::add_place(const DropletState& state) {
  if (last_) {
    sum_way_ += std::sqrt(way_between(*last_, state).square().sum() / static_cast<double>(state.size()));
    sum_expected_way_ += expected_way_;
  } else {
    first_ = state;
  }
  expected_way_ = 0;
  last_ = state;
}

std::optional<Tail> TailRecorder::tail() const {
  if (log_energy_.size() < fewest_samples || sum_expected_way_ <= 0) return std::nullopt;
  const std::size_t size = log_energy_.size() / 4;
  const auto quarter = [&](int index) { return std::span(log_energy_).subspan(index * size, size); };
  const double first = quantile(quarter(0), 0.5);
  const double third = quantile(quarter(2), 0.5);
  const double last = quantile(quarter(3), 0.5);
  const Eigen::Array2d travel = last_->frame.displacement(last_->centre(), first_->frame, first_->centre());
  return Tail{.mean_speed = travel.matrix().norm() / time_ / terminal_speed_,
              .level = last,
              .fall = first - last,
              .last_fall = third - last,
              .band = quantile(quarter(3), 0.95) - quantile(quarter(3), 0.05),
              .coherence = sum_way_ / sum_expected_way_};
}

}  // namespace clog::soundness
