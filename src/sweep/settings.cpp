#include "clog/sweep/settings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>
#include <utility>

#include "clog/core/polygon/forces/automatic_values.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/excerpt.hpp"
#include "clog/core/tools/joined.hpp"

namespace clog::sweep {
namespace {

/// The longest text of a key's values in a config, in characters.
constexpr std::size_t longest_text = 3000;

/// A preset's values for the keys of the interface and of its numerics.
struct Preset {
  const char* name;
  std::vector<std::pair<const char*, const char*>> texts;
};
const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = {
      {"robust",
       {{"perimeter-spring", "along"},
        {"perimeter-stiffness", "auto"},
        {"perimeter-stiffness-ratio", "0.001"},
        {"wall-contact", "edge"},
        {"contact-range", "0"},
        {"self-contact", "on"},
        {"gravity", "area"},
        {"area-stiffness", "auto"},
        {"time-step", "auto"}}},
      {"heavy-interface",
       {{"perimeter-spring", "mean"},
        {"perimeter-stiffness", "auto"},
        {"perimeter-stiffness-ratio", "0.001"},
        {"wall-contact", "edge"},
        {"contact-range", "0"},
        {"self-contact", "on"},
        {"gravity", "vertex"},
        {"area-stiffness", "auto"},
        {"time-step", "auto"}}},
      {"elastic",
       {{"perimeter-spring", "rest"},
        {"perimeter-stiffness", "auto"},
        {"perimeter-stiffness-ratio", "0.1"},
        {"wall-contact", "edge"},
        {"contact-range", "0"},
        {"self-contact", "on"},
        {"gravity", "vertex"},
        {"area-stiffness", "auto"},
        {"time-step", "auto"}}},
      {"literal",
       {{"perimeter-spring", "rest"},
        {"perimeter-stiffness", "auto"},
        {"perimeter-stiffness-ratio", "0.001"},
        {"wall-contact", "vertex"},
        {"contact-range", "half-vertex"},
        {"self-contact", "off"},
        {"gravity", "vertex"},
        {"area-stiffness", "1e4"},
        {"time-step", "1e-3"}}},
  };
  return all;
}

[[noreturn]] void refuse_value(const std::string& name, const std::string& text, const std::string& why) {
  constexpr std::size_t longest_shown = 60;
  const std::string shown = text.size() > longest_shown ? text.substr(0, longest_shown) + "..." : text;
  throw Error(fmt::format("invalid {}={} ({})", name, shown, why));
}

std::string unit_in_words(const Key& key) {
  const std::string unit = key.parameter ? key.parameter->unit : "";
  return unit.empty() ? "a pure number" : "in " + unit;
}

Key key_of(const Parameter& parameter) {
  const bool is_ensemble = parameter.role == ParameterRole::ensemble;
  const std::string unit = *parameter.unit ? fmt::format(" [{}]", parameter.unit) : "";
  return {.name = parameter.key,
          .kind = parameter.kind,
          .words = parameter.words,
          .default_text = is_ensemble ? "1..10" : written(parameter.get({}), parameter),
          .help = parameter.meaning + unit,
          .parameter = &parameter};
}

Key preset_key() {
  Key key{.name = "preset",
          .kind = ValueKind::word,
          .words = {},
          .default_text = "robust",
          .help =
              "sets the keys of the interface together, those given by hand excepted: robust (weight on the "
              "liquid), heavy-interface (weight on the interface), elastic (the same, and it stretches like "
              "rubber, K_l = 0.1 Gamma; shows the published trends), literal (the published equations)",
          .parameter = nullptr};
  for (const Preset& preset : presets()) key.words.emplace_back(preset.name);
  return key;
}

std::vector<Key> make_keys() {
  std::vector<Key> all;
  all.reserve(parameter_schema().size());
  for (const Parameter& parameter : parameter_schema()) all.push_back(key_of(parameter));
  all.insert(all.begin() + 1, preset_key());  // behind the model
  return all;
}

std::string replaced(std::string text, std::string_view part, std::string_view other) {
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + other.size()))
    text.replace(at, part.size(), other);
  return text;
}

/// One text for all ways to type a symbol: as TeX writes it, in Latin letters, without the dash below.
std::string plain_symbol(std::string text) {
  constexpr std::pair<const char*, const char*> words[] = {
      {"\\mathrm", ""}, {"\\", ""},     {"{", ""},      {"}", ""},      {"_", ""},
      {"$", ""},        {"Γ", "Gamma"}, {"Δ", "Delta"}, {"α", "alpha"}, {"β", "beta"},
      {"γ", "gamma"},   {"δ", "delta"}, {"θ", "theta"}, {"μ", "mu"},    {"µ", "mu"},
      {"ρ", "rho"},     {"σ", "sigma"}, {"τ", "tau"},   {"∞", "infty"}};
  for (const auto& [typed, plain] : words) text = replaced(std::move(text), typed, plain);
  return text;
}

