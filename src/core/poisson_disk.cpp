#include <algorithm>
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
#include "clog/core/lattice.hpp"
#include "clog/core/obstacle_array.hpp"

namespace clog {
namespace {

/// Random sequential addition of discs, surfaces at least a gap apart, in a periodic square.
///
/// Each arriving disc draws its place and its radius; one that has no room leaves for good. The space it
/// draws from has three dimensions: the place, and by how much the radius exceeds the smallest one, its
/// `excess`. Discs of one size are the flat case, excess 0.
///
/// Darts are thrown in rounds. Within a round they are generated, stored and tested cell by cell, so that
/// memory is walked in order; each carries a random time, and a dart is accepted when no accepted dart of an
/// earlier time is too near. The outcome is that of throwing them one after the other in the order of their
/// times. After each round, only squares that still have room are aimed at, a quarter as large as before; a
/// square comes with a range of excesses, halved too when it is longer than the square is wide. Room means
/// room for the smallest disc of the range, so nothing that would be accepted is ever left out.
class SequentialAddition {
 public:
  /// @param distance  between the centres of two of the smallest discs
  /// @param largest_excess  of a radius over the smallest one
  SequentialAddition(double box, double distance, double largest_excess, std::uint32_t seed)
      : distance_(static_cast<float>(distance)),
        distance2_(static_cast<float>(distance * distance * (1 + rounding))),
        largest_excess_(static_cast<float>(largest_excess)),
        cells_per_side_(static_cast<int>(std::ceil(box * std::numbers::sqrt2 / distance))),
        cell_size_(box / cells_per_side_),
        cells_in_reach_(static_cast<int>(std::ceil((distance + 2 * largest_excess) / cell_size_))),
        point_in_cell_(static_cast<std::size_t>(cells_per_side_) * cells_per_side_),
        first_dart_in_cell_(point_in_cell_.size(), none),
        engine_(make_engine(seed)) {
    const std::size_t num_cells_around = (2 * cells_in_reach_ + 1) * (2 * cells_in_reach_ + 1);
    for (std::vector<float>* near : {&near_x_, &near_y_, &near_excess_}) near->resize(num_cells_around);
  }

  /// Adds points until there are `target` of them or no room is left.
  void fill(std::size_t target) {
    const std::int32_t num_cells = static_cast<std::int32_t>(point_in_cell_.size());
    float size = static_cast<float>(cell_size_);
    float range = largest_excess_;
    std::vector<Square> squares(num_cells);
    for (std::int32_t cell = 0; cell < num_cells; ++cell) squares[cell] = {0, 0, 0, cell};
    while (num_points_ < target && !squares.empty()) {
      throw_round(squares, size, range, target - num_points_);
      size /= 2;
      const int num_layers = range > size ? 2 : 1;
      range /= static_cast<float>(num_layers);
      squares = parts_with_room(squares, size, range, num_layers);
    }
  }

  std::vector<Obstacle> circles(double smallest_radius) const {
    std::vector<Obstacle> circles;
    circles.reserve(num_points_);
    for (std::size_t cell = 0; cell < point_in_cell_.size(); ++cell) {
      const Point& point = point_in_cell_[cell];
      const auto row = static_cast<double>(cell / cells_per_side_);
      const auto column = static_cast<double>(cell % cells_per_side_);
      if (point.taken())
        circles.push_back(
            {column * cell_size_ + point.x, row * cell_size_ + point.y, smallest_radius + point.excess});
    }
    return circles;
  }

 private:
  static constexpr std::int32_t none = -1;
  /// Places are kept in single precision, relative to a cell; this much more distance makes up for the
  /// rounding.
  static constexpr double rounding = 1e-5;
  /// The one point that a cell can hold (its diagonal is not longer than the smallest distance), from the
  /// cell's corner.
  struct Point {
    float x = -1;
    float y = -1;
    float excess = 0;
    bool taken() const { return x >= 0; }
  };
  /// A square that may still have room: its lower left corner from the corner of its cell, and the low end of
  /// its range of excesses.
  struct Square {
    float x, y, excess;
    std::int32_t cell;
  };
  enum class Verdict : std::uint8_t { open, accepted, rejected };
  struct Dart {
    float x, y, excess;  // place from the cell's corner
    std::int32_t cell;
    std::uint32_t time;
    Verdict verdict;
  };

  float distance_;
  float distance2_;
  float largest_excess_;
  int cells_per_side_;
  double cell_size_;
  int cells_in_reach_;  // how many cells further a point within the largest distance can lie
  std::size_t num_points_ = 0;
  std::vector<Point> point_in_cell_;
  std::vector<std::int32_t> first_dart_in_cell_;
  std::vector<Dart> darts_;
  std::vector<float> near_x_, near_y_, near_excess_;
  int num_near_ = 0;
  std::mt19937_64 engine_;
  boost::random::uniform_01<float> uniform_;

  static std::mt19937_64 make_engine(std::uint32_t seed) {
    std::seed_seq sequence{seed,
                           std::uint32_t{0x0b57ac1e}};  // the constant keeps this stream apart from others
    return std::mt19937_64(sequence);
  }

