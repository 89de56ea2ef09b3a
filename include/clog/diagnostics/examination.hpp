#pragma once

#include <string>
#include <vector>

#include "clog/diagnostics/rank_facts.hpp"

namespace clog::diagnostics {

/// A check of the machine: the finding, and a remedy for a problem.
struct Finding {
  std::string what;
  std::string remedy = {};  ///< empty if there is no problem
};

/// Checks for problems that a sweep on these ranks, with this `output`, would have.
std::vector<Finding> examine(const std::vector<RankFacts>& ranks, const std::string& output);

/// Under srun without PMIx, or under the mpirun of another MPI, every process would assume that it is the
/// only rank. @throws Error if this seems to be the case
void refuse_to_be_alone(int num_ranks);

/// The setting that lets ranks use every core of their host.
/// @param mpi  name and version, as Communicator::library_version() gives them. The launcher of Open MPI 5
/// and later, PRRTE, reads variables with other names.
std::string how_to_unbind(const std::string& mpi);

}  // namespace clog::diagnostics
