#pragma once

#include <vector>

#include "clog/results/groups.hpp"
#include "result_columns.hpp"

namespace clog::results {

/// Has any group a laboratory, and are there lengths to convert?
bool have_laboratory(const std::vector<Group>& groups);
/// A group's interfacial tension, clogging length, speed and time until a clog in laboratory units.
std::vector<Field> laboratory_fields(const Group& group);
/// The same for people.
std::vector<ResultColumn> laboratory_columns(const std::vector<Group>& groups);

}  // namespace clog::results
