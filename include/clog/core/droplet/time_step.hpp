#pragma once

#include <vector>

#include "clog/core/parameters/parameters.hpp"

namespace clog {

/// A rate that the time step has to resolve: the key on which the rate depends, the value of this key, and
/// the square of the rate [1/t0^2].
struct Rate {
  const char* key;
  double value;
  double squared;
};

/// Time constant with which the velocity of a droplet far from walls follows the forces, S V_t/g [t0].
double relaxation_time(const RunParameters& run);

/// Time step that resolves the drag's relaxation time [t0]. The step is a fifth of this time. It is a tenth
/// if springs carry tension, or if the drag is larger near walls or for motion relative to the mean.
double drag_time_step(const RunParameters& run);

/// Sets the automatic time step to `time_step`.
/// @param rates  rates that this step resolves, besides the rate of the drag
/// @throws Error if the step is too small to be useful; the message names the key of the fastest rate
void choose_time_step(RunParameters& run, double time_step, std::vector<Rate> rates);

/// Checks for every model that max-time is between one and 1e15 time steps, and that a step is no longer than
/// the drag's relaxation time. @throws Error
void check_time_step(const RunParameters& run);

}  // namespace clog