  /// Square of the distance that two discs must keep, (distance + both excesses)^2.
  float reach2(float both_excesses) const {
    constexpr auto widened = static_cast<float>(1 + rounding);
    return distance2_ + widened * both_excesses * (2 * distance_ + both_excesses);
  }

  /// Calls visit(cell, x, y) for the cells around `cell`, 5 x 5 of them for discs of one size, with the
  /// neighbour's corner relative to this cell's, until visit returns true.
  template <class Visit>
  bool any_neighbour(std::int32_t cell, Visit visit) const {
    const int row = cell / cells_per_side_;
    const int column = cell - row * cells_per_side_;
    const auto wrapped = [this](int index) {
      return index + (index < 0) * cells_per_side_ - (index >= cells_per_side_) * cells_per_side_;
    };
    for (int row_step = -cells_in_reach_; row_step <= cells_in_reach_; ++row_step) {
      const std::int32_t row_start = wrapped(row + row_step) * cells_per_side_;
      for (int column_step = -cells_in_reach_; column_step <= cells_in_reach_; ++column_step)
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
      near_excess_[num_near_] = point.excess;
      num_near_ += point.taken();
      return false;
    });
  }

  bool near_a_point(float x, float y, float excess) const {
    int num_hits = 0;
    for (int i = 0; i < num_near_; ++i) {
      const float dx = near_x_[i] - x;
      const float dy = near_y_[i] - y;
      num_hits += dx * dx + dy * dy < reach2(near_excess_[i] + excess);
    }
    return num_hits > 0;
  }

  /// Is the square wholly within the distance of one point, for discs of this excess or more?
  bool covered(float x, float y, float excess, float size) const {
    const float half = size / 2;
    int num_hits = 0;
    for (int i = 0; i < num_near_; ++i) {
      const float far_x = std::abs(near_x_[i] - x - half) + half;
      const float far_y = std::abs(near_y_[i] - y - half) + half;
      num_hits += far_x * far_x + far_y * far_y < reach2(near_excess_[i] + excess);
    }
    return num_hits > 0;
  }

  /// One dart for every square on average, at most `most` of them accepted, the earliest ones.
  void throw_round(const std::vector<Square>& squares, float size, float range, std::size_t most) {
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
        const float excess = range > 0 ? square.excess + range * uniform_(engine_) : 0;
        const auto time = static_cast<std::uint32_t>(engine_());
        if (near_a_point(x, y, excess)) continue;
        if (first_dart_in_cell_[cell] == none)
          first_dart_in_cell_[cell] = static_cast<std::int32_t>(darts_.size());
        darts_.push_back({x, y, excess, cell, time, Verdict::open});
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
      point_in_cell_[darts_[dart].cell] = {darts_[dart].x, darts_[dart].y, darts_[dart].excess};
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
          if (dx * dx + dy * dy < reach2(darts_[other].excess + dart.excess) &&
              darts_[other].verdict != Verdict::rejected && precedes(other, index) && is_accepted(other))
            return true;
        }
        return false;
      });
      dart.verdict = rejected ? Verdict::rejected : Verdict::accepted;
    }
    return dart.verdict == Verdict::accepted;
  }

  /// Quarters of the squares, in `num_layers` ranges of excesses each.
  std::vector<Square> parts_with_room(const std::vector<Square>& squares, float size, float range,
                                      int num_layers) {
    std::vector<Square> parts;
    std::int32_t cell = none;
    for (const Square& square : squares) {
      if (point_in_cell_[square.cell].taken()) continue;
      if (square.cell != cell) look_around(cell = square.cell);
      if (covered(square.x, square.y, square.excess, 2 * size)) continue;
      for (int part = 0; part < 4 * num_layers; ++part) {
        const float x = square.x + static_cast<float>(part & 1) * size;
        const float y = square.y + static_cast<float>(part >> 1 & 1) * size;
        const float excess = square.excess + static_cast<float>(part >> 2) * range;
        if (!covered(x, y, excess, size)) parts.push_back({x, y, excess, cell});
      }
    }
    return parts;
  }
};

}  // namespace

ObstacleArray sample_obstacles(const ObstacleParameters& parameters, std::uint32_t seed) {
  if (parameters.layout == ObstacleLayout::lattice) return lattice_obstacles(parameters, seed);
  const double smallest = parameters.smallest_diameter();
  SequentialAddition addition(parameters.box, smallest + parameters.gap,
                              parameters.diameter_spread * parameters.diameter, seed);
  std::size_t target = SIZE_MAX;
  if (parameters.density)
    target = static_cast<std::size_t>(std::llround(*parameters.density * parameters.box * parameters.box));
  addition.fill(target);

  std::vector<Obstacle> obstacles = addition.circles(smallest / 2);
  if (parameters.density && obstacles.size() < target) {
    std::ostringstream message;
    message << "invalid obstacle-density=" << *parameters.density << " (no more than "
            << static_cast<double>(obstacles.size()) / (parameters.box * parameters.box)
            << " obstacles per sigma^2 of diameter " << smallest;
    if (parameters.diameter_spread > 0) message << " to " << parameters.largest_diameter();
    message << " fit with gap " << parameters.gap
            << ") use a lower density, a smaller gap, or obstacle-density=saturated";
    throw Error(message.str());
  }
  return ObstacleArray(parameters.box, std::move(obstacles));
}

}  // namespace clog
