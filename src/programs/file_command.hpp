#pragma once

#include "clog/cli/program.hpp"
#include "clog/store/run_table.hpp"

namespace clog::programs {

/// Parses the command line of a command that uses HDF5. Returns whether there is anything else to do. @throws
/// Error
inline bool parse_file_command(cli::CommandLine& line, int argc, const char* const* argv) {
  return cli::parse_command(line, argc, argv, {{"HDF5", store::library_version()}});
}

/// Provenance of a table that a command makes from other tables.
inline store::Provenance origin_of_table(const cli::CommandLine& line) {
  store::Provenance all = cli::origin(line);
  all.emplace_back("hdf5_version", store::library_version());
  return all;
}

}  // namespace clog::programs
