#include "dp_step_kernel.hpp"

#include "core/tools/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/polygon/step/dp_step_kernel.cpp"
#include <hwy/foreach_target.h>
// The targets' code follows.
#include "core/polygon/step/dp_step_contacts-inl.hpp"
#include "core/polygon/step/dp_step_drift-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clog::kernel::HWY_NAMESPACE {

StepKernel make_kernel(const KickTerms& terms) {
  return {.measure = measure,
          .survey = survey,
          .circle_gaps = circle_gaps,
          .edges_within = edges_within,
          .pair_gaps = pair_gaps,
          .clear_pushes = clear_pushes,
          .push = push,
          .push_and_hold = push_and_hold,
          .push_off_wedges = push_off_wedges,
          .near_wall_rates = near_wall_rates,
          .kick = kick_version(terms),
          .power = power_version(terms),
          .drift = drift_version(terms)};
}

}  // namespace clog::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clog::kernel {

HWY_EXPORT(make_kernel);

StepKernel step_kernel(const KickTerms& terms) { return HWY_DYNAMIC_DISPATCH(make_kernel)(terms); }

}  // namespace clog::kernel
#endif
