#pragma once

#include <vector>

#include "clog/core/parameters/parameters.hpp"

namespace clog {

/// A rate that the step has to resolve: a key, and how fast its mode would be [1/t0^2].
struct Rate {
  const char* key;
  double value;
  double squared;
};

/// Time in which the speed of a droplet far from walls follows the forces, S V_t/g [t0].
double relaxation_time(const RunParameters& run);

/// The step that resolves the drag's relaxation time: a fifth of it, or a tenth if walls or the motion
/// relative to the mean increase the drag or springs carry tension [t0].
double drag_time_step(const RunParameters& run);

/// Uses this automatic step. @param rates  in addition to that of the drag @throws Error naming the key of
/// the fastest rate if the step is too small to be useful
void choose_time_step(RunParameters& run, double time_step, std::vector<Rate> rates);

/// Checks for every model that max-time and the drag's relaxation time are several steps. @throws Error
void check_time_step(const RunParameters& run);

}  // namespace clog
