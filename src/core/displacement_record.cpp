#include "clog/core/displacement_record.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace clog {
namespace {

constexpr std::size_t capacity = 1024;
constexpr double arrest_distance = 0.01;  // [sigma]
constexpr double transient_fraction = 0.1;
constexpr double shortest_travel = 0.5;  // [sigma]
constexpr std::size_t fewest_samples = 8;

}  // namespace

void DisplacementRecord::add(double time, double displacement) {
  if (count_++ % stride_ != 0) return;
  if (samples_.size() == capacity) {
    for (std::size_t i = 0; i < capacity / 2; ++i) samples_[i] = samples_[2 * i];
    samples_.resize(capacity / 2);
    stride_ *= 2;
    if ((count_ - 1) % stride_ != 0) return;
  }
  samples_.push_back({time, displacement});
}

void DisplacementRecord::save(ByteWriter& bytes) const {
  bytes.put(samples_);
  bytes.put(stride_);
  bytes.put(count_);
}

void DisplacementRecord::restore(ByteReader& bytes) {
  bytes.get(samples_);
  bytes.get(stride_);
  bytes.get(count_);
}

double DisplacementRecord::mean_speed() const {
  constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
  std::size_t end = samples_.size();
  while (end > 0 &&
         std::abs(samples_[end - 1].displacement - samples_.back().displacement) <= arrest_distance)
    --end;
  if (end == 0) return undefined;
  const double begin_time =
      samples_.front().time + transient_fraction * (samples_[end - 1].time - samples_.front().time);
  std::size_t begin = 0;
  while (begin < end && samples_[begin].time < begin_time) ++begin;
  const Eigen::Index n = static_cast<Eigen::Index>(end - begin);
  if (n < static_cast<Eigen::Index>(fewest_samples) ||
      samples_[end - 1].displacement - samples_[begin].displacement < shortest_travel)
    return undefined;
  Eigen::ArrayXd time(n), displacement(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    time[i] = samples_[begin + i].time;
    displacement[i] = samples_[begin + i].displacement;
  }
  time -= time.mean();
  return (time * (displacement - displacement.mean())).sum() / time.square().sum();
}

}  // namespace clog
