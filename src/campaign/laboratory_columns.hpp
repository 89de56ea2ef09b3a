#pragma once

#include <vector>

#include "clog/campaign/group_table.hpp"
#include "clog/campaign/groups.hpp"
#include "result_columns.hpp"

namespace clog::campaign {

/// A group's interfacial tension, clogging length, speed and time until a clog in laboratory units.
std::vector<Field> laboratory_fields(const Group& group, const LaboratoryScale& scale);
/// The same for people.
std::vector<ResultColumn> laboratory_columns(const std::vector<Group>& groups, const LaboratoryScale& scale);

}  // namespace clog::campaign
