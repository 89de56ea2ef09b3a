#pragma once

#include <cstdint>
#include <optional>

#include "clog/campaign/seed_rule.hpp"
#include "clog/cli/command_line.hpp"
#include "clog/conduct/assignment.hpp"
#include "clog/conduct/lead.hpp"

namespace clog::programs {

/// The options of a sweep, declared and parsed. @throws Error, as all of these do
void parse_sweep_options(cli::CommandLine& line, int argc, const char* const* argv);

/// Checked, the output's name excepted.
conduct::LeadOptions lead_options(const cli::CommandLine& line);
conduct::Assignment assignment(const cli::CommandLine& line, const sweep::Settings& settings);
std::int64_t attempts(const cli::CommandLine& line);
/// The rule by --until-precision and --most-seeds; nothing if the sweep is not to grow.
std::optional<campaign::GrowingSweep> growing_sweep(const cli::CommandLine& line);

}  // namespace clog::programs
