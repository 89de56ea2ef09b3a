#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clog/store/journal.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::campaign {

/// Rows of several files as those of one sweep. A run that several have is there once: its result rather than
/// where it has come to, and of two that are under way the one that has come farther.
struct Merger {
  store::SweepFile table;
  std::vector<store::Journal::Entry> snapshots;  ///< of unfinished runs
  std::int64_t num_shared = 0;                   ///< runs that several files have
  std::int64_t num_other_bits = 0;  ///< of these, runs with other bits under another instruction set
  std::int64_t num_faulty = 0;      ///< rows with what cannot be, which are left out
};

/// For a file of its own: complete sweeps and stopped ones.
/// @param maker  the program that makes it, as cli::origin() says it
/// @throws Error that names the files and the task, if two rows of a run contradict each other, a file is
/// damaged or being written, or has other circles under the same name
Merger merge(const std::vector<std::string>& paths, const store::Provenance& maker);

/// The rows of several files together, for reading only: also those of running sweeps, and of files whose
/// config cannot be read any more. A single file is returned as it is.
store::SweepFile read_together(const std::vector<std::string>& paths);

/// Tasks get the numbers, and circles the names, that they have in the settings; rows beyond follow at the
/// end.
void number_tasks(const sweep::Settings& settings, store::SweepFile& table);

/// Where the rows of a file made of others come from.
/// @param maker  the program that makes the file, as cli::origin() says it
/// @param config  of the new file
/// @param parts  a line for each part, see part_line()
store::Provenance joint_provenance(const store::Provenance& maker, const std::string& config,
                                   const std::vector<const store::SweepFile*>& files,
                                   const std::string& parts);
/// One part in JSON: its name, the number of its rows, versions, hosts, first call; and those of its own
/// parts.
std::string part_line(const std::string& path, const store::SweepFile& file,
                      const std::string& condition = "");

}  // namespace clog::campaign
