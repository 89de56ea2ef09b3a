#pragma once

#include <string>
#include <vector>

namespace clog {

/// Names of the instruction sets for which the kernels are compiled (avx512, avx2, baseline) and which this
/// processor supports. The widest set comes first. (On processors other than x86 the names are those of the
/// Highway library.)
std::vector<std::string> instruction_sets();
/// The instruction set for droplets made from now on, and for their release. Results of two sets differ by
/// round-off (docs/explanation/numerics.md, "Reproducibility").
std::string instruction_set();
/// Sets instruction_set(); `auto` selects the widest set. Call this before droplets and threads are made.
/// @throws Error if this processor has no such set
void use_instruction_set(const std::string& name);

}  // namespace clog
