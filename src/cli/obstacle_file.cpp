#include "clog/cli/obstacle_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <utility>

#include "clog/console/csv.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::cli {
namespace {

Obstacle parse_circle(const std::vector<std::string>& cells) {
  if (cells.size() < 2 || cells.size() > 3) throw Error("needs x,y or x,y,diameter, separated by commas");
  Obstacle circle{sweep::to_number(cells[0]), sweep::to_number(cells[1])};
  if (cells.size() == 2) return circle;
  circle.radius = sweep::to_number(cells[2]) / 2;
  if (!(circle.radius > 0)) throw Error("diameter must be positive");
  return circle;
}

std::string shortened(const std::string& text) {
  constexpr std::size_t longest = 60;
  return text.size() > longest ? text.substr(0, longest) + "..." : text;
}

/// The names of the columns, if the first line has any. @throws Error  if they are others than ours
bool is_header(const std::vector<std::string>& cells) {
  static const std::vector<std::string> names = {"x", "y", "diameter"};
  if (cells[0].empty() || !std::isalpha(static_cast<unsigned char>(cells[0][0]))) return false;
  if (cells.size() < 2 || cells.size() > names.size() ||
      !std::equal(cells.begin(), cells.end(), names.begin()))
    throw Error(
        fmt::format("the columns have to be x,y or x,y,diameter, separated by commas, in droplet "
                    "diameters; here they are '{}'",
                    shortened(joined(cells, ","))));
  return true;
}

}  // namespace

OwnCircles read_circles(const std::string& path) {
  std::vector<Obstacle> circles;
  bool is_first = true;
  console::read_csv(path, [&](int, const std::vector<std::string>& cells) {
    if (!std::exchange(is_first, false) || !is_header(cells)) circles.push_back(parse_circle(cells));
  });
  if (circles.empty()) throw Error(path + " holds no obstacles; lines are x,y[,diameter]");
  return OwnCircles(std::move(circles), path);
}

void write_obstacles(const std::string& path, std::span<const Obstacle> obstacles) {
  std::ofstream file(path);
  file << "x,y,diameter\n";
  for (const Obstacle& obstacle : obstacles)
    file << sweep::shortest(obstacle.x) << ',' << sweep::shortest(obstacle.y) << ','
         << sweep::shortest(2 * obstacle.radius) << '\n';
  file.close();
  if (!file) throw Error("cannot write " + path + "; check the disk and the permissions");
}

}  // namespace clog::cli