/// Empty if no key has this symbol.
std::string key_of_symbol(std::string_view symbol) {
  const std::string plain = plain_symbol(std::string(symbol));
  const auto lower = [](std::string text) {
    for (char& letter : text) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return text;
  };
  for (const Parameter& parameter : parameter_schema())
    if (!plain.empty() && plain_symbol(parameter.symbol) == plain) return parameter.key;
  // One letter is too little to guess by.
  for (const Parameter& parameter : parameter_schema())
    if (plain.size() > 1 && lower(plain_symbol(parameter.symbol)) == lower(plain)) return parameter.key;
  return "";
}

}  // namespace

std::string written(const ParameterValue& value, const Parameter& parameter) {
  if (const auto* number = std::get_if<double>(&value)) return shortest(*number);
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const auto* word = std::get_if<std::string>(&value)) {
    const bool is_check_sum = parameter.kind == ValueKind::text && *word != parameter.words.front();
    const std::string text = is_check_sum ? LaboratoryText::from_check_sum(*word).text() : "";
    return text.empty() ? *word : text;
  }
  return parameter.words.front();  // automatic
}

const std::vector<Key>& keys() {
  static const std::vector<Key> all = make_keys();
  return all;
}

void Key::apply(RunParameters& run, const std::string& value) const {
  if (!parameter || kind == ValueKind::file) return;  // Settings::set has set the keys behind a preset
  const auto parsed = [&]() -> ParameterValue {
    if (kind == ValueKind::word || kind == ValueKind::text) return value;
    if (std::find(words.begin(), words.end(), value) != words.end()) return {};
    if (kind == ValueKind::integer) return std::int64_t{to_integer(value)};
    if (value.ends_with('%')) return value;
    return to_number(value);
  };
  parameter->set(run, parsed());
}

std::vector<std::string> meant_names(std::string_view word, const std::vector<std::string>& names) {
  constexpr std::size_t most_named = 3;
  if (const std::string key = key_of_symbol(word); std::ranges::find(names, key) != names.end()) return {key};
  std::vector<std::string> all = with_part(word, names);
  const std::string near = did_you_mean(word, names);
  std::erase(all, near);
  // A word that lacks its last letters, such as a plural's, comes before words that only contain it.
  if (!near.empty() && (all.empty() || near.starts_with(word))) all.insert(all.begin(), near);
  if (all.size() > most_named) all.resize(most_named);
  return all;
}

const Key& find_key(std::string_view name) {
  const auto key = std::find_if(keys().begin(), keys().end(), [&](const Key& k) { return k.name == name; });
  if (key != keys().end()) return *key;
  std::vector<std::string> names;
  names.reserve(keys().size());
  for (const Key& k : keys()) names.push_back(k.name);
  const std::string word = excerpt(name);
  const std::vector<std::string> meant = meant_names(word, names);
  throw Error(meant.empty() ? fmt::format("unknown key '{}'; --help lists the keys", word)
                            : fmt::format("unknown key '{}'; did you mean {}?", word, joined(meant, " or ")));
}

bool is_same_value(const std::string& a, const std::string& b) {
  if (a == b) return true;
  try {
    return to_number(a) == to_number(b);
  } catch (const Error&) {
    return false;
  }
}

std::string preset_name(const RunParameters& run) {
  for (const Preset& preset : presets()) {
    RunParameters other = run;
    other.dp.perimeter_stiffness.reset();
    for (const auto& [name, text] : preset.texts) find_key(name).apply(other, text);
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

Settings::Settings() {
  for (const Key& key : keys()) assign(key.name, key.default_text);
}

std::string escaped(const std::string& text) {
  constexpr unsigned char last_control = 0x1f, delete_character = 0x7f;
  std::string all;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const auto byte = static_cast<unsigned char>(c);
    const bool is_at_end = i == 0 || i + 1 == text.size();
    const bool is_plain =
        byte > last_control && byte != delete_character && c != '\\' && c != '#' && !(c == ' ' && is_at_end);
    all += is_plain ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
  }
  return all;
}

std::string unescaped(const std::string& text) {
  constexpr std::size_t length = 4;  // of \x0a
  std::string all;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    bool is_escape = text.compare(i, 2, "\\x") == 0 && text.size() - i >= length;
    if (is_escape) {
      const char* const end = text.data() + i + length;
      is_escape = std::from_chars(end - 2, end, byte, 16).ptr == end;
    }
    all += is_escape ? static_cast<char>(byte) : text[i];
    if (is_escape) i += length - 1;
  }
  return all;
}

