#include "clog/cli/obstacle_file.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "clog/console/csv.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::cli {
namespace {

Obstacle parse_obstacle(const std::vector<std::string>& cells, double default_diameter,
                        const Period& period) {
  if (cells.size() < 2 || cells.size() > 3) throw Error("needs x,y or x,y,diameter");
  const double diameter = cells.size() == 3 ? sweep::to_number(cells[2]) : default_diameter;
  const Obstacle obstacle{sweep::to_number(cells[0]), sweep::to_number(cells[1]), diameter / 2};
  if (!(diameter > 0)) throw Error("diameter must be positive");
  if (diameter >= period.box)
    throw Error("the obstacle meets its own periodic image; diameters are smaller than box=" +
                sweep::shortest(period.box));
  if (obstacle.x < 0 || obstacle.x >= period.along() || obstacle.y < 0 || obstacle.y >= period.across())
    throw Error("lies outside the array; x runs from 0 to boxes*box=" + sweep::shortest(period.along()) +
                ", y from 0 to box=" + sweep::shortest(period.across()));
  return obstacle;
}

struct Lines {
  std::vector<Obstacle> obstacles;
  std::vector<int> numbers;  // of the lines that they are from
};

Lines read_lines(const std::string& path, const ObstacleFileRules& rules) {
  Lines lines;
  console::read_csv(path, [&](int number, const std::vector<std::string>& cells) {
    if (number == 1 && cells[0] == "x") return;  // the header
    lines.obstacles.push_back(parse_obstacle(cells, rules.default_diameter, rules.period));
    lines.numbers.push_back(number);
  });
  if (lines.obstacles.empty()) throw Error(path + " holds no obstacles; lines are x,y[,diameter]");
  return lines;
}

std::string rounded(double value) {
  std::ostringstream out;
  out.precision(3);
  out << value;
  return out.str();
}

/// "3 and 17", the lines of a pair in the order of the file.
std::string line_numbers(const Lines& lines, const ObstacleArray::Pair& pair) {
  std::string numbers;
  for (std::size_t i = 0; i < lines.obstacles.size(); ++i) {
    const Obstacle& obstacle = lines.obstacles[i];
    // Of circles given twice, both lines are found with the first of them.
    if (obstacle == pair.first || obstacle == pair.second)
      numbers += (numbers.empty() ? "" : " and ") + std::to_string(lines.numbers[i]);
  }
  return numbers;
}

void refuse_narrow_gaps(const std::string& path, const Lines& lines, const ObstacleArray& array,
                        double narrowest_gap) {
  const ObstacleArray::Pair pair = array.closest_pair();
  if (pair.gap > std::max(0.0, narrowest_gap)) return;
  const std::string where = path + " lines " + line_numbers(lines, pair) + ": ";
  if (pair.gap <= 0)
    throw Error(where + "the obstacles touch or overlap, by " + rounded(-pair.gap) +
                " sigma (across the border of the box too); move them apart or make them smaller");
  throw Error(where + "the gap of " + rounded(pair.gap) + " sigma is not wider than one vertex, " +
              rounded(narrowest_gap) + " sigma; widen the gap or use more vertices");
}

}  // namespace

ObstacleArray read_obstacles(const std::string& path, const ObstacleFileRules& rules) {
  const Lines lines = read_lines(path, rules);
  ObstacleArray array(rules.period, lines.obstacles);
  refuse_narrow_gaps(path, lines, array, rules.narrowest_gap);
  return array;
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
