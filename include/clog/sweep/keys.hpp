#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clog/core/parameters/schema.hpp"

namespace clog::sweep {

/// One key of the config file, which is also an option of the programs. It is a parameter, or the preset,
/// which sets several parameters.
struct Key {
  std::string name;
  ValueKind kind;
  std::vector<std::string> words;  ///< see expand_list
  std::string default_text;
  std::string help;            ///< meaning and unit
  const Parameter* parameter;  ///< nullptr: preset

  /// Whether values of the key have a unit of the model; otherwise they are pure numbers or words.
  bool has_unit() const { return parameter && *parameter->unit != '\0'; }
  bool is_ensemble() const { return parameter && parameter->role == ParameterRole::ensemble; }

  /// Sets the key's parameter to a value. Does nothing for the preset, which acts through other keys. Does
  /// nothing for the key `obstacles` either, because its values only name files; Plan knows the content of
  /// these files. @throws Error whose text does not name the key, if the value cannot be read or is out of
  /// the type's range
  void apply(RunParameters& run, const std::string& value) const;
};

/// All keys, in the order in which they are shown.
const std::vector<Key>& keys();
/// The key that lists the runs of a parameter set.
const Key& seeds_key();
/// Suggestions for a word that is not a key: the key whose symbol in the paper is this word (Gamma, w_ob), or
/// up to three names that contain the word, or the nearest name. Empty if there are no suggestions.
std::vector<std::string> meant_names(std::string_view word, const std::vector<std::string>& names);
/// @throws Error that names the nearest key
const Key& find_key(std::string_view name);
/// The key's place in keys(). @throws Error as find_key()
std::size_t place_of_key(std::string_view name);

/// A parameter's value as text of a config file.
std::string written(const ParameterValue& value, const Parameter& parameter);
/// Whether two texts of a list mean the same value, as 1e-3 and 0.001 do.
bool is_same_value(const std::string& a, const std::string& b);

std::vector<std::string> preset_names();
/// The keys that a preset sets (of the interface and of its numerics), with their values; empty if there is
/// no such preset.
std::vector<std::pair<const char*, const char*>> preset_texts(std::string_view name);
/// Name of the preset whose values this resolved parameter set has; `custom` if there is none.
std::string preset_name(const RunParameters& run);

}  // namespace clog::sweep
