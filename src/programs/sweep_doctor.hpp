#pragma once

#include "clog/parallel/communicator.hpp"

namespace clog {

/// `clogsweep doctor`, on one rank or under mpirun: would a sweep started like this go well? Collective.
/// Returns the exit code on rank 0, 1 if there is something to mend. @throws Error
int clogsweep_doctor(const parallel::Communicator& ranks, int argc, const char* const* argv);

/// srun without PMIx starts as many programs as there are tasks, each of which believes that it is alone.
/// @throws Error if this is one of them
void refuse_to_be_alone(int num_ranks);

}  // namespace clog
