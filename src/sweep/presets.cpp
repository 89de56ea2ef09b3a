#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

#include "clog/core/polygon/forces/automatic_values.hpp"
#include "clog/sweep/keys.hpp"

namespace clog::sweep {
namespace {

constexpr const char* preset_keys[] = {"perimeter-spring", "perimeter-stiffness", "perimeter-stiffness-ratio",
                                       "wall-contact",     "contact-range",       "self-contact",
                                       "gravity",          "area-stiffness",      "time-step"};
struct Preset {
  const char* name;
  std::array<const char*, std::size(preset_keys)> texts;
};
constexpr Preset presets[] = {
    {"robust", {"along", "auto", "0.001", "edge", "0", "on", "area", "auto", "auto"}},
    {"heavy-interface", {"mean", "auto", "0.001", "edge", "0", "on", "vertex", "auto", "auto"}},
    {"elastic", {"rest", "auto", "0.1", "edge", "0", "on", "vertex", "auto", "auto"}},
    {"literal", {"rest", "auto", "0.001", "vertex", "half-vertex", "off", "vertex", "1e4", "1e-3"}}};

}  // namespace

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets) names.emplace_back(preset.name);
  return names;
}

std::vector<std::pair<const char*, const char*>> preset_texts(std::string_view name) {
  std::vector<std::pair<const char*, const char*>> texts;
  for (const Preset& preset : presets)
    for (std::size_t i = 0; preset.name == name && i < preset.texts.size(); ++i)
      texts.emplace_back(preset_keys[i], preset.texts[i]);
  return texts;
}

std::string preset_name(const RunParameters& run) {
  for (const Preset& preset : presets) {
    RunParameters other = run;
    other.dp.perimeter_stiffness.reset();
    for (const auto& [key, text] : preset_texts(preset.name)) find_key(key).apply(other, text);
    if (!other.dp.contact_range) other.dp.contact_range = half_vertex_diameter(other.dp);
    if (!other.dp.perimeter_stiffness) other.dp.perimeter_stiffness = automatic_perimeter_stiffness(other);
    if (other.dp.perimeter_spring == run.dp.perimeter_spring &&
        other.dp.perimeter_stiffness == run.dp.perimeter_stiffness &&
        other.dp.wall_contact == run.dp.wall_contact && other.dp.self_contact == run.dp.self_contact &&
        other.dp.gravity == run.dp.gravity && other.dp.contact_range == run.dp.contact_range)
      return preset.name;
  }
  return "custom";
}

}  // namespace clog::sweep
