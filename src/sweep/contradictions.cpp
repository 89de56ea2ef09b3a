#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "clog/core/parameters/refusal.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/sweep/settings.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::sweep {
namespace {

/// Whether the key is given with a text other than its default.
bool is_changed(const Settings& settings, const std::string& key) {
  return settings.is_given(key) && settings.text(key) != find_key(key).default_text;
}

/// Whether the line of the entrance has the length 0 for some values of the keys.
bool has_point_of_entrance(const Settings& settings) {
  RunParameters run;
  std::set<double> from;
  for (const std::string& value : settings.values("entrance-from")) {
    find_key("entrance-from").apply(run, value);
    from.insert(run.obstacles.entrance_from);
  }
  return std::ranges::any_of(settings.values("entrance-to"), [&](const std::string& value) {
    find_key("entrance-to").apply(run, value);
    return run.obstacles.entrance_to > 0 && from.contains(run.obstacles.entrance_to);
  });
}

/// Refuses a key, because another given key excludes it. @throws Refusal
[[noreturn]] void refuse_one_of(const Settings& settings, const std::string& key, const std::string& other) {
  throw Refusal({.key = key, .excluded = {other}}, settings.text(key),
                fmt::format("{}={} is given as well", other, settings.text(other)), "leave one of them out");
}

/// Refuses keys of the interface that have no effect because of another key.
void refuse_interface_keys(const Settings& settings) {
  if (settings.text("model") == "sp") {
    if (settings.text("preset") != find_key("preset").default_text)
      throw Refusal({.key = "preset", .named = {"model"}}, settings.text("preset"),
                    "model=sp has no interface", "leave it out, or use model=dp");
    return;
  }
  const std::string ratio = "perimeter-stiffness-ratio";
  if (!is_changed(settings, ratio)) return;
  if (settings.text("perimeter-spring") != "rest")
    throw Refusal({.key = ratio, .named = {"perimeter-spring"}}, settings.text(ratio),
                  "it belongs to perimeter-spring=rest, not to " + settings.text("perimeter-spring"),
                  "give perimeter-stiffness, or add perimeter-spring=rest");
  if (settings.text("perimeter-stiffness") != "auto") refuse_one_of(settings, ratio, "perimeter-stiffness");
}

/// The stiffnesses and the step of a daughter are automatic, so the values of the ancestor must be automatic,
/// too. (Soft disks need a given wall-stiffness, but another check refuses break-up for them.)
void refuse_given_stiffnesses_of_families(const Settings& settings) {
  if (settings.text("break-up") == name(BreakUp::end) || settings.text("model") == name(Model::sp)) return;
  for (const char* key : {"time-step", "wall-stiffness", "area-stiffness", "perimeter-stiffness"})
    if (is_changed(settings, key))
      throw Refusal({.key = key, .named = {"break-up"}}, settings.text(key),
                    "with break-up=daughters each droplet has its own automatic value", "leave it out");
}

}  // namespace

void refuse_contradictions(const Settings& settings) {
  refuse_interface_keys(settings);
  refuse_given_stiffnesses_of_families(settings);
  if (const std::vector<std::string> missing = settings.missing_files(); !missing.empty())
    throw Refusal({.key = circles_key}, missing.front(), "the file has not been read", "");
  if (is_changed(settings, "pitch") && is_changed(settings, "obstacle-gap"))
    refuse_one_of(settings, "pitch", "obstacle-gap");
  const std::string& layout = settings.text("obstacle-layout");
  if (layout != "file" && settings.text(circles_key) != "none")
    throw Refusal({.excluded = {"obstacle-layout"}}, "obstacles and obstacle-layout=" + layout +
                                                         " contradict each other; leave one of them out");
  const Scene* scene = settings.scene();
  if (scene && scene->walls_from == WallsFrom::droplet && settings.text("seeds") != "1")
    throw Refusal({.key = "seeds", .named = {"obstacle-layout"}}, settings.text("seeds"),
                  "nothing is random with obstacle-layout=" + layout, "leave it out");
  if (layout != "file") return;
  if (!settings.is_given("box"))
    throw Refusal({.key = circles_key}, settings.text(circles_key), "nothing says how wide their array is",
                  "give box, the width after which it repeats");
  for (const char* key : {"obstacle-gap", "obstacle-density", "obstacle-diameter-spread", "lattice-angle"})
    if (is_changed(settings, key))
      throw Refusal(
          {.excluded = {key}},
          fmt::format("obstacles and {0}={1} contradict each other (the file's own gap, density and layout "
                      "count); remove {0}",
                      key, settings.text(key)));
  if (settings.values("seeds").size() > 1 && settings.text("release") == "centre")
    throw Refusal({.key = "seeds", .added = "release"}, settings.text("seeds"),
                  "the droplet starts at the centre of your circles, whatever the seed",
                  "add release=anywhere or release=entrance, or give one seed");
  if (settings.values("seeds").size() > 1 && settings.text("release") == "entrance" &&
      has_point_of_entrance(settings))
    throw Refusal({.key = "seeds"}, settings.text("seeds"),
                  "entrance-from and entrance-to are equal: the droplet starts there, whatever the seed",
                  "give an entrance of some width, or one seed");
}

std::string why_nothing_is_random(const RunParameters& run) {
  const Scene& scene = scene_of(run);
  const ObstacleParameters& obstacles = run.obstacles;
  if (scene.walls_from == WallsFrom::droplet) return std::string("obstacle-layout=") + name(obstacles.layout);
  if (scene.walls_from != WallsFrom::circles) return "";
  if (obstacles.release == Release::centre) return "release=centre";
  const bool is_at_point = obstacles.release == Release::entrance && obstacles.entrance_to > 0 &&
                           obstacles.entrance_from == obstacles.entrance_to;
  return is_at_point ? "entrance-from equal to entrance-to" : "";
}

std::string possible_decimal(const Key& key, const Settings& settings) {
  const std::string& text = settings.text(key.name);
  const std::string meant = with_decimal_point(text);
  const bool is_number = key.kind == ValueKind::number || key.kind == ValueKind::number_or_share;
  if (!is_number || !meant.starts_with("0.")) return "";
  return fmt::format("{}={} is a list of {}; decimals have a point, {}", key.name, text,
                     joined(settings.values(key.name), " and "), meant);
}

}  // namespace clog::sweep
