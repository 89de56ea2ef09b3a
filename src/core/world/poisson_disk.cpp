#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "clog/core/tools/error.hpp"
#include "clog/core/world/jamming.hpp"
#include "clog/core/world/obstacle_array.hpp"
#include "core/tools/portable_exponential.hpp"
#include "core/tools/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/world/poisson_disk.cpp"
#include <hwy/foreach_target.h>
// The code uses no vector types of Highway; Highway compiles it for each of its targets.
#include "core/world/surroundings-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clog::HWY_NAMESPACE {
namespace {

// This code is compiled without fused multiply-adds, so that every instruction set gives the same array.

/// Random sequential addition of discs with a smallest gap between surfaces, in a period.
///
/// Place and radius of each proposed disc are random; a disc without room is discarded. A disc is a point in
/// three dimensions: the two coordinates of its place, and the `excess` of its radius over the smallest
/// radius. If all discs have one size, the excess is 0.
///
/// In every round, independent Poisson processes propose discs in all squares that may still have room. At
/// first these squares are the cells of a grid. Discs are proposed square by square, in the order of memory.
/// Discs that have room among the points of earlier rounds are then tried in random order. After each round,
/// squares without room are dropped, and the others are cut into quarters. A square has a range of excesses;
/// the range is halved when it exceeds the square's width. A square counts as having room if the smallest
/// disc of its range has room, so no acceptable disc is excluded.
class SequentialAddition {
 public:
  /// @param distance  between the centres of two of the smallest discs
  /// @param largest_excess  largest difference between a radius and the smallest radius
  SequentialAddition(const Period& period, double distance, double largest_excess, std::uint32_t seed)
      : distance_(static_cast<float>(distance)),
        distance2_(static_cast<float>(distance * distance * (1 + rounding))),
        num_rows_(static_cast<int>(std::ceil(period.box * std::numbers::sqrt2 / distance))),
        num_columns_(period.boxes * num_rows_),
        cell_size_(period.box / num_rows_),
        margin_(static_cast<int>(std::ceil((distance + 2 * largest_excess) / cell_size_))),
        row_length_(num_columns_ + 2 * margin_),
        are_alike_(largest_excess == 0 && cell_size_ > Surroundings::smallest_cell * distance),
        points_(static_cast<std::size_t>(num_rows_ + 2 * margin_) * row_length_, Point{nowhere, nowhere}),
        excess_(are_alike_ ? 0 : points_.size(), 0.0F),
        size_(static_cast<float>(cell_size_)),
        range_(static_cast<float>(largest_excess)),
        engine_(make_engine(seed)) {
    const auto width = 2 * static_cast<std::size_t>(margin_) + 1;
    const std::size_t num_cells_around = width * width;
    for (std::vector<float>* near : {&near_x_, &near_y_, &near_excess_}) near->resize(num_cells_around + 1);
  }

  /// Adds points until there are `target` points or no room is left.
  [[gnu::flatten]] void fill(std::size_t target) {
    for (const double darts_per_cell : first_rounds) {
      for (int row = 0; row < num_rows_; ++row)
        throw_darts(num_columns_, darts_per_cell, [&](int column) { return whole(cell_at(row, column)); });
      take_up_darts(target);
    }
    std::vector<Squares> rows(num_rows_);
    bool is_first = true;
    for (std::size_t num_squares = 1; num_points_ < target && num_squares > 0; is_first = false) {
      halve();
      num_squares = 0;
      for (int row = 0; row < num_rows_; ++row) {
        Squares& squares = rows[row];
        make_space_for_parts(is_first ? num_columns_ : squares.size());
        if (is_first)
          for (int column = 0; column < num_columns_; ++column) add_parts(whole(cell_at(row, column)));
        else
          for (std::size_t i = 0; i < squares.size(); ++i) add_parts(squares[i]);
        squares.assign(std::span(parts_).first(num_parts_), range_ > 0);
        num_squares += squares.size();
        throw_darts(static_cast<int>(squares.size()), darts_per_square, [&](int i) { return squares[i]; });
      }
      take_up_darts(target);
    }
    darts_ = std::vector<Square>();
  }

