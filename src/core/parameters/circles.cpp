#include "clog/core/parameters/circles.hpp"

#include <span>
#include <utility>

#include "clog/core/tools/check_sum64.hpp"
#include "clog/core/tools/error.hpp"

namespace clog {
namespace {

std::uint64_t check_sum_of(const std::vector<Obstacle>& circles) {
  static_assert(sizeof(Obstacle) == 3 * sizeof(double));
  return check_sum64(std::as_bytes(std::span(circles)));
}

}  // namespace

OwnCircles::OwnCircles(std::vector<Obstacle> circles, std::string source, std::optional<double> droplet)
    : check_sum_(check_sum_of(circles)),
      circles_(std::make_shared<const std::vector<Obstacle>>(std::move(circles))),
      source_(std::move(source)),
      droplet_(droplet) {}

OwnCircles OwnCircles::from_check_sum(std::string_view text) {
  const std::optional<std::uint64_t> sum = from_hexadecimal(text);
  if (!sum) throw Error("is no checksum of circles");
  return OwnCircles(*sum);
}

std::string OwnCircles::check_sum() const { return hexadecimal(check_sum_); }

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
