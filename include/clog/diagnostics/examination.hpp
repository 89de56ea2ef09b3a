#pragma once

#include <string>
#include <vector>

#include "clog/diagnostics/rank_facts.hpp"

namespace clog::diagnostics {

/// One thing looked at: what is so, and what to do if it is not well.
struct Finding {
  std::string what;
  std::string remedy = {};  ///< empty if all is well
};

/// Would a sweep on these ranks, that writes to `output`, go well?
std::vector<Finding> examine(const std::vector<RankFacts>& ranks, const std::string& output);

/// srun without PMIx, and the mpirun of another MPI, start programs each of which believes that it is alone.
/// @throws Error if this is one of them
void refuse_to_be_alone(int num_ranks);

/// The setting that lets ranks use every core of their host.
/// @param mpi  name and version, as Communicator::library_version() gives them. Since Open MPI 5, its
/// launcher PRRTE
///             reads variables of other names.
std::string how_to_unbind(const std::string& mpi);

}  // namespace clog::diagnostics