  std::vector<Obstacle> circles(double smallest_radius) const {
    std::vector<Obstacle> circles;
    circles.reserve(num_points_);
    for (int row = 0; row < num_rows_; ++row)
      for (int column = 0; column < num_columns_; ++column) {
        const Cell cell = cell_at(row, column);
        if (is_taken(cell))
          circles.push_back({column * cell_size_ + points_[cell].x, row * cell_size_ + points_[cell].y,
                             smallest_radius + (excess_.empty() ? 0 : excess_[cell])});
      }
    return circles;
  }

 private:
  /// Numbers of darts (proposed discs) per cell in the first rounds. The numbers are small, because at first
  /// most darts have room. They affect only the speed, not the statistics.
  static constexpr double first_rounds[] = {0.125, 0.25, 0.5, 1, 0.5};
  static constexpr double darts_per_square = 1;  // number of darts per square in later rounds
  /// Number of a cell in the grid. The margins of the grid repeat the opposite side.
  using Cell = std::int32_t;
  /// A square that may still have room, or a dart. It has a place, measured from the corner of its cell, and
  /// an excess: the low end of the square's range of excesses, or that of the dart.
  struct Square {
    float x, y, excess;
    Cell cell;
  };

  /// The squares between two rounds. To save memory, excesses are stored only for discs of several sizes.
  class Squares {
   public:
    void assign(std::span<const Square> squares, bool have_excess) {
      // The memory is reused, because the number of squares decreases.
      places_.clear();
      places_.reserve(squares.size());
      for (const Square& square : squares) places_.push_back({square.x, square.y, square.cell});
      excess_.clear();
      if (!have_excess) return;
      excess_.reserve(squares.size());
      for (const Square& square : squares) excess_.push_back(square.excess);
    }
    std::size_t size() const { return places_.size(); }
    Square operator[](std::size_t i) const {
      const Place& place = places_[i];
      return {place.x, place.y, excess_.empty() ? 0 : excess_[i], place.cell};
    }

   private:
    struct Place {
      float x, y;
      Cell cell;
    };
    std::vector<Place> places_;
    std::vector<float> excess_;
  };

  float distance_;
  float distance2_;
  int num_rows_;
  int num_columns_;
  double cell_size_;
  int margin_;  // number of cells to the farthest point within the largest distance
  int row_length_;
  bool are_alike_;  // whether all discs have the same size, as usual
  /// The points, each relative to the corner of its cell. A cell has at most one point, because its diagonal
  /// is not longer than the smallest distance between two points.
  std::vector<Point> points_;
  std::vector<float> excess_;
  std::size_t num_points_ = 0;
  float size_;          // size of the squares
  float range_;         // range of the squares' excesses
  int num_layers_ = 1;  // number of layers of excesses into which a square was cut
  std::vector<Square> parts_;
  std::ptrdiff_t num_parts_ = 0;
  std::vector<Square> arriving_, darts_;
  std::vector<float> near_x_, near_y_, near_excess_;
  int num_near_ = 0;
  Cell near_cell_ = -1;
  boost::random::mt19937_64 engine_;
  boost::random::exponential_distribution<double> exponential_;

  static boost::random::mt19937_64 make_engine(std::uint32_t seed) {
    // The constant makes these numbers independent of other random numbers with the same seed.
    std::seed_seq sequence{seed, std::uint32_t{0x0b57ac1e}};
    return boost::random::mt19937_64(sequence);
  }

  Cell cell_at(int row, int column) const { return (row + margin_) * row_length_ + column + margin_; }

  bool is_taken(Cell cell) const { return points_[cell].x != nowhere; }

  Surroundings around(Cell cell) const {
    return {&points_[cell], row_length_, static_cast<float>(cell_size_), distance2_};
  }

  static Square whole(Cell cell) { return {0, 0, 0, cell}; }

  /// A uniform number in [0, 1), from 24 bits.
  static float uniform(std::uint64_t bits) {
    return 0x1p-24F * static_cast<float>(static_cast<int>(bits & 0xffffff));
  }

