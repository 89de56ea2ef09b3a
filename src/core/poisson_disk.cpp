#include <algorithm>
#include <array>
#include <boost/random/uniform_01.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <sstream>
#include <vector>

#include "clog/core/error.hpp"
#include "clog/core/obstacle_array.hpp"

namespace clog {
namespace {

/// Random sequential addition of points at least `distance` apart in a periodic square.
///
/// Darts are thrown in rounds. Within a round they are generated, stored and tested cell by cell, so that
/// memory is walked in order; each carries a random time, and a dart is accepted when no accepted dart of an
/// earlier time is too near. The outcome is that of throwing them one after the other in the order of their
/// times. After each round, only squares that still have room are aimed at, a quarter as large as before.
class SequentialAddition {
 public:
  SequentialAddition(double box, double distance, std::uint32_t seed)
      : distance2_(static_cast<float>(distance * distance * (1 + rounding))),
        cells_per_side_(static_cast<int>(std::ceil(box * std::numbers::sqrt2 / distance))),
        cell_size_(box / cells_per_side_),
        point_in_cell_(static_cast<std::size_t>(cells_per_side_) * cells_per_side_),
        first_dart_in_cell_(point_in_cell_.size(), none),
        engine_(make_engine(seed)) {}

  /// Adds points until there are `target` of them or no room is left.
  void fill(std::size_t target) {
    const std::int32_t num_cells = static_cast<std::int32_t>(point_in_cell_.size());
    float size = static_cast<float>(cell_size_);
    std::vector<Square> squares(num_cells);
    for (std::int32_t cell = 0; cell < num_cells; ++cell) squares[cell] = {0, 0, cell};
    while (num_points_ < target && !squares.empty()) {
      throw_round(squares, size, target - num_points_);
      size /= 2;
      squares = quarters_with_room(squares, size);
    }
  }

  std::vector<Obstacle> circles(double radius) const {
    std::vector<Obstacle> circles;
    circles.reserve(num_points_);
    for (std::size_t cell = 0; cell < point_in_cell_.size(); ++cell) {
      const Point& point = point_in_cell_[cell];
      const auto row = static_cast<double>(cell / cells_per_side_);
      const auto column = static_cast<double>(cell % cells_per_side_);
      if (point.taken())
        circles.push_back({column * cell_size_ + point.x, row * cell_size_ + point.y, radius});
    }
    return circles;
  }

 private:
  static constexpr std::int32_t none = -1;
  /// Places are kept in single precision, relative to a cell; this much more distance makes up for the
  /// rounding.
  static constexpr double rounding = 1e-5;
  /// The one point that a cell can hold (its diagonal is not longer than the distance), from the cell's
  /// corner.
  struct Point {
    float x = -1;
    float y = -1;
    bool taken() const { return x >= 0; }
  };
  /// A square that may still have room: its lower left corner from the corner of its cell.
  struct Square {
    float x, y;
    std::int32_t cell;
  };
  enum class Verdict : std::uint8_t { open, accepted, rejected };
  struct Dart {
    float x, y;  // from the cell's corner
    std::int32_t cell;
    std::uint32_t time;
    Verdict verdict;
  };

  float distance2_;
  int cells_per_side_;
  double cell_size_;
  std::size_t num_points_ = 0;
  std::vector<Point> point_in_cell_;
  std::vector<std::int32_t> first_dart_in_cell_;
  std::vector<Dart> darts_;
  std::array<float, 25> near_x_;
  std::array<float, 25> near_y_;
  int num_near_ = 0;
  std::mt19937_64 engine_;
  boost::random::uniform_01<float> uniform_;

  static std::mt19937_64 make_engine(std::uint32_t seed) {
    std::seed_seq sequence{seed,
                           std::uint32_t{0x0b57ac1e}};  // the constant keeps this stream apart from others
    return std::mt19937_64(sequence);
  }

  /// Calls visit(cell, x, y) for the 5 x 5 cells around `cell`, the farthest that a point within the distance
  /// can lie, with the neighbour's corner relative to this cell's, until visit returns true.
  template <class Visit>
  bool any_neighbour(std::int32_t cell, Visit visit) const {
    const int row = cell / cells_per_side_;
    const int column = cell - row * cells_per_side_;
    const auto wrapped = [this](int index) {
      return index + (index < 0) * cells_per_side_ - (index >= cells_per_side_) * cells_per_side_;
    };
    for (int row_step = -2; row_step <= 2; ++row_step) {
      const std::int32_t row_start = wrapped(row + row_step) * cells_per_side_;
      for (int column_step = -2; column_step <= 2; ++column_step)
        if (visit(row_start + wrapped(column + column_step), column_step * cell_size_, row_step * cell_size_))
          return true;
    }
    return false;
  }

  /// Collects the points that may lie within the distance of a place in `cell`. No branch depends on the
  /// random pattern of taken cells: mispredicted ones would cost more than the work itself.
  void look_around(std::int32_t cell) {
    num_near_ = 0;
    any_neighbour(cell, [&](std::int32_t near, double corner_x, double corner_y) {
      const Point& point = point_in_cell_[near];
      near_x_[num_near_] = static_cast<float>(corner_x) + point.x;
      near_y_[num_near_] = static_cast<float>(corner_y) + point.y;
      num_near_ += point.taken();
      return false;
    });
  }

