#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace clog::sweep {

/// Parameter sets, listed one by one: each gives texts for these keys, and all other keys have the texts of
/// the settings. A text may be a list; that of the key seeds usually is.
struct Points {
  std::vector<std::string> keys;
  /// A text for every key; an empty one stands for what the settings say.
  std::vector<std::vector<std::string>> rows;

  bool empty() const { return keys.empty(); }
};

/// The part of a sweep that one of several machines takes.
struct Shard {
  std::int64_t number = 1;
  std::int64_t of = 1;

  /// From `2/5`. @throws Error, without the option's name
  static Shard from(const std::string& text);
  std::string text() const;
  bool is_whole() const { return of == 1; }
};

/// Lines of a config, which Settings::set_line() reads: the names of the keys, then a point a line.
std::string config_lines(const Points& points, const Shard& shard);
/// The texts of such a line.
std::vector<std::string> texts_of_line(const std::string& line);

}  // namespace clog::sweep
