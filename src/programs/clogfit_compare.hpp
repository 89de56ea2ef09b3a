#pragma once

namespace clog::programs {

/// `clogfit compare`. Returns the program's exit code. @throws Error
int clogfit_compare(int argc, const char* const* argv);

}  // namespace clog::programs
