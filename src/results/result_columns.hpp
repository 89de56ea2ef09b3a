#pragma once

#include <functional>
#include <string>
#include <vector>

#include "clog/results/groups.hpp"

namespace clog::results {

/// A column of results in the printed table.
struct ResultColumn {
  std::string name;
  std::function<std::string(const Group&)> cell;
};

/// A clogging length with its interval; without clogs, a lower bound. A dash replaces an unknown number.
std::string length_text(const fit::CloggingLength& clogging);
std::string interval_text(const fit::CloggingLength& clogging);

/// The columns of the scene's results.
/// @param groups  not empty
/// @param has_laboratory  whether columns in laboratory units follow. The speeds in those columns are of all
/// runs.
std::vector<ResultColumn> columns_of_findings(const std::vector<Group>& groups, double confidence,
                                              bool has_laboratory);

/// The mechanisms that some clogs of these groups have.
std::vector<const CauseText*> mechanisms_of_clogs(const std::vector<Group>& groups);
/// Whether the table has a column of mechanisms. It does if clogs differ in their mechanisms, or if there are
/// clogs and some runs have been excluded.
bool are_mechanisms_shown(const std::vector<Group>& groups);
bool have_some_broken(const std::vector<Group>& groups);

/// Whether any group has a laboratory and lengths to convert.
bool have_laboratory(const std::vector<Group>& groups);
/// Whether all groups have a laboratory, with the same units.
bool have_one_scale(const std::vector<Group>& groups);
/// A group's interfacial tension, clogging length, speed and time until a clog in laboratory units.
std::vector<Field> laboratory_fields(const Group& group);
/// The laboratory_fields() as printed columns.
std::vector<ResultColumn> laboratory_columns(const std::vector<Group>& groups, double confidence);
/// Columns of diameter and tilt, if the groups differ in them.
std::vector<ResultColumn> droplet_columns(const std::vector<Group>& groups);

}  // namespace clog::results
