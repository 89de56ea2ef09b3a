#include "clog/cli/obstacle_file.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "clog/core/error.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::cli {
namespace {

std::vector<std::string> split_line(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) {
    const auto first = cell.find_first_not_of(" \t\r");
    const auto last = cell.find_last_not_of(" \t\r");
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return cells;
}

Obstacle parse_obstacle(const std::vector<std::string>& cells, double default_diameter, double box) {
  if (cells.size() < 2 || cells.size() > 3) throw Error("needs x,y or x,y,diameter");
  const double diameter = cells.size() == 3 ? sweep::to_number(cells[2]) : default_diameter;
  const Obstacle obstacle{sweep::to_number(cells[0]), sweep::to_number(cells[1]), diameter / 2};
  if (!(diameter > 0)) throw Error("diameter must be positive");
  if (obstacle.x < 0 || obstacle.x >= box || obstacle.y < 0 || obstacle.y >= box)
    throw Error("lies outside the box; coordinates run from 0 to box=" + sweep::shortest(box));
  return obstacle;
}

}  // namespace

std::vector<Obstacle> read_obstacles(const std::string& path, double default_diameter, double box) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path))
    throw Error("cannot read " + path + " (no such file, or not readable)");
  std::vector<Obstacle> obstacles;
  int line_number = 0;
  for (std::string line; std::getline(file, line);) {
    ++line_number;
    const std::vector<std::string> cells = split_line(line);
    const bool is_blank = line.find_first_not_of(" \t\r") == std::string::npos;
    const bool is_header = line_number == 1 && !cells.empty() && cells[0] == "x";
    if (is_blank || is_header || line.starts_with('#')) continue;
    try {
      obstacles.push_back(parse_obstacle(cells, default_diameter, box));
    } catch (const Error& error) {
      throw Error(path + " line " + std::to_string(line_number) + ": " + error.what());
    }
  }
  if (obstacles.empty()) throw Error(path + " holds no obstacles; lines are x,y[,diameter]");
  return obstacles;
}

void write_obstacles(const std::string& path, const std::vector<Obstacle>& obstacles) {
  std::ofstream file(path);
  file << "x,y,diameter\n";
  for (const Obstacle& obstacle : obstacles)
    file << sweep::shortest(obstacle.x) << ',' << sweep::shortest(obstacle.y) << ','
         << sweep::shortest(2 * obstacle.radius) << '\n';
  file.close();
  if (!file) throw Error("cannot write " + path + "; check the disk and the permissions");
}

}  // namespace clog::cli
