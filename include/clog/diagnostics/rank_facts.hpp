#pragma once

#include <string>
#include <vector>

namespace clog::diagnostics {

/// Facts about the place where a rank runs.
struct RankFacts {
  int rank = 0;
  std::string host;
  std::string version;              ///< the version, with the output of git describe
  std::string instruction_set;      ///< the widest instruction set of the processor
  std::vector<int> cores;           ///< cores on which the rank may run
  double cores_granted = 0;         ///< cores that control groups grant to all processes in them; 0: no limit
  double memory = 0;                ///< memory still available, on the host and in control groups [bytes]
  double nanoseconds_per_step = 0;  ///< time per step and vertex, while all ranks compute
};

/// Takes about `seconds` of computing.
RankFacts find_rank_facts(int rank, double seconds);

std::string to_text(const RankFacts& facts);
RankFacts rank_facts_from(const std::string& text);

}  // namespace clog::diagnostics
