#include "nelder_mead.hpp"

#include <exception>
#include <nlopt.hpp>
#include <vector>

#include "clog/fit/calibration.hpp"

namespace clog::fit {
namespace {

std::vector<double> values(const std::array<double, 2>& array) { return {array.begin(), array.end()}; }

struct Objective {
  const std::function<double(double, double)>& function;
  std::exception_ptr fault = nullptr;  // NLopt would swallow its message

  static double call(const std::vector<double>& x, std::vector<double>&, void* data) {
    auto& self = *static_cast<Objective*>(data);
    try {
      return self.function(x[0], x[1]);
    } catch (...) {
      self.fault = std::current_exception();
      throw nlopt::forced_stop();
    }
  }
};

}  // namespace

bool can_calibrate() { return true; }

bool nelder_mead(const Search& search, const std::function<double(double, double)>& function) {
  Objective objective{function};
  nlopt::opt optimiser(nlopt::LN_NELDERMEAD, 2);
  optimiser.set_lower_bounds(values(search.lower));
  optimiser.set_upper_bounds(values(search.upper));
  optimiser.set_initial_step(values(search.first_step));
  optimiser.set_xtol_abs(values(search.tolerance));
  optimiser.set_maxeval(search.most_evaluations);
  optimiser.set_min_objective(&Objective::call, &objective);
  std::vector<double> place = values(search.from);
  double smallest = 0;
  try {
    return optimiser.optimize(place, smallest) != nlopt::MAXEVAL_REACHED;
  } catch (const nlopt::forced_stop&) {
    std::rethrow_exception(objective.fault);
  } catch (const nlopt::roundoff_limited&) {  // as near as it gets
    return true;
  }
}

}  // namespace clog::fit
