#pragma once

#include "clog/sweep/plan.hpp"
#include "clog/sweep/settings.hpp"

namespace clog {

/// What a sweep would do, on the standard output.

/// The tasks, and their number; of more than a thousand the first and the last.
void print_tasks(const sweep::Plan& plan);
/// How long the sweep takes at most, from a short piece of the first and the last parameter set: what a step
/// costs per vertex there, times the steps of all runs if none of them ends before max-time.
void print_cost(const sweep::Plan& plan);
/// Every key with its value, and what stands behind `auto`.
void print_config(const sweep::Settings& settings, const sweep::Plan& plan);

}  // namespace clog
