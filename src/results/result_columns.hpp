#pragma once

#include <functional>
#include <string>
#include <vector>

#include "clog/results/groups.hpp"

namespace clog::results {

/// A column of results in the table for people.
struct ResultColumn {
  std::string name;
  std::function<std::string(const Group&)> cell;
};

/// The columns of the scene's results. @param groups  not empty
/// @param has_laboratory  columns in its units follow, in which speeds are those of all runs
std::vector<ResultColumn> columns_of_findings(const std::vector<Group>& groups, double confidence,
                                              bool has_laboratory);

/// Whether the table shows the mechanisms: if clogs differ in them, or some are excluded.
bool are_mechanisms_shown(const std::vector<Group>& groups);
bool have_some_broken(const std::vector<Group>& groups);

}  // namespace clog::results
