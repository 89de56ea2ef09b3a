#pragma once

namespace clog::programs {

/// `clogfit curve`: a smooth curve through a sweep's clogging lengths. Returns the program's exit code.
/// @throws Error
int clogfit_curve(int argc, const char* const* argv);

}  // namespace clog::programs
