#include "dp_step_kernel.hpp"

#include "clog/core/error.hpp"
#include "clog/core/instruction_set.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/dp_step_kernel.cpp"
// Three are enough: any processor, AVX2, AVX-512. (The others bring nothing to double precision.)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#include <hwy/foreach_target.h>
// The targets' code follows.
#include "core/dp_step_contacts-inl.hpp"
#include "core/dp_step_motion-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clog::kernel::HWY_NAMESPACE {

/// Named as people call them.
const char* instruction_set_name() {
#if HWY_TARGET == HWY_AVX3
  return "avx512";
#elif HWY_TARGET == HWY_AVX2
  return "avx2";
#elif HWY_ARCH_X86
  return "baseline";
#else
  return hwy::TargetName(HWY_TARGET);
#endif
}

StepKernel make_kernel(const KickTerms& terms) {
  return {instruction_set_name(), measure,         circle_gaps,         pair_gaps, clear_pushes,        push,
          push_off_wedges,        near_wall_rates, kick_version(terms), power,     drift_version(terms)};
}

}  // namespace clog::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clog {
namespace kernel {

HWY_EXPORT(make_kernel);

StepKernel step_kernel(const KickTerms& terms) { return HWY_DYNAMIC_DISPATCH(make_kernel)(terms); }

namespace {

/// Lets the next step_kernel() choose among these targets; 0: all that the processor has.
void allow_targets(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace
}  // namespace kernel

std::vector<std::string> instruction_sets() {
  const std::string present = instruction_set();
  std::vector<std::string> names;
  kernel::allow_targets(0);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    kernel::allow_targets(target);
    names.emplace_back(kernel::step_kernel({}).name);
  }
  use_instruction_set(present);
  return names;
}

std::string instruction_set() { return kernel::step_kernel({}).name; }

void use_instruction_set(const std::string& name) {
  kernel::allow_targets(0);
  if (name == "auto") return;
  std::string names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    kernel::allow_targets(target);
    if (kernel::step_kernel({}).name == name) return;
    names += std::string(", ") + kernel::step_kernel({}).name;
  }
  kernel::allow_targets(0);
  throw Error("this processor has no instruction set '" + name +
              "', or the program was not compiled for it; it has auto" + names);
}

}  // namespace clog
#endif
