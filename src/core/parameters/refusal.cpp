#include "core/parameters/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "clog/core/tools/portable_math.hpp"

namespace clog {

Refusal::Refusal(const About& about, const std::string& value, const std::string& reason,
                 const std::string& remedy)
    : Refusal(about, "invalid " + about.key + '=' + value + " (" + reason + ')', remedy) {}

Refusal::Refusal(About about, std::string text, const std::string& remedy)
    : Error(remedy.empty() ? text : text + ' ' + remedy),
      about_(std::move(about)),
      text_(std::move(text)),
      remedy_(remedy) {}

bool Refusal::names(std::string_view other) const {
  return other == about_.added || std::ranges::find(about_.named, other) != about_.named.end() ||
         std::ranges::find(about_.excluded, other) != about_.excluded.end();
}

Refusal Refusal::between(const std::string& before, const std::string& after) const {
  return remedy_.empty() ? Refusal(about_, before + text_ + after)
                         : Refusal(about_, before + text_, remedy_ + after);
}

double rounded_down(double value, int digits) {
  const double scale = portable::pow(10, digits - 1 - std::floor(portable::log10(value)));
  return std::floor(value * scale * (1 + 1e-12)) / scale;
}

}  // namespace clog
