#pragma once

namespace clog::programs {

/// `clogfit calibrate`: line tension and near-wall drag from measured profiles. Returns the program's exit
/// code. @throws Error
int clogfit_calibrate(int argc, const char* const* argv);

}  // namespace clog::programs
