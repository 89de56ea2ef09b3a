#pragma once

namespace clog::programs {

/// `clogfit drag`: the near-wall drag's exponent from speeds along a wall. Returns the program's exit code.
/// @throws Error
int clogfit_drag(int argc, const char* const* argv);

}  // namespace clog::programs
