#pragma once

#include "clog/cli/program.hpp"
#include "clog/scheduler/communicator.hpp"

namespace clog::programs {

/// `clogsweep NAME FILE ...`, described by their --help. They need neither MPI nor the sweep's config,
/// and never write to the file. Each returns the program's exit code. @throws Error
int clogsweep_status(int argc, const char* const* argv);
int clogsweep_verify(int argc, const char* const* argv);
int clogsweep_salvage(int argc, const char* const* argv);
int clogsweep_replay(int argc, const char* const* argv);
int clogsweep_merge(int argc, const char* const* argv);
int clogsweep_select(int argc, const char* const* argv);

inline constexpr cli::Command file_commands[] = {
    {"status", clogsweep_status}, {"verify", clogsweep_verify}, {"salvage", clogsweep_salvage},
    {"replay", clogsweep_replay}, {"merge", clogsweep_merge},   {"select", clogsweep_select}};

/// `clogsweep doctor`, on one rank or under mpirun. Collective. Returns the exit code on rank 0, 1 if there
/// is something to fix. @throws Error
int clogsweep_doctor(const scheduler::Communicator& ranks, int argc, const char* const* argv);

}  // namespace clog::programs
