#pragma once

#include "clog/cli/command_line.hpp"
#include "clog/core/parameters/refusal.hpp"
#include "clog/sweep/points.hpp"

namespace clog::programs {

/// If --lab is given, sets the keys that its file determines, converts the values that were given with units,
/// and scales user-supplied circles to the droplet. @throws Error, for instance if the file has several
/// droplets
void use_laboratory(cli::CommandLine& line);

/// use_laboratory() for a file of one or several droplets. Several droplets become points, each with the
/// texts of one droplet.
/// @param points  the sweep's points, if any; the function combines each point with each droplet
void use_laboratories(cli::CommandLine& line, sweep::Points& points);

/// The refusal with the texts of its keys as the user typed them, and the size of sigma in the laboratory of
/// --lab. The message itself has numbers in units of the model.
Refusal in_typed_units(const cli::CommandLine& line, const Refusal& refusal);

/// Calls body() and rewords its refusals by in_typed_units().
template <class Body>
auto with_typed_units(const cli::CommandLine& line, const Body& body) try {
  return body();
} catch (const Refusal& refusal) {
  throw in_typed_units(line, refusal);
}

}  // namespace clog::programs
