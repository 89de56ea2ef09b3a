#include "clog/sweep/plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <string>
#include <unordered_map>
#include <utility>

#include "clog/core/parameters/schema.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/world/lattice.hpp"
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
    throw Error(
        fmt::format("invalid {}={} (it belongs to perimeter-spring=rest, not to {}) give "
                    "perimeter-stiffness, or add perimeter-spring=rest",
                    ratio, settings.text(ratio), settings.text("perimeter-spring")));
  if (settings.text("perimeter-stiffness") != "auto")
    throw Error(fmt::format("invalid {}={} (perimeter-stiffness={} is given as well) leave one of them out",
                            ratio, settings.text(ratio), settings.text("perimeter-stiffness")));
}

/// Is it given, and something else than what it would be anyway?
bool is_changed(const Settings& settings, const char* key) {
  return settings.is_given(key) && settings.text(key) != find_key(key).default_text;
}

/// Keys that a scene leaves without effect, beyond those that check_each() knows.
void refuse_useless_keys(const Settings& settings) {
  if (const std::vector<std::string> missing = settings.missing_files(); !missing.empty())
    throw Error("invalid obstacles=" + missing.front() + " (the file has not been read)");
  const std::string& layout = settings.text("obstacle-layout");
  if (layout != "file" && settings.text(circles_key) != "none")
    throw Error("obstacles and obstacle-layout=" + layout + " contradict each other; leave one of them out");
  const Scene* scene = settings.scene();
  if (scene && scene->walls_from == WallsFrom::droplet && settings.text("seeds") != "1")
    throw Error(fmt::format("invalid seeds={} (nothing is random with obstacle-layout={}) leave it out",
                            settings.text("seeds"), layout));
  if (layout != "file") return;
  if (!settings.is_given("box"))
    throw Error("invalid obstacles=" + settings.text(circles_key) +
                " (nothing says how wide their array is) give box, the width after which it repeats");
  for (const char* key : {"obstacle-gap", "obstacle-density", "obstacle-diameter-spread", "lattice-angle"})
    if (is_changed(settings, key))
      throw Error(
          fmt::format("obstacles and {0}={1} contradict each other (the file's own gap, density and layout "
                      "count); leave it out, or give {0}={2}",
                      key, settings.text(key), find_key(key).default_text));
  if (settings.values("seeds").size() > 1 && settings.text("release") == "centre")
    throw Error(
        fmt::format("invalid seeds={} (the droplet starts at the centre of your circles, whatever the seed) "
                    "add release=anywhere or release=entrance, or give one seed",
                    settings.text("seeds")));
}

/// Empty unless the list could be a decimal below one.
std::string possible_decimal(const Key& key, const Settings& settings) {
  const std::string& text = settings.text(key.name);
  const std::string meant = with_decimal_point(text);
  const bool is_number = key.kind == ValueKind::number || key.kind == ValueKind::number_or_share;
  if (!is_number || !meant.starts_with("0.")) return "";
  return fmt::format("{}={} is a list of {}; decimals have a point, {}", key.name, text,
                     joined(settings.values(key.name), " and "), meant);
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
      throw Error(
          fmt::format("{}; {} are two values: did you mean {}?", message, settings.text(key.name), meant));
  throw;
}

/// Of each parameter alone; resolve() says what is wrong.
bool is_each_possible(const RunParameters& run) try {
  check_each(run);
  return true;
} catch (const Error&) {
  return false;
}

}  // namespace

Plan::Plan(const Settings& settings) : circle_files_(settings.circle_files()) {
  refuse_contradictions(settings);
  refuse_useless_keys(settings);
  for (const Key& key : keys()) {
    const std::vector<std::string>& values = settings.values(key.name);
    axes_.push_back({&key, values});
    if (std::string words = possible_decimal(key, settings); !words.empty())
      possible_decimals_.push_back(std::move(words));
    size_ *= static_cast<std::int64_t>(values.size());
    if (size_ > largest_sweep)
      throw Error("the sweep has more than a hundred million runs; shorten its lists");
  }
  const auto seeds =
      std::find_if(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.key->name == "seeds"; });
  std::rotate(axes_.begin(), seeds, seeds + 1);
  refuse_misfitting_angles();
  // Different texts may mean the same run: tilts that lead to the same lattice, `auto` and the value behind
  // it.
  std::unordered_map<std::string, std::int64_t> seen;
  for (std::int64_t index = 0; index < num_groups(); ++index) {
    const auto [first, is_new] =
        seen.emplace(identity(describe(checked_task(*this, index, settings))), index);
    if (!is_new)
      throw Error(
          fmt::format("the sweep's lists lead to the same run twice (parameter sets {} and {} mean the "
                      "same); leave one of them out",
                      first->second, index));
  }
}

/// All at once; a single one resolve() refuses.
void Plan::refuse_misfitting_angles() const {
  std::vector<std::string> angles;
  double box = 0;
  for (std::int64_t index = 0; index < num_groups(); ++index) {
    const RunParameters run = unresolved(index);
    const ObstacleParameters& obstacles = run.obstacles;
    if (!is_each_possible(run) || obstacles.layout != ObstacleLayout::lattice || fitting_lattice(obstacles))
      continue;
    const std::string angle = shortest(obstacles.lattice_angle);
    if (std::ranges::find(angles, angle) != angles.end()) continue;
    angles.push_back(angle);
    box = std::max(box, box_that_fits(obstacles));
  }
  if (angles.size() > 1)
    throw Error(
        fmt::format("invalid lattice-angle={} (no lattice within {:.3g} degrees of any of these has so "
                    "short a period) use box={} or more, or leave them out",
                    joined(angles, ","), largest_angle_error, box));
}

std::int64_t Plan::num_groups() const {
  return size_ / static_cast<std::int64_t>(axes_.front().values.size());
}

RunParameters Plan::task(std::int64_t index) const { return resolve(unresolved(index)); }

RunParameters Plan::unresolved(std::int64_t index) const {
  assert(index >= 0 && index < size_);
  RunParameters run;
  for (auto axis = axes_.rbegin(); axis != axes_.rend(); ++axis) {
    const auto count = static_cast<std::int64_t>(axis->values.size());
    const std::string& value = axis->values[index % count];
    if (axis->key->kind == ValueKind::file && value != "none")
      run.obstacles.own = circle_files_.at(value);
    else
      axis->key->apply(run, value);
    index /= count;
  }
  return run;
}

}  // namespace clog::sweep
