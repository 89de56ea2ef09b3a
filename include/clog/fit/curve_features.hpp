#pragma once

#include <span>
#include <vector>

#include "clog/fit/clogging_length.hpp"
#include "clog/fit/fitted_curve.hpp"

namespace clog::fit {

/// lambda at one place of a curve [sigma].
struct CurveValue {
  double length;
  Interval band;
};
/// The values at every place of the curve. @throws std::invalid_argument unless 0 < confidence < 1
std::vector<CurveValue> curve_values(const Curve& curve, double confidence);

/// Where a curve is highest.
struct CurvePeak {
  CurvePlace place;        ///< logarithms of the keys, where the mean is highest
  CurvePlace place_lower;  ///< of the interval of each key's logarithm
  CurvePlace place_upper;
  double length;  ///< lambda there [sigma]
  Interval interval;
  double share_inside;  ///< of the curves that the data allow, those that are highest off the borders of the
                        ///< places
};

/// Curves drawn at random from a curve's distribution, the same ones in every call: one in every column.
Eigen::MatrixXd drawn_curves(const Curve& curve, int num_curves);

/// Place and height are those of the mean, the intervals those that hold the places and heights of drawn
/// curves.
/// @param places  of the curve: a line in increasing order, or a rectangular grid
/// @throws std::invalid_argument unless 0 < confidence < 1
CurvePeak find_peak(const Curve& curve, std::span<const CurvePlace> places, double confidence);
/// How likely each place is the highest.
Eigen::VectorXd peak_probabilities(const Curve& curve);

/// Where a curve of one key crosses a value.
struct CurveCrossing {
  double place;       ///< logarithm of the key
  Interval interval;  ///< where the band holds the value; infinite where it still does so at a border
  bool is_upward;     ///< does lambda grow with the key there?
};
/// @param length  lambda to be crossed [sigma]
/// @throws std::invalid_argument unless 0 < confidence < 1
std::vector<CurveCrossing> find_crossings(const Curve& curve, std::span<const CurvePlace> places,
                                          double length, double confidence);

}  // namespace clog::fit