  /// Square of the smallest distance between the centres of two discs: (distance + both excesses)^2.
  float reach2(float both_excesses) const {
    constexpr auto widened = static_cast<float>(1 + rounding);
    return distance2_ + widened * both_excesses * (2 * distance_ + both_excesses);
  }

  bool has_room(const Square& dart) const {
    if (are_alike_) return !around(dart.cell).reach(dart.x, dart.y);
    const auto cell_size = static_cast<float>(cell_size_);
    bool is_near = false;
    for (int row = -margin_; row <= margin_; ++row)
      for (int column = -margin_; column <= margin_; ++column) {
        const Cell cell = dart.cell + row * row_length_ + column;
        const float dx = points_[cell].x + static_cast<float>(column) * cell_size - dart.x;
        const float dy = points_[cell].y + static_cast<float>(row) * cell_size - dart.y;
        is_near |= dx * dx + dy * dy < reach2(excess_[cell] + dart.excess);
      }
    return !is_near;
  }

  /// Adds darts of a Poisson process in the squares, and keeps the darts that have room so far.
  /// @param square_at  (index) -> Square
  template <class SquareAt>
  void throw_darts(int num_squares, double darts_each, SquareAt square_at) {
    const double spacing = 1 / darts_each;
    arriving_.clear();
    double place = spacing * exponential_(engine_);
    while (place < num_squares) {
      Square dart = square_at(static_cast<int>(place));
      const std::uint64_t bits = engine_();
      dart.x += size_ * uniform(bits);
      dart.y += size_ * uniform(bits >> 24);
      if (range_ > 0) dart.excess += range_ * uniform(engine_());
      arriving_.push_back(dart);
      place += spacing * exponential_(engine_);
    }
    auto kept = arriving_.begin();
    for (const Square dart : arriving_) {  // without a branch, see Surroundings
      *kept = dart;
      kept += has_room(dart);
    }
    darts_.insert(darts_.end(), arriving_.begin(), kept);
  }

  /// Tries the darts one after the other in random order.
  void take_up_darts(std::size_t target) {
    for (std::size_t i = 0; i < darts_.size(); ++i) {
      boost::random::uniform_int_distribution<std::size_t> other(i, darts_.size() - 1);
      std::swap(darts_[i], darts_[other(engine_)]);
    }
    for (std::size_t i = 0; i < darts_.size() && num_points_ < target; ++i) {
      constexpr std::size_t ahead = 8;  // random access is slow, so cells are loaded in advance
      if (i + ahead < darts_.size()) prefetch_around(darts_[i + ahead].cell);
      if (has_room(darts_[i])) add_point(darts_[i]);
    }
    darts_.clear();
    near_cell_ = -1;
  }

  void prefetch_around(Cell cell) const {
    for (int row = -margin_; row <= margin_; ++row)
      for (const int column : {-margin_, margin_})
        __builtin_prefetch(&points_[cell + row * row_length_ + column]);
  }

  void add_point(const Square& dart) {
    const int row = dart.cell / row_length_ - margin_;
    const int column = dart.cell % row_length_ - margin_;
    const auto on_grid = [&](int index, int num) { return index >= -margin_ && index < num + margin_; };
    for (const int image_row : {row - num_rows_, row, row + num_rows_}) {
      if (!on_grid(image_row, num_rows_)) continue;
      for (const int image_column : {column - num_columns_, column, column + num_columns_}) {
        if (!on_grid(image_column, num_columns_)) continue;
        const Cell cell = cell_at(image_row, image_column);
        points_[cell] = {dart.x, dart.y};
        if (!excess_.empty()) excess_[cell] = dart.excess;
      }
    }
    ++num_points_;
  }

  /// Collects the points that may be too close to a place in `cell`.
  void look_around(Cell cell) {
    const auto cell_size = static_cast<float>(cell_size_);
    int num_near = 0;
    for (int row = -margin_; row <= margin_; ++row)
      for (int column = -margin_; column <= margin_; ++column) {
        const Cell near = cell + row * row_length_ + column;
        near_x_[num_near] = points_[near].x + static_cast<float>(column) * cell_size;
        near_y_[num_near] = points_[near].y + static_cast<float>(row) * cell_size;
        near_excess_[num_near] = excess_[near];
        num_near += is_taken(near);  // without a branch, see Surroundings
      }
    num_near_ = num_near;
  }

