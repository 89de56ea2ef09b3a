#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "clog/results/run_list.hpp"
#include "clog/store/journal.hpp"
#include "clog/store/run_table.hpp"

namespace clog::results {

/// Rows of several files as one sweep. A run that several files have is included once. Its row is chosen in
/// this order of preference: a result, a failure that every attempt would repeat, an unfinished row, a crash.
/// Of two rows of the same kind, the one with more steps is kept. If results differ because of the
/// instruction set, the results of the first file are kept.
struct MergedSweep {
  store::SweepFile table;
  std::vector<store::Journal::Entry> snapshots;  ///< snapshots of unfinished runs
  std::int64_t num_shared = 0;                   ///< runs that several files have
  std::int64_t num_differing = 0;                ///< shared runs with results that differ by instruction set
  std::int64_t num_faulty = 0;  ///< rows that are excluded because they are physically impossible
  /// Numerical keys with different values in the files, if no parameter set is in two of them.
  std::set<std::string> differing_numerics;
};

/// Merges complete or stopped sweeps; the result is for a new file.
/// @param maker  provenance of the program that makes the new file, from cli::origin()
/// @throws Error that names the files and the task, if two rows of a run contradict each other, if a file is
/// damaged or being written, or if two files have different circles under the same name
MergedSweep merge(const std::vector<std::string>& paths, const store::Provenance& maker);

/// Reads the rows of several files together. The files may be of running sweeps, and may have an unreadable
/// config. A single file is returned unchanged.
store::SweepFile read_together(const std::vector<std::string>& paths);

/// Changes the numbers of the tasks and the names of the circles in the table to those in
/// RunList::settings(). Rows of runs outside these settings follow at the end. Returns the settings as a
/// config.
std::string number_tasks(const RunList& runs, store::SweepFile& table);

/// Provenance of a file that contains rows of other files.
/// @param maker  provenance of the program that makes the file, from cli::origin()
/// @param config  config of the new file
/// @param parts  a line for each part, see part_line()
store::Provenance joint_provenance(const store::Provenance& maker, const std::string& config,
                                   const std::vector<const store::SweepFile*>& files,
                                   const std::string& parts);
/// One part as a line of JSON (file name, number of rows, versions, hosts, command line), followed by the
/// lines of its own parts.
std::string part_line(const std::string& path, const store::SweepFile& file,
                      const std::string& condition = "");

}  // namespace clog::results
