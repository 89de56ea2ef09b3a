#include "clog/core/parameters/circles.hpp"

#include <fmt/core.h>

#include <boost/crc.hpp>
#include <charconv>
#include <utility>

#include "clog/core/tools/error.hpp"

namespace clog {
namespace {

using Crc64Xz =
    boost::crc_optimal<64, 0x42F0E1EBA9EA3693, 0xFFFFFFFFFFFFFFFF, 0xFFFFFFFFFFFFFFFF, true, true>;

std::uint64_t check_sum_of(const std::vector<Obstacle>& circles) {
  static_assert(sizeof(Obstacle) == 3 * sizeof(double));
  Crc64Xz sum;
  sum.process_bytes(circles.data(), circles.size() * sizeof(Obstacle));
  return sum.checksum();
}

}  // namespace

OwnCircles::OwnCircles(std::vector<Obstacle> circles, std::string source, std::optional<double> droplet)
    : check_sum_(check_sum_of(circles)),
      circles_(std::make_shared<const std::vector<Obstacle>>(std::move(circles))),
      source_(std::move(source)),
      droplet_(droplet) {}

OwnCircles OwnCircles::from_check_sum(std::string_view text) {
  std::uint64_t sum = 0;
  const char* end = text.data() + text.size();
  constexpr std::size_t num_digits = 16;
  if (text.size() != num_digits || std::from_chars(text.data(), end, sum, 16).ptr != end)
    throw Error("is no checksum of circles");
  return OwnCircles(sum);
}

std::string OwnCircles::check_sum() const { return fmt::format("{:016x}", check_sum_); }

const std::vector<Obstacle>& OwnCircles::circles() const {
  if (!circles_)
    throw Error("only the checksum " + check_sum() +
                " of the obstacles is known; give the CSV file that they were read from");
  return *circles_;
}

std::vector<Obstacle> OwnCircles::with_radii(double missing) const {
  std::vector<Obstacle> all = circles();
  for (Obstacle& circle : all)
    if (circle.radius == 0) circle.radius = missing;
  return all;
}

}  // namespace clog
