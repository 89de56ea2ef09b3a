#pragma once

#include "clog/core/parameters.hpp"
#include "clog/sweep/settings.hpp"

namespace clog {

/// The one parameter set that the settings mean. @throws Error if they mean several
RunParameters single_run(const sweep::Settings& settings);

}  // namespace clog
