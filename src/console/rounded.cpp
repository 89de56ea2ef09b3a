#include "clog/console/rounded.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace clog::console {
namespace {

constexpr int most_figures = 8;

std::string scientific(double value, int figures) { return fmt::format("{:.{}e}", value, figures - 1); }
std::string fixed(double value, int decimals) { return fmt::format("{:.{}f}", value, decimals); }

/// Rounds a value to this number of figures.
double rounded(double value, int figures) { return std::strtod(scientific(value, figures).c_str(), nullptr); }

/// The power of ten of the first figure.
int exponent(double value) {
  return value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
}

}  // namespace

std::string plain(double value, int figures) {
  if (!std::isfinite(value)) return "-";
  const double shown = rounded(value, figures);
  const bool is_readable = shown == 0 || (exponent(shown) > -5 && exponent(shown) < 6);
  if (!is_readable) return scientific(value, figures);
  return fixed(shown, std::max(0, figures - 1 - exponent(shown)));
}

RoundedInterval with_interval(double value, double lower, double upper) {
  const double side = std::min(value - lower, upper - value);
  const int wanted = side > 0 ? exponent(value) - exponent(side) + 2 : least_figures;
  const int figures = std::clamp(wanted, least_figures, most_figures);
  return {plain(value, figures), plain(lower, figures), plain(upper, figures)};
}

RoundedError with_error(double value, double error) {
  if (!std::isfinite(value) || !std::isfinite(error) || error <= 0) return {plain(value), plain(error)};
  constexpr int error_figures = 2;
  const int decimals = std::max(0, error_figures - 1 - exponent(rounded(error, error_figures)));
  const bool is_tiny = decimals > most_figures - 1 - exponent(value);
  if (is_tiny) return {plain(value, most_figures), plain(error, error_figures)};
  return {fixed(value, decimals), fixed(error, decimals)};
}

}  // namespace clog::console
