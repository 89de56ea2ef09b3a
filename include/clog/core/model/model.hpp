#pragma once

#include "clog/core/droplet/droplet_model.hpp"
#include "clog/core/parameters/parameters.hpp"

namespace clog {

const DropletModel& model_of(const RunParameters& run);

}  // namespace clog
