#pragma once

#include <initializer_list>
#include <string>

#include "clog/cli/command_line.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/watch/watched_run.hpp"

namespace clog::programs {

/// The systems of clogrun. Each reads its options, runs, writes, and returns the exit code. @throws Error
int clogrun_array(cli::CommandLine& line);
int clogrun_channel(cli::CommandLine& line);
int clogrun_sag(cli::CommandLine& line);
int clogrun_replay(cli::CommandLine& line);

/// Keys and options that describe an obstacle array.
inline constexpr std::initializer_list<const char*> array_options = {"obstacle-gap",
                                                                     "obstacle-diameter",
                                                                     "obstacle-diameter-spread",
                                                                     "obstacle-density",
                                                                     "obstacle-layout",
                                                                     "lattice-angle",
                                                                     "seeds",
                                                                     "seed",
                                                                     "box",
                                                                     "boxes",
                                                                     "obstacles",
                                                                     "write-obstacles"};
/// @throws Error if one of these options was given, which have no meaning for the system
void refuse_options(const cli::CommandLine& line, const std::string& system,
                    std::initializer_list<const char*> options);

/// From --sample-interval and --polygon-interval. @throws Error
watch::WatchedRun::Intervals intervals(const cli::CommandLine& line, double time_step);
/// On the standard error, what of the runs was not proved sound; nothing if all of it was.
void say_what_is_unproven(const sweep::Plan& plan);
/// The row of a run that meets no array, or a user's own.
sweep::RunRow row_of_scene(RunParameters run, ObstacleLayout layout);

}  // namespace clog::programs
