#pragma once

namespace clog::programs {

/// `clogfit lengths`. Returns the program's exit code. @throws Error
int clogfit_lengths(int argc, const char* const* argv);

}  // namespace clog::programs
