#pragma once

#include <optional>
#include <string>

#include "clog/campaign/group_table.hpp"
#include "clog/cli/command_line.hpp"
#include "clog/store/run_table.hpp"

namespace clog::programs {

/// Sets the keys that the file of --lab determines, if there is one. @throws Error
void use_laboratory(cli::CommandLine& line);

/// @throws Error  if there is a file of --lab, and circles are drawn for a droplet of another diameter
void refuse_other_droplets(const cli::CommandLine& line);

/// The scale from --lab, or else from the sweep's own laboratory; nothing without either.
/// @param path  of the sweep
std::optional<campaign::LaboratoryScale> laboratory_scale(const cli::CommandLine& line,
                                                          const store::SweepFile& sweep,
                                                          const std::string& path);

}  // namespace clog::programs
