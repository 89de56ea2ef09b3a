#pragma once

#include <cmath>

/// Functions whose last bit does not depend on the processor. glibc has two versions of its double functions,
/// with and without fused multiply-adds, and uses the version that the processor supports. The results of the
/// two versions differ in the last bit in about one of some thousand cases. The long double functions of
/// glibc have only one version. (std::sqrt, std::hypot and rounding already give equal bits on all
/// processors.) The functions here are too slow for loops over vertices.
///
/// sin, cos and tan are plain arithmetic. The other functions use instructions of the x87, whose results may
/// differ in the 64th bit between manufacturers of processors. This almost never affects the 53 bits of a
/// double. Use these other functions only for values that are rounded or compared afterwards.
namespace clog::portable {

using Wide = long double;

inline double sin(double x) { return static_cast<double>(std::sin(Wide(x))); }
inline double cos(double x) { return static_cast<double>(std::cos(Wide(x))); }
inline double tan(double x) { return static_cast<double>(std::tan(Wide(x))); }
inline double atan2(double y, double x) { return static_cast<double>(std::atan2(Wide(y), Wide(x))); }
inline double exp(double x) { return static_cast<double>(std::exp(Wide(x))); }
inline double log(double x) { return static_cast<double>(std::log(Wide(x))); }
inline double log10(double x) { return static_cast<double>(std::log10(Wide(x))); }
inline double pow(double x, double y) { return static_cast<double>(std::pow(Wide(x), Wide(y))); }

}  // namespace clog::portable
