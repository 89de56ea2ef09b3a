// In the place of nelder_mead.cpp where there is no NLopt.
#include <stdexcept>

#include "clog/fit/calibration.hpp"
#include "nelder_mead.hpp"

namespace clog::fit {

bool can_calibrate() { return false; }

bool nelder_mead(const Search&, const std::function<double(double, double)>&) {
  throw std::logic_error("nelder_mead() was called in a build without NLopt");
}

}  // namespace clog::fit
