#pragma once

#include "clog/core/parameters/parameters.hpp"

namespace clog {

/// The largest h at which the free droplet is upstream and clear of the channel [sigma]; infinite if it
/// touches nothing anywhere.
/// @param run  resolved
double last_free_start(const RunParameters& run);

}  // namespace clog
