#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "clog/campaign/groups.hpp"
#include "clog/fit/curve_features.hpp"
#include "clog/fit/fitted_curve.hpp"

/// Fitted curves of a sweep: lambda over one or two of the parameters that it varies.
namespace clog::campaign {

/// The keys that a curve is drawn over, one or two, as columns of the table.
using CurveKeys = std::vector<const sweep::Column*>;

/// Reads names of keys or columns, separated by commas; without any, takes the one physical parameter that
/// varies.
/// @throws Error if a name is no such key, does not vary, or has values without a logarithm; or if there is
/// no name and several vary
CurveKeys curve_keys(std::span<const Group> groups, const std::string& names);

/// A curve of the clogs by one mechanism, all others being censored.
struct CurveByCause {
  const CauseText* text;
  double num_clogs;
  std::vector<fit::CurveValue> values;
};

/// One curve: the groups that differ in the keys only.
struct FittedCurve {
  std::vector<std::size_t> groups;  ///< indices of those with runs, by their place
  std::vector<Field> shared;        ///< what tells this curve from the others
  std::vector<fit::CurvePlace> places;
  std::vector<fit::CurveValue> values;
  fit::CurvePeak peak;
  std::vector<std::vector<fit::CurveCrossing>> crossings;  ///< of each length that is asked for
  std::vector<CurveByCause> causes;  ///< that occur; none if some clogs are of unknown mechanism
  /// Runs of the same seed at several points met the same obstacles, so the errors of these points are
  /// correlated (common random numbers), though the band takes them for independent.
  bool has_common_obstacles = false;
};

/// What curves are asked for.
struct CurveQuestion {
  CurveKeys keys;
  double confidence = 0.95;
  std::vector<double> crossed_lengths;  ///< [sigma]; only of curves of one key
};

/// A place of a curve: the logarithms of the keys of a group.
fit::CurvePlace curve_place(const Group& group, const CurveKeys& keys);
/// A curve for every set of the other parameters that has two values of each key. Groups without runs, or
/// without a way, say nothing.
/// @throws Error if there is no such set
std::vector<FittedCurve> fit_curves(std::span<const Group> groups, const CurveQuestion& question);

}  // namespace clog::campaign
