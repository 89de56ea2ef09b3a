#include "clog/core/tools/instruction_set.hpp"

#include <cstdint>

#include "clog/core/tools/error.hpp"
#include "vector_targets.hpp"

namespace clog {
namespace {

/// The target's name in the option --instruction-set.
std::string name_of(std::int64_t target) {
  if (target == HWY_AVX3) return "avx512";
  if (target == HWY_AVX2) return "avx2";
  return HWY_ARCH_X86 ? "baseline" : hwy::TargetName(target);
}

/// From this call on, every kernel chooses among these targets; 0: all that the processor supports.
void allow_targets(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

std::vector<std::string> instruction_sets() {
  const std::int64_t present = hwy::SupportedTargets();
  allow_targets(0);
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) names.push_back(name_of(target));
  allow_targets(present);
  return names;
}

std::string instruction_set() {
  // Unless the targets are set, Highway queries the processor at every choice of a kernel. Under a hypervisor
  // this takes longer than the rest of a task's description.
  [[maybe_unused]] static const bool is_asked_once = (allow_targets(hwy::SupportedTargets()), true);
  return name_of(hwy::SupportedAndGeneratedTargets().front());
}

void use_instruction_set(const std::string& name) {
  allow_targets(0);
  if (name == "auto") return allow_targets(hwy::SupportedTargets());
  std::string names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (name_of(target) == name) return allow_targets(target);
    names += ", " + name_of(target);
  }
  throw Error("this processor has no instruction set '" + name +
              "', or the program was not compiled for it; it has auto" + names);
}

}  // namespace clog
