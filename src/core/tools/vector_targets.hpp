#pragma once

/// The instruction sets for which all kernels are compiled. Include this header before any other header of
/// Highway.
// Three are enough: any processor, AVX2, AVX-512. (The others do not speed up double precision.)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#include <hwy/targets.h>
