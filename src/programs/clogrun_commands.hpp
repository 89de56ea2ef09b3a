#pragma once

#include <initializer_list>
#include <string>

#include "clog/cli/command_line.hpp"
#include "clog/single_run/recorded_run.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::programs {

/// The systems of clogrun. Each reads its options, runs, writes, and returns the exit code. @throws Error
int clogrun_array(cli::CommandLine& line);
int clogrun_channel(cli::CommandLine& line);
int clogrun_sag(cli::CommandLine& line);
int clogrun_replay(cli::CommandLine& line);

/// The command determines obstacle-layout. @throws Error if the user gives another layout
void choose_layout(cli::CommandLine& line, const std::string& layout);

/// @throws Error for given options that have no meaning for the system
void refuse_options(const cli::CommandLine& line, const std::string& system,
                    std::initializer_list<const char*> options);

/// Reads --sample-interval and --polygon-interval. @throws Error
single_run::RecordedRun::Intervals intervals(const cli::CommandLine& line, double time_step);
/// Prints the outcome of a run; with --lab, lengths and times are also in mm and s. Returns the exit code.
int report(const cli::CommandLine& line, const single_run::RecordedRun& watched);
/// Prints on the standard error which parameters are outside the tested range.
void warn_of_untested_parameters(const sweep::Plan& plan);

}  // namespace clog::programs
