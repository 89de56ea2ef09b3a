#pragma once

#include <cstdint>
#include <optional>

#include "clog/cli/command_line.hpp"
#include "clog/results/preview.hpp"
#include "clog/results/seed_rule.hpp"
#include "clog/scheduler/assignment.hpp"
#include "clog/scheduler/driver.hpp"

namespace clog::programs {

/// Declares and parses the options of a sweep. Returns whether there is anything else to do. @throws Error,
/// as the functions below do
bool parse_sweep_options(cli::CommandLine& line, int argc, const char* const* argv);

/// The options of the driver. All are checked except the name of the output.
scheduler::DriverOptions driver_options(const cli::CommandLine& line);
scheduler::Assignment assignment(const cli::CommandLine& line, const sweep::Settings& settings);
/// The value of --format for --dry-run.
results::PreviewFormat preview_format(const cli::CommandLine& line);
std::int64_t attempts(const cli::CommandLine& line);
/// The rule of --until-precision and --most-seeds; nullopt if the sweep does not grow.
std::optional<results::GrowingSweep> growing_sweep(const cli::CommandLine& line);

}  // namespace clog::programs