  /// Computes the new size of the squares and their new range of excesses, for add_parts().
  void halve() {
    size_ /= 2;
    num_layers_ = range_ > size_ ? 2 : 1;
    range_ /= static_cast<float>(num_layers_);
  }

  void make_space_for_parts(std::size_t num_squares) {
    parts_.resize(std::max(parts_.size(), 4 * num_squares * num_layers_));
    num_parts_ = 0;
  }

  /// Adds the quarters of a square, in each layer of excesses, that are not completely within the distance of
  /// one point. For squares as small as the resolution of numbers, the distances agree with those of
  /// has_room() to the last bit. So such a square either has room or is dropped.
  void add_parts(const Square& square) {
    if (is_taken(square.cell)) return;
    if (are_alike_) {
      const std::int32_t covered = around(square.cell).cover_quarters(square.x, square.y, size_);
      for (int quarter = 0; quarter < 4; ++quarter)
        add_quarter(square, quarter, 0, (covered >> quarter & 1) == 0);
      return;
    }
    if (square.cell != near_cell_) look_around(near_cell_ = square.cell);
    using Quarters = Eigen::Array4f;
    const Quarters x = square.x + size_ * Quarters(0, 1, 0, 1);
    const Quarters y = square.y + size_ * Quarters(0, 0, 1, 1);
    const float half = size_ / 2;
    for (int layer = 0; layer < num_layers_; ++layer) {
      const float excess = square.excess + static_cast<float>(layer) * range_;
      Quarters slack = Quarters::Constant(nowhere);
      for (int i = 0; i < num_near_; ++i) {
        const Quarters far_x = (near_x_[i] - x - half).abs() + half;
        const Quarters far_y = (near_y_[i] - y - half).abs() + half;
        slack = slack.min(far_x * far_x + far_y * far_y - reach2(near_excess_[i] + excess));
      }
      for (int quarter = 0; quarter < 4; ++quarter) add_quarter(square, quarter, excess, slack[quarter] >= 0);
    }
  }

  void add_quarter(const Square& square, int quarter, float excess, bool has_room) {
    parts_[num_parts_] = {square.x + size_ * static_cast<float>(quarter & 1),
                          square.y + size_ * static_cast<float>(quarter >> 1), excess, square.cell};
    num_parts_ += has_room;  // without a branch, see Surroundings
  }
};

}  // namespace

/// Adds at most `target` discs, then releases the memory that the search needed.
std::vector<Obstacle> add_circles(const ObstacleParameters& parameters, std::size_t target,
                                  std::uint32_t seed) {
  const double smallest = parameters.smallest_diameter();
  SequentialAddition addition(parameters.period(), smallest + parameters.gap,
                              parameters.diameter_spread * parameters.diameter, seed);
  addition.fill(target);
  return addition.circles(smallest / 2);
}

}  // namespace clog::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clog {

HWY_EXPORT(add_circles);

ObstacleArray sample_obstacles(const ObstacleParameters& parameters, std::uint32_t seed) {
  std::size_t target = SIZE_MAX;
  const std::optional<double> density = wanted_density(parameters);
  if (density) target = static_cast<std::size_t>(std::llround(*density * parameters.period().area()));
  std::vector<Obstacle> obstacles = HWY_DYNAMIC_DISPATCH(add_circles)(parameters, target, seed);
  if (density && obstacles.size() < target) {
    const double reached = static_cast<double>(obstacles.size()) / parameters.period().area();
    const std::string largest =
        parameters.diameter_spread > 0 ? fmt::format(" to {:.6g}", parameters.largest_diameter()) : "";
    throw Error(
        fmt::format("invalid obstacle-density={:.6g} (no more than {:.6g} obstacles per sigma^2 of diameter "
                    "{:.6g}{} fit with gap "
                    "{:.6g}) use a lower density, a smaller gap, or obstacle-density=saturated",
                    *density, reached, parameters.smallest_diameter(), largest, parameters.gap));
  }
  return {parameters.period(), std::move(obstacles)};
}

}  // namespace clog
#endif
