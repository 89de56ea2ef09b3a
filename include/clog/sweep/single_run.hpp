#pragma once

#include "clog/core/parameters/parameters.hpp"
#include "clog/core/run/systems.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::sweep {

/// The one parameter set that the settings mean. @throws Error if they mean several
RunParameters single_run(const sweep::Settings& settings);

/// The one parameter set that the settings mean in this channel, resolved. @throws Error if they mean several
RunParameters channel_run(Settings settings, const ChannelParameters& channel);

}  // namespace clog::sweep