  bool near_a_point(float x, float y) const {
    int num_hits = 0;
    for (int i = 0; i < num_near_; ++i) {
      const float dx = near_x_[i] - x;
      const float dy = near_y_[i] - y;
      num_hits += dx * dx + dy * dy < distance2_;
    }
    return num_hits > 0;
  }

  /// Is the square wholly within the distance of one point?
  bool covered(float x, float y, float size) const {
    const float half = size / 2;
    int num_hits = 0;
    for (int i = 0; i < num_near_; ++i) {
      const float far_x = std::abs(near_x_[i] - x - half) + half;
      const float far_y = std::abs(near_y_[i] - y - half) + half;
      num_hits += far_x * far_x + far_y * far_y < distance2_;
    }
    return num_hits > 0;
  }

  /// One dart for every square on average, at most `most` of them accepted, the earliest ones.
  void throw_round(const std::vector<Square>& squares, float size, std::size_t most) {
    std::vector<std::uint8_t> num_darts(squares.size(), 0);
    boost::random::uniform_int_distribution<std::size_t> pick(0, squares.size() - 1);
    for (std::size_t i = 0; i < squares.size(); ++i) ++num_darts[pick(engine_)];

    darts_.clear();
    std::int32_t cell = none;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const Square& square = squares[i];
      for (int k = 0; k < num_darts[i]; ++k) {
        if (square.cell != cell) look_around(cell = square.cell);
        const float x = square.x + size * uniform_(engine_);
        const float y = square.y + size * uniform_(engine_);
        const auto time = static_cast<std::uint32_t>(engine_());
        if (near_a_point(x, y)) continue;
        if (first_dart_in_cell_[cell] == none)
          first_dart_in_cell_[cell] = static_cast<std::int32_t>(darts_.size());
        darts_.push_back({x, y, cell, time, Verdict::open});
      }
    }
    std::vector<std::int32_t> accepted;
    for (std::int32_t dart = 0; dart < static_cast<std::int32_t>(darts_.size()); ++dart)
      if (is_accepted(dart)) accepted.push_back(dart);
    if (accepted.size() > most) {
      std::sort(accepted.begin(), accepted.end(), [this](auto a, auto b) { return precedes(a, b); });
      accepted.resize(most);
    }
    for (const std::int32_t dart : accepted)
      point_in_cell_[darts_[dart].cell] = {darts_[dart].x, darts_[dart].y};
    num_points_ += accepted.size();
    for (const Dart& dart : darts_) first_dart_in_cell_[dart.cell] = none;
  }

  bool precedes(std::int32_t a, std::int32_t b) const {
    return darts_[a].time != darts_[b].time ? darts_[a].time < darts_[b].time : a < b;
  }

  /// Recursion follows strictly earlier darts, a short chain.
  bool is_accepted(std::int32_t index) {
    Dart& dart = darts_[index];
    if (dart.verdict == Verdict::open) {
      const bool rejected = any_neighbour(dart.cell, [&](std::int32_t near, double corner_x,
                                                         double corner_y) {
        for (std::int32_t other = first_dart_in_cell_[near];
             other != none && other < static_cast<std::int32_t>(darts_.size()) && darts_[other].cell == near;
             ++other) {
          const float dx = static_cast<float>(corner_x) + darts_[other].x - dart.x;
          const float dy = static_cast<float>(corner_y) + darts_[other].y - dart.y;
          if (dx * dx + dy * dy < distance2_ && darts_[other].verdict != Verdict::rejected &&
              precedes(other, index) && is_accepted(other))
            return true;
        }
        return false;
      });
      dart.verdict = rejected ? Verdict::rejected : Verdict::accepted;
    }
    return dart.verdict == Verdict::accepted;
  }

  std::vector<Square> quarters_with_room(const std::vector<Square>& squares, float size) {
    std::vector<Square> quarters;
    std::int32_t cell = none;
    for (const Square& square : squares) {
      if (point_in_cell_[square.cell].taken()) continue;
      if (square.cell != cell) look_around(cell = square.cell);
      if (covered(square.x, square.y, 2 * size)) continue;
      for (int quarter = 0; quarter < 4; ++quarter) {
        const float x = square.x + static_cast<float>(quarter & 1) * size;
        const float y = square.y + static_cast<float>(quarter >> 1) * size;
        if (!covered(x, y, size)) quarters.push_back({x, y, cell});
      }
    }
    return quarters;
  }
};

}  // namespace

ObstacleArray sample_obstacles(const ObstacleParameters& parameters, std::uint32_t seed) {
  SequentialAddition addition(parameters.box, parameters.diameter + parameters.gap, seed);
  std::size_t target = SIZE_MAX;
  if (parameters.density)
    target = static_cast<std::size_t>(std::llround(*parameters.density * parameters.box * parameters.box));
  addition.fill(target);

  std::vector<Obstacle> obstacles = addition.circles(parameters.diameter / 2);
  if (parameters.density && obstacles.size() < target) {
    std::ostringstream message;
    message << "invalid obstacle-density=" << *parameters.density << " (no more than "
            << static_cast<double>(obstacles.size()) / (parameters.box * parameters.box)
            << " obstacles per sigma^2 of diameter " << parameters.diameter << " fit with gap "
            << parameters.gap << ") use a lower density, a smaller gap, or obstacle-density=saturated";
    throw Error(message.str());
  }
  return ObstacleArray(parameters.box, std::move(obstacles));
}

}  // namespace clog
