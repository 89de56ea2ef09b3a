#pragma once

#include <optional>
#include <string_view>
#include <utility>

namespace clog {

/// A value of an enum and the word for it in config files, tables and messages.
template <class Enum>
using Worded = std::pair<Enum, const char*>;

/// The words of an enum in files and messages. Each enum has a specialisation beside its definition; the
/// member `all` contains every value and its word.
template <class Enum>
struct Words;

/// The word of a value.
template <class Enum>
constexpr const char* name(Enum value) requires requires {
  Words<Enum>::all;
}
{
  for (const auto& [one, word] : Words<Enum>::all)
    if (one == value) return word;
  return "unknown";
}

/// The value that a word means; nullopt if it means none.
template <class Enum>
constexpr std::optional<Enum> meant_by(std::string_view word) {
  for (const auto& [one, its_word] : Words<Enum>::all)
    if (its_word == word) return one;
  return std::nullopt;
}

}  // namespace clog
