#pragma once

#include <optional>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/results/groups.hpp"

namespace clog::programs {

/// Sets the keys that the file of --lab determines, if there is one. @throws Error
void use_laboratory(cli::CommandLine& line);

/// @throws Error  if there is a file of --lab, and circles are drawn for a droplet of another diameter
void refuse_other_droplets(const cli::CommandLine& line);

/// Gives each group the scale of --lab, or else of its own laboratory. @throws Error
void set_scales(const cli::CommandLine& line, std::vector<results::Group>& groups);

/// The droplet's diameter in mm: that of --lab, or else of the laboratory that all rows have; nothing if
/// neither is there. @throws Error
std::optional<double> sigma_in_mm(const cli::CommandLine& line, const std::vector<sweep::RunRow>& rows);

}  // namespace clog::programs
