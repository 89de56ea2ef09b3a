#include "clog/fit/holm.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace clog::fit {

std::vector<double> holm_adjusted(std::span<const double> p_values) {
  std::vector<std::pair<double, std::size_t>> tests;
  for (std::size_t i = 0; i < p_values.size(); ++i)
    if (!std::isnan(p_values[i])) tests.emplace_back(p_values[i], i);
  std::ranges::sort(tests);
  std::vector<double> adjusted(p_values.begin(), p_values.end());
  double largest = 0;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(tests.size() - i) * tests[i].first));
    adjusted[tests[i].second] = largest;
  }
  return adjusted;
}

}  // namespace clog::fit
