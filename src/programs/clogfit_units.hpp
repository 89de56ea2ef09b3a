#pragma once

namespace clog::programs {

/// clogfit units: converts between a laboratory's quantities and the model's numbers. Returns the exit code.
int clogfit_units(int argc, const char* const* argv);

}  // namespace clog::programs
