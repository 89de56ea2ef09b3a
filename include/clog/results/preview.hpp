#pragma once

#include <string>

#include "clog/core/parameters/refusal.hpp"
#include "clog/results/seed_rule.hpp"
#include "clog/sweep/job.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::results {

/// Prints on the standard output what a sweep would compute.

/// Text for people, or one line of JSON with the same numbers and with this text as `text`.
enum class PreviewFormat { text, json };

/// Prints the tasks and their number; if there are more than a thousand tasks, only the first and the last
/// ones.
void print_tasks(const sweep::Plan& plan, PreviewFormat format);
/// Prints a refusal of the sweep's settings as a line of JSON.
void print_refusal(const Refusal& refusal);
/// Prints known limits of the results, such as an array that repeats. Then prints an upper bound of the
/// sweep's duration, for which every run lasts to max-time, and an estimate (sweep_cost()). The estimate uses
/// the runs in `output`. If there are too few runs, it uses short trial runs. Then prints the finished and
/// the remaining part of the sweep in `output`. Returns the exit code: a failure if no run can begin.
/// @param output  the sweep's file, which need not exist; empty: no file
/// @param rule  if not null, `plan` is the first round, and the cost of further rounds is printed, too
/// @param jobs  makes the jobs of the trial runs
int print_cost(const sweep::Plan& plan, const std::string& output, const SeedRule* rule,
               const sweep::JobFactory& jobs, PreviewFormat format);
/// Prints every key with its value, and the values of `auto` for the first task.
void print_config(const sweep::Settings& settings, const sweep::Plan& plan);

}  // namespace clog::results
