#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace clog::sweep {

/// Parameter sets, listed one by one. Each set has its own texts for `keys`, and the texts of the settings
/// for all other keys. A text may be a list; the text of the key seeds usually is a list.
struct Points {
  std::vector<std::string> keys;
  /// A text for every key. An empty text is replaced by the settings' text.
  std::vector<std::vector<std::string>> rows;
  /// The file from which the points come, and the line of each point in this file, for messages. Both are
  /// empty if there is no file.
  std::string file = {};
  std::vector<int> lines = {};

  bool empty() const { return keys.empty(); }
  /// Drops all points, and sets the keys of the points that will be added. @throws Error if `names` is empty,
  /// or if a name is unknown or repeated
  void begin(const std::vector<std::string>& names);
  /// @throws Error that names the point or its line, if the point lacks a text for a key, or has a text that
  /// cannot be read
  void add(const std::vector<std::string>& texts);
};

/// The part of a sweep for one of several machines.
struct Shard {
  std::int64_t number = 1;
  std::int64_t of = 1;

  /// Reads `2/5`, the second of five parts. @throws Error whose text does not name the option
  static Shard from(const std::string& text);
  std::string text() const;
  bool is_whole() const { return of == 1; }
};

}  // namespace clog::sweep
