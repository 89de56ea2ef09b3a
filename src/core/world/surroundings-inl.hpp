/// The points around a cell, for discs of one size; part of poisson_disk.cpp.

#if defined(CLOG_SURROUNDINGS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOG_SURROUNDINGS
#undef CLOG_SURROUNDINGS
#else
#define CLOG_SURROUNDINGS
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
// NOLINTBEGIN(misc-definitions-in-headers): part of one source, compiled for each instruction set
namespace clog::HWY_NAMESPACE {
namespace {

/// Coordinates have single precision, relative to a cell; this additional distance allows for the rounding
/// errors.
constexpr double rounding = 1e-5;
constexpr float nowhere = 1e6;

struct Point {
  float x, y;  // relative to the corner of the point's cell
};

// All functions with vector arguments are inlined, so the warning about their calling convention does not
// apply.
#pragma GCC diagnostic ignored "-Wpsabi"
constexpr int lanes = 8;
using Floats [[gnu::vector_size(lanes * sizeof(float))]] = float;
using Integers [[gnu::vector_size(lanes * sizeof(float))]] = std::int32_t;

/// The points around a cell, for discs of one size. No branch depends on which cells contain a point: this
/// pattern is random, and mispredicted branches would cost more than the work itself.
struct Surroundings {
  const Point* cell;
  std::ptrdiff_t row_length;
  float cell_size;
  float distance2;

  /// Smallest size of a cell as a fraction of the distance between points. With this size, a search from the
  /// lower half of a cell has to cover two cells downwards and one cell upwards.
  static constexpr double smallest_cell = 1 / 1.49;

  /// Whether a point is within the distance of a place in the cell.
  bool reach(float place_x, float place_y) const {
    Integers is_near{};
    visit_points(place_x, place_y, [&](const Floats& x, const Floats& y) {
      const Floats dx = x - place_x;
      const Floats dy = y - place_y;
      is_near |= dx * dx + dy * dy < distance2;
    });
    return any(is_near) != 0;
  }

  /// Finds the quarters of a square in the cell that are completely within the distance of one point. `size`
  /// is the size of a quarter. The result has one bit for each quarter, first along x, then along y.
  std::int32_t cover_quarters(float square_x, float square_y, float size) const {
    const float half = size / 2;
    const auto far2 = [half](const Floats& from_corner) {
      const Floats far = absolute(from_corner - half) + half;
      return far * far;
    };
    Integers is_covered{};
    visit_points(square_x, square_y, [&](const Floats& x, const Floats& y) {
      const Floats x0 = far2(x - square_x), x1 = far2(x - (square_x + size));
      const Floats y0 = far2(y - square_y), y1 = far2(y - (square_y + size));
      is_covered |= ((x0 + y0 < distance2) & 1) | ((x1 + y0 < distance2) & 2) | ((x0 + y1 < distance2) & 4) |
                    ((x1 + y1 < distance2) & 8);
    });
    return any(is_covered);
  }

 private:
  static Floats absolute(const Floats& values) {
    return reinterpret_cast<Floats>(reinterpret_cast<Integers>(values) & 0x7fffffff);
  }

  static std::int32_t any(const Integers& values) {
    std::int32_t bits = 0;
    for (int lane = 0; lane < lanes; ++lane) bits |= values[lane];
    return bits;
  }

  /// Calls visit(x, y) for the points that can be within the distance of a place in the same quarter of the
  /// cell, for 2 rows of 4 cells at a time. x and y are relative to the cell's corner.
  template <class Visit>
  void visit_points(float place_x, float place_y, Visit visit) const {
    const int first_column = -1 - static_cast<int>(place_x < cell_size / 2);
    const int first_row = -1 - static_cast<int>(place_y < cell_size / 2);
    // Points are visited in the order of their lanes in a vector.
    const Floats columns = Floats{0, 1, 0, 1, 2, 3, 2, 3} + static_cast<float>(first_column);
    const Floats rows = Floats{0, 0, 1, 1, 0, 0, 1, 1} + static_cast<float>(first_row);
    const Point* points = cell + first_row * row_length + first_column;
    for (int row = 0; row < 4; row += 2) {
      Floats lower, upper;
      std::memcpy(&lower, points + row * row_length, sizeof lower);
      std::memcpy(&upper, points + (row + 1) * row_length, sizeof upper);
      const Floats x = __builtin_shufflevector(lower, upper, 0, 2, 8, 10, 4, 6, 12, 14);
      const Floats y = __builtin_shufflevector(lower, upper, 1, 3, 9, 11, 5, 7, 13, 15);
      visit(x + columns * cell_size, y + (rows + static_cast<float>(row)) * cell_size);
    }
  }
};

}  // namespace
}  // namespace clog::HWY_NAMESPACE
// NOLINTEND(misc-definitions-in-headers)
HWY_AFTER_NAMESPACE();
#endif
