#pragma once

#include "clog/core/parameters/parameters.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::sweep {

/// The one parameter set that the settings mean. @throws Error if they mean several
RunParameters single_run(const sweep::Settings& settings);

}  // namespace clog::sweep
