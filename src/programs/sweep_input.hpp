#pragma once

#include <string>

#include "clog/store/run_table.hpp"

namespace clog {

/// A sweep's file for whoever prints something of it: what could not be checked is said on the standard
/// error.
/// @throws Error as store::read_sweep()
store::SweepFile read_with_caution(const std::string& path);

}  // namespace clog
