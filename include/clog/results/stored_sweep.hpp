#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clog/core/tools/error.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::results {

/// These functions read the description of a sweep from its file, which also contains the rows.

/// Opens a sweep for reading; warns on stderr about anything that could not be verified. Each row gets its
/// circles and the name of the file of circles. @throws Error as store::read_sweep()
store::SweepFile read_with_caution(const std::string& path);

/// Prints one line about a part of a file that could not be read, for instance because another version of the
/// program wrote it.
/// @param consequence  what the program does without this part
void say_unread(const std::string& path, const std::string& consequence, const Error& why);

/// Text of an attribute; empty if there is none.
std::string attribute(const store::Provenance& provenance, const std::string& name);
/// An empty text removes the attribute.
void set_attribute(store::Provenance& provenance, const std::string& name, const std::string& text);
/// @throws Error that names the file, if the attribute is missing or cannot be parsed. stored_plan() throws
/// the same Error.
sweep::Settings stored_settings(const std::string& path, const store::Provenance& provenance);
sweep::Plan stored_plan(const std::string& path, const store::SweepFile& file);
/// Columns of the keys that have a list in the sweep's config. Empty, with a warning on stderr, if the config
/// cannot be read.
std::vector<std::string> listed_columns(const store::Provenance& provenance);
/// Number of runs requested so far: with --until-precision the runs of the rounds so far, otherwise all runs
/// of the plan.
/// @throws Error that names the file, if the attribute cannot be parsed
std::int64_t stored_num_wanted(const std::string& path, const store::Provenance& provenance,
                               const sweep::Plan& plan);
/// The number of runs of a file's sweep: the runs that were requested, and other runs in the file.
struct RunCount {
  std::int64_t num_runs = 0;
  std::int64_t num_beyond = 0;  ///< runs outside the lists of the sweep's last command

  /// num_beyond in brackets, after a space; empty if it is 0.
  std::string text_of_beyond() const;
};
RunCount stored_num_runs(const std::string& path, const store::SweepFile& file, const sweep::Plan& plan);

/// The row of a task, for a replay. Call use_instruction_set_of() before the replay. @throws Error if there
/// is no such row, if its task is not over, or if this program would give another result
sweep::RunRow replayable_row(const store::SweepFile& file, const std::string& task);
/// Switches this process to the instruction set of a row, if its model uses one. @throws Error if this
/// processor lacks it
void use_instruction_set_of(const sweep::RunRow& row);

}  // namespace clog::results
