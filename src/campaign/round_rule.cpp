#include "clog/campaign/round_rule.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/number_text.hpp"

namespace clog::campaign {

std::string goal_or_budget(const std::string& goal, double budget) {
  if (!std::isfinite(budget)) return goal;
  return fmt::format("{}{}a budget of {} core-hours", goal, goal.empty() ? "" : " or ",
                     shortest(budget / hour));
}

void require_one_value_of_others(const sweep::Settings& settings, std::span<const std::string> keys) {
  for (const sweep::Key& key : sweep::keys())
    if (key.name != "seeds" && std::ranges::find(keys, key.name) == keys.end() &&
        settings.values(key.name).size() > 1)
      throw Error(
          fmt::format("invalid {0}={1} (--refine takes one value of every other key) give one, and the "
                      "next in a command of its own, with the same --output",
                      key.name, settings.text(key.name)));
}

}  // namespace clog::campaign
