#include "clog/sweep/keys.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <unordered_map>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/excerpt.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::sweep {
namespace {

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
  return {.name = "preset",
          .kind = ValueKind::word,
          .words = preset_names(),
          .default_text = "robust",
          .help =
              "sets all keys of the interface that are not given separately: robust (weight acts on the "
              "liquid), heavy-interface (weight acts on the interface), elastic (weight acts on an interface "
              "that stretches like rubber, K_l = 0.1 Gamma; elastic with friction shows the published "
              "trends), literal (the published equations)",
          .parameter = nullptr};
}

std::vector<Key> make_keys() {
  std::vector<Key> all;
  all.reserve(parameter_schema().size());
  for (const Parameter& parameter : parameter_schema()) all.push_back(key_of(parameter));
  all.insert(all.begin() + 1, preset_key());  // after the model
  return all;
}

std::string replaced(std::string text, std::string_view part, std::string_view other) {
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + other.size()))
    text.replace(at, part.size(), other);
  return text;
}

/// A common form for all spellings of a symbol: TeX, Latin letters, with or without the underscore.
std::string plain_symbol(std::string text) {
  constexpr std::pair<const char*, const char*> words[] = {
      {"\\mathrm", ""}, {"\\", ""},     {"{", ""},      {"}", ""},      {"_", ""},
      {"$", ""},        {"Γ", "Gamma"}, {"Δ", "Delta"}, {"α", "alpha"}, {"β", "beta"},
      {"γ", "gamma"},   {"δ", "delta"}, {"θ", "theta"}, {"μ", "mu"},    {"µ", "mu"},
      {"ρ", "rho"},     {"σ", "sigma"}, {"τ", "tau"},   {"∞", "infty"}};
  for (const auto& [typed, plain] : words) text = replaced(std::move(text), typed, plain);
  return text;
}

/// The key with this symbol; empty if no key has the symbol.
std::string key_of_symbol(std::string_view symbol) {
  const std::string plain = plain_symbol(std::string(symbol));
  const auto lower = [](std::string text) {
    for (char& letter : text) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return text;
  };
  for (const Parameter& parameter : parameter_schema())
    if (!plain.empty() && plain_symbol(parameter.symbol) == plain) return parameter.key;
  // Upper and lower case are equal, except in words of one letter, which are too short for a suggestion.
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
  if (!parameter || kind == ValueKind::file) return;  // a preset acts through other keys
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
  // A name that only appends letters to the word, such as the s of a plural, precedes names that contain the
  // word.
  if (!near.empty() && (all.empty() || near.starts_with(word))) all.insert(all.begin(), near);
  if (all.size() > most_named) all.resize(most_named);
  return all;
}

const Key& seeds_key() {
  static const Key& key = *std::ranges::find_if(keys(), &Key::is_ensemble);
  return key;
}

const Key& find_key(std::string_view name) { return keys()[place_of_key(name)]; }

std::size_t place_of_key(std::string_view name) {
  static const std::unordered_map<std::string_view, std::size_t> places = [] {
    std::unordered_map<std::string_view, std::size_t> all;
    for (const Key& key : keys()) all.emplace(key.name, all.size());
    return all;
  }();
  if (const auto found = places.find(name); found != places.end()) return found->second;
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

}  // namespace clog::sweep
