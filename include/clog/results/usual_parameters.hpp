#pragma once

#include <vector>

#include "clog/results/groups.hpp"

namespace clog::results {

/// The default parameter_values() of a run with this row's model and preset. For a parameter that may be
/// automatic, the default is the row's value if it is the automatic value, otherwise unset. Empty if the
/// row's parameters are impossible.
std::vector<Value> usual_parameters(const sweep::RunRow& row);

/// Whether the row's value in this column equals the value of `auto` with the row's other parameters, or the
/// value of the row's preset.
bool is_automatic(const sweep::Column& column, const sweep::RunRow& row);

/// The value by which a column separates curves and comparisons. It is unset if the row's value is automatic
/// or follows from the array. For springs to the rest length, it is the ratio K_l/Gamma of
/// `perimeter-stiffness-ratio`.
Value separating_value(const sweep::Column& column, const sweep::RunRow& row);

}  // namespace clog::results
