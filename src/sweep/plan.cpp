#include "clog/sweep/plan.hpp"

#include <algorithm>
#include <cassert>
#include <string>
#include <unordered_map>

#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::sweep {
namespace {

constexpr std::int64_t largest_sweep = 100'000'000;

/// A key that another one leaves without effect was given for nothing.
void refuse_contradictions(const Settings& settings) {
  if (settings.text("model") == "sp") {
    if (settings.text("preset") != find_key("preset").default_text)
      throw Error("invalid preset=" + settings.text("preset") +
                  " (model=sp has no interface) leave it out, or use model=dp");
    return;
  }
  const std::string ratio = "perimeter-stiffness-ratio";
  if (!settings.is_given(ratio) || settings.text(ratio) == find_key(ratio).default_text) return;
  if (settings.text("perimeter-spring") != "rest")
    throw Error("invalid " + ratio + "=" + settings.text(ratio) +
                " (it belongs to perimeter-spring=rest, not to " + settings.text("perimeter-spring") +
                ") give perimeter-stiffness, or add perimeter-spring=rest");
  if (settings.text("perimeter-stiffness") != "auto")
    throw Error("invalid " + ratio + "=" + settings.text(ratio) + " (perimeter-stiffness=" +
                settings.text("perimeter-stiffness") + " is given as well) leave one of them out");
}

/// The parameters of a task. A list like 0,3 may have been meant as 0.3: where one of its values is refused,
/// the message asks.
RunParameters checked_task(const Plan& plan, std::int64_t index, const Settings& settings) try {
  return plan.task(index);
} catch (const Error& error) {
  const std::string message = error.what();
  for (const Key& key : keys())
    if (const std::string meant = with_decimal_point(settings.text(key.name));
        !meant.empty() && message.starts_with("invalid " + key.name + "="))
      throw Error(message + "; " + settings.text(key.name) + " are two values: did you mean " + meant + "?");
  throw;
}

}  // namespace

Plan::Plan(const Settings& settings) {
  refuse_contradictions(settings);
  for (const Key& key : keys()) {
    const std::vector<std::string>& values = settings.values(key.name);
    axes_.push_back({&key, values});
    size_ *= static_cast<std::int64_t>(values.size());
    if (size_ > largest_sweep)
      throw Error("the sweep has more than a hundred million runs; shorten its lists");
  }
  const auto seeds =
      std::find_if(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.key->name == "seeds"; });
  std::rotate(axes_.begin(), seeds, seeds + 1);
  // Different texts may mean the same run: tilts that lead to the same lattice, `auto` and the value behind
  // it.
  std::unordered_map<std::string, std::int64_t> seen;
  for (std::int64_t index = 0; index < num_groups(); ++index) {
    const auto [first, is_new] =
        seen.emplace(identity(describe(checked_task(*this, index, settings))), index);
    if (!is_new)
      throw Error("the sweep's lists lead to the same run twice (parameter sets " +
                  std::to_string(first->second) + " and " + std::to_string(index) +
                  " mean the same); leave one of them out");
  }
}

std::int64_t Plan::num_groups() const {
  return size_ / static_cast<std::int64_t>(axes_.front().values.size());
}

RunParameters Plan::task(std::int64_t index) const {
  assert(index >= 0 && index < size_);
  RunParameters run;
  for (auto axis = axes_.rbegin(); axis != axes_.rend(); ++axis) {
    const auto count = static_cast<std::int64_t>(axis->values.size());
    axis->key->apply(run, axis->values[index % count]);
    index /= count;
  }
  return resolve(run);
}

}  // namespace clog::sweep
