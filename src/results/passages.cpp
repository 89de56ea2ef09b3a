#include "passages.hpp"

#include <algorithm>
#include <cmath>

#include "clog/core/parameters/circles.hpp"
#include "clog/fit/share.hpp"

namespace clog::results {
namespace {

constexpr double round_off = 1e-6;  // [sigma]

/// The x of the rows of posts between entrance and exit: every x at which a post has its centre.
std::vector<double> rows_of_posts(const ObstacleParameters& obstacles) {
  std::vector<double> rows;
  if (!obstacles.own || !obstacles.own->are_known()) return rows;
  for (const Obstacle& circle : obstacles.own->circles())
    if (circle.x > obstacles.entrance && (obstacles.exit == 0 || circle.x < obstacles.exit))
      rows.push_back(circle.x);
  std::ranges::sort(rows);
  const auto is_same_row = [](double one, double other) { return other - one < round_off; };
  rows.erase(std::unique(rows.begin(), rows.end(), is_same_row), rows.end());
  return rows;
}

Passage passage_at(double x, std::span<const Arrival> arrivals, double confidence) {
  Passage passage{.x = x, .num_passed = 0, .num_stopped = 0, .share = {}};
  for (const Arrival& arrival : arrivals) {
    if (arrival.begin > x + round_off) continue;
    if (arrival.x >= x)
      ++passage.num_passed;
    else if (arrival.is_final)
      ++passage.num_stopped;
  }
  passage.share =
      fit::share_interval(passage.num_passed, passage.num_passed + passage.num_stopped, confidence);
  return passage;
}

}  // namespace

std::vector<Passage> passages_of(const RunParameters& device, std::span<const Arrival> arrivals,
                                 std::span<const double> lines, double confidence) {
  std::vector<double> places(lines.begin(), lines.end());
  if (places.empty()) places = rows_of_posts(device.obstacles);
  if (const double exit = device.obstacles.exit; exit > 0) {
    std::erase_if(places, [=](double x) { return std::abs(x - exit) < round_off; });  // the last line
    places.push_back(exit);
  }
  std::vector<Passage> passages;
  passages.reserve(places.size());
  for (const double x : places) passages.push_back(passage_at(x, arrivals, confidence));
  return passages;
}

}  // namespace clog::results
