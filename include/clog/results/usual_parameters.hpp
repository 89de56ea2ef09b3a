#pragma once

#include <vector>

#include "clog/results/groups.hpp"

namespace clog::results {

/// The default parameter_values() of a run with this model and preset; for a parameter that has its automatic
/// value in the row, this value. Empty if the row's parameters are impossible.
std::vector<Value> usual_parameters(const sweep::RunRow& row);

/// Whether this value is what `auto` gives for the row's other parameters, or what its preset sets.
bool is_automatic(const sweep::Column& column, const sweep::RunRow& row);

/// The value by which a column separates curves and comparisons: unset if it is automatic or follows from the
/// array; for springs to the rest length the ratio K_l/Gamma of `perimeter-stiffness-ratio`.
Value separating_value(const sweep::Column& column, const sweep::RunRow& row);

}  // namespace clog::results
