#pragma once

/// The instruction sets for which all kernels are compiled. Include this header before any other header of
/// Highway.
// For x86 three sets are enough: the baseline, AVX2 and AVX-512. The bits below HWY_AVX3 stand for extensions
// of AVX-512 that do not speed up double precision. SVE is excluded, because the kernels need vectors with a
// length that is known at compile time.
#define HWY_DISABLED_TARGETS \
  ((HWY_AVX3 - 1) | HWY_SSE4 | HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#include <hwy/targets.h>
