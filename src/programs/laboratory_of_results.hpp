#pragma once

#include <optional>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/results/distance_table.hpp"
#include "clog/results/groups.hpp"

namespace clog::programs {

/// Gives each group the scale of the laboratory of --lab or, without --lab, of the group's own laboratory.
/// @throws Error
void set_scales(const cli::CommandLine& line, std::vector<results::Group>& groups);

/// The scale of the laboratory of --lab or, without --lab, of each laboratory of these rows; empty if some
/// row has no laboratory. @throws Error
results::ScalesByLaboratory scales_of_rows(const cli::CommandLine& line,
                                           const std::vector<sweep::RunRow>& rows);

/// The droplet's diameter in mm, from the laboratory of --lab or, without --lab, from the common laboratory
/// of all rows; nullopt without --lab and without a common laboratory. @throws Error
std::optional<double> sigma_in_mm(const cli::CommandLine& line, const std::vector<sweep::RunRow>& rows);

}  // namespace clog::programs
