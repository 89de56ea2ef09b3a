#pragma once

#include <vector>

#include "clog/campaign/groups.hpp"

namespace clog::campaign {

/// The parameter_fields() of these runs as they would be by default: with the row's model and preset, where
/// `auto` stands for what follows from the row's other parameters. Empty if the row's parameters are
/// impossible.
std::vector<Field> usual_parameters(const sweep::RunRow& row);

}  // namespace clog::campaign
