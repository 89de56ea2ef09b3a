#pragma once

#include <string>

#include "clog/campaign/seed_rule.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::campaign {

/// What a sweep would do, on the standard output.

/// The tasks, and their number; of more than a thousand the first and the last.
void print_tasks(const sweep::Plan& plan);
/// What its results will be worth less for, as far as that is known beforehand; nothing if nothing is.
void print_limits(const sweep::Plan& plan);
/// How long the sweep takes at most, if no run ends before max-time, and how long is to be expected
/// (sweep_cost()): from what `output` holds of its runs, or, where that is little, from short pieces of some.
/// Then what `output` has of the sweep, and what is left.
/// Returns the exit code: a fault if no run can begin.
/// @param output  the sweep's file, which need not be there; empty: none is named
/// @param rule  of a sweep of which `plan` is the first round: then what the other rounds may add; or nullptr
int print_cost(const sweep::Plan& plan, const std::string& output, const SeedRule* rule);
/// Every key with its value, and what stands behind `auto`.
void print_config(const sweep::Settings& settings, const sweep::Plan& plan);

}  // namespace clog::campaign
