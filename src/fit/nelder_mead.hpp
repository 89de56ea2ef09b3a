#pragma once

#include <array>
#include <functional>

namespace clog::fit {

/// A search for the minimum of a function of two variables within bounds.
struct Search {
  std::array<double, 2> from;
  std::array<double, 2> lower;
  std::array<double, 2> upper;
  std::array<double, 2> first_step;
  std::array<double, 2> tolerance;  ///< the search ends when its next step is smaller in both variables
  int most_evaluations;
};

/// Nelder and Mead's simplex.
/// @return whether it ended by its tolerance. @throws what the function throws, which ends the search
bool nelder_mead(const Search& search, const std::function<double(double, double)>& function);

}  // namespace clog::fit
