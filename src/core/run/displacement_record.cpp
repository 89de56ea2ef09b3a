#include "clog/core/run/displacement_record.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <span>

#include "clog/core/tools/error.hpp"

namespace clog {
namespace {

constexpr std::size_t capacity = 1024;
constexpr double arrest_distance = 0.01;  // [sigma]
constexpr double shortest_travel = 0.5;   // [sigma]

}  // namespace

void DisplacementRecord::add(double time, double displacement) {
  assert(samples_.empty() || time > samples_.back().time);
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

void DisplacementRecord::restore(ByteReader& bytes, double time) {
  bytes.get(samples_);
  bytes.get(stride_);
  bytes.get(count_);
  const bool are_whole = std::ranges::all_of(samples_, [&](const TravelSample& sample) {
    return sample.time > 0 && sample.time <= time && std::isfinite(sample.displacement);
  });
  const bool is_power = stride_ > 0 && std::has_single_bit(static_cast<std::uint64_t>(stride_));
  if (!are_whole || !is_power || count_ < 0 || samples_.size() > capacity)
    throw Error("its displacements are out of range");
}

TravelSpeed DisplacementRecord::travel_speed() const {
  std::size_t end = samples_.size();
  while (end > 0 &&
         std::abs(samples_[end - 1].displacement - samples_.back().displacement) <= arrest_distance)
    --end;
  const TravelSpeed speed = clog::travel_speed(std::span(samples_).first(end));
  return speed.mean * speed.time < shortest_travel ? TravelSpeed() : speed;
}

}  // namespace clog
