#pragma once

#include <vector>

#include "clog/results/groups.hpp"

namespace clog::results {

/// All doubts but Doubt::not_exponential, which needs all groups.
std::vector<Doubt> doubts_about(const Group& group);
/// Adds Doubt::not_exponential. The same runs in several laboratories are one test.
void doubt_exponentiality(std::vector<Group>& groups);

}  // namespace clog::results