Settings Settings::from_config(const std::string& text) {
  Settings settings;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const auto equals = line.find(" = ");
    if (equals == std::string::npos) throw Error(fmt::format("'{}' is not key = value", line.substr(0, 60)));
    settings.set_line(line.substr(0, equals), line.substr(equals + 3));
  }
  return settings;
}

void Settings::set(const std::string& name, const std::string& text) {
  assign(name, text);
  given_.insert(name);
  const auto follow = [&](const char* key, const char* value) {
    if (!given_.contains(key)) assign(key, value);
  };
  if (name == circles_key && text != "none") {
    follow("obstacle-layout", "file");
    if (this->text("release") == "centre") follow("seeds", "1");
  }
  if (name == "release" && (text == "anywhere" || text == "entrance"))
    follow("seeds", find_key("seeds").default_text.c_str());
  const Parameter* parameter = find_key(name).parameter;
  const bool is_of_channel = parameter && parameter->scope->word == std::string_view("channel");
  if (is_of_channel) follow("obstacle-layout", "channel");
  if (const Scene* one = scene(); one && one->walls_from == WallsFrom::droplet) follow("seeds", "1");
  if (name != "preset") return;
  for (const Preset& preset : presets())
    if (preset.name == text)
      for (const auto& [key, value] : preset.texts) follow(key, value);
}

const Scene* Settings::scene() const {
  const std::optional<ObstacleLayout> layout = meant_by<ObstacleLayout>(text("obstacle-layout"));
  return layout ? &scene_of(*layout) : nullptr;
}

std::vector<std::string> Settings::missing_files() const {
  std::vector<std::string> missing;
  const auto look = [&](const std::vector<std::string>& files) {
    for (const std::string& file : files)
      if (file != "none" && !circle_files_.contains(file) &&
          std::ranges::find(missing, file) == missing.end())
        missing.push_back(file);
  };
  look(values(circles_key));
  if (!points_.empty()) look(all_values().at(circles_key));
  return missing;
}

namespace {

// Behind the config, for each file its name and the number of its circles, then a circle a line.
constexpr const char* file_mark = "#circles ";

}  // namespace

std::string Settings::packed() const {
  std::string text = to_config(false);
  for (const auto& [file, circles] : circle_files_) {
    text += file_mark + escaped(file) + '\n';
    for (const Obstacle& circle : circles.circles())
      text += fmt::format("#{} {} {}\n", shortest(circle.x), shortest(circle.y), shortest(circle.radius));
  }
  return text;
}

Settings Settings::from_packed(const std::string& text) {
  Settings settings = from_config(text);
  std::istringstream in(text);
  std::string file;
  std::vector<Obstacle> circles;
  const auto finish = [&] {
    if (!file.empty()) settings.attach(file, OwnCircles(std::exchange(circles, {}), file));
  };
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(file_mark)) {
      finish();
      file = unescaped(line.substr(std::string_view(file_mark).size()));
    } else if (line.starts_with('#') && !file.empty()) {
      std::istringstream numbers(line.substr(1));
      std::string x, y, radius;
      numbers >> x >> y >> radius;
      circles.push_back({to_number(x), to_number(y), to_number(radius)});
    }
  }
  finish();
  return settings;
}

void Settings::assign(const std::string& name, const std::string& text) {
  const Key& key = find_key(name);
  std::vector<std::string> values;
  try {
    if (text.size() > longest_text)
      throw Error("the list is too long to be stored; ranges like 1..15000 are short");
    values = expand_list(text, key.kind, key.words);
    for (const std::string& value : values) {
      RunParameters scratch;
      key.apply(scratch, value);
    }
  } catch (const NumberWithUnit& error) {
    refuse_value(
        name, text,
        fmt::format("{}; numbers have no unit here: this one is {}", error.what(), unit_in_words(key)));
  } catch (const Error& error) {
    refuse_value(name, text, error.what());
  }
  texts_[name] = text;
  values_[name] = std::move(values);
}

std::string Settings::to_config(bool with_comments) const {
  std::string config;
  const std::set<std::string> following = keys_that_follow();
  for (const Key& key : keys()) {
    if (following.contains(key.name)) {
      if (with_comments) config += fmt::format("# {} follows from other keys\n", key.name);
      continue;
    }
    if (with_comments) config += fmt::format("# {}\n", key.help);
    config += fmt::format("{} = {}\n", key.name, escaped(text(key.name)));
  }
  return config + config_lines(points_, shard_);
}

}  // namespace clog::sweep
