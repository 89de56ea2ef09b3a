#pragma once

namespace clog::programs {

/// `clogfit deviation`: Delta_v and Delta_A between two profiles. Returns the program's exit code. @throws
/// Error
int clogfit_deviation(int argc, const char* const* argv);

}  // namespace clog::programs
