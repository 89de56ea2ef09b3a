#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "clog/core/parameters/circles.hpp"
#include "clog/core/parameters/schema.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/sweep/points.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::sweep {

/// One key of the config file, which is also an option of the programs: a parameter, or the preset, which
/// sets several.
struct Key {
  std::string name;
  ValueKind kind;
  std::vector<std::string> words;  ///< see expand_list
  std::string default_text;
  std::string help;            ///< meaning and unit
  const Parameter* parameter;  ///< nullptr: preset

  /// Not of the key obstacles, whose values name files: Plan knows what is in these.
  /// @throws Error, without the key's name, if the value cannot be read or is out of the type's range
  void apply(RunParameters& run, const std::string& value) const;
};

/// A value in a line of a config, from which unescaped() makes the same text, whatever bytes it has: what
/// would end or cut the line (control characters, #, a backslash, blanks at the ends) becomes a backslash, x
/// and two digits.
std::string escaped(const std::string& text);
/// The way back. A backslash without x and two hexadecimal digits is one.
std::string unescaped(const std::string& text);

/// Circles by the name of their file, as a value of the key obstacles has it.
using CircleFiles = std::map<std::string, OwnCircles>;
inline constexpr const char* circles_key = "obstacles";

/// Every key, in the order in which they are shown. The one place that knows them.
const std::vector<Key>& keys();
/// What a word that is none of the names may have meant: the key of a paper's symbol (Gamma, w_ob), up to
/// three names that it is a part of, or the nearest name. Empty if there is none.
std::vector<std::string> meant_names(std::string_view word, const std::vector<std::string>& names);
/// @throws Error that names the nearest key
const Key& find_key(std::string_view name);

/// A parameter's value as a config file has it.
std::string written(const ParameterValue& value, const Parameter& parameter);
/// Do two texts of a list mean the same value, as 1e-3 and 0.001 do?
bool is_same_value(const std::string& a, const std::string& b);

/// The preset whose interface this resolved parameter set has, or `custom`.
std::string preset_name(const RunParameters& run);

/// The settings of a sweep: for every key the text given, or that of the preset, or the default. The
/// parameter sets are the product of all lists; or points, each with the product of the other keys' lists.
class Settings {
 public:
  Settings();

  /// Reads the text that to_config() wrote. @throws Error as set(), or if a line is not one of a config
  static Settings from_config(const std::string& text);

  /// A preset sets the keys that have not been given themselves, before or after it. Other keys set what
  /// follows from them in the same way: user-supplied circles and keys of a channel set the layout; a channel
  /// or a wall, where nothing is random, sets the seed.
  /// @throws Error if there is no such key or its list cannot be read
  void set(const std::string& name, const std::string& text);
  /// Whether set() gave the key its text, not a preset or default.
  bool is_given(const std::string& name) const { return given_.contains(name); }
  const std::string& text(const std::string& name) const { return texts_.at(name); }
  /// The expanded values of a key.
  const std::vector<std::string>& values(const std::string& name) const { return values_.at(name); }
  /// The scene of all runs; nullptr if they have several.
  const Scene* scene() const;

  /// @throws Error that names the point, if it has an unknown key or a text that cannot be read
  void set_points(const Points& points);
  const Points& points() const { return points_; }
  void set_shard(Shard shard) { shard_ = shard; }
  const Shard& shard() const { return shard_; }

  /// Called for each combination of words of each point, with settings that have no points and one value for
  /// each key of words, so that the runs are the product of the other lists.
  /// @param point  its place; -1 where there are no points
  using VisitBranch = std::function<void(const Settings& branch, std::int64_t point)>;
  void visit_branches(const VisitBranch& visit) const;
  /// The values() of each key in all branches together.
  std::map<std::string, std::vector<std::string>> all_values() const;

  /// A line of a config: a key with its text, or one of `point-keys`, `point`, `shard`.
  void set_line(const std::string& name, const std::string& text);
  /// Is this the name of such a line and no key?
  static bool is_plan_line(const std::string& name);

  /// The circles in the files that the key obstacles names. The caller that sets the key reads them.
  const CircleFiles& circle_files() const { return circle_files_; }
  void attach(const std::string& file, OwnCircles circles) { circle_files_.insert_or_assign(file, circles); }
  /// Files that are named and not attached.
  std::vector<std::string> missing_files() const;

  /// Everything, circles included, as text that travels; and the way back. @throws Error
  std::string packed() const;
  static Settings from_packed(const std::string& text);

  /// All keys as a config file, each with its meaning as a comment if wanted. Reads back as the same
  /// settings.
  std::string to_config(bool with_comments) const;

 private:
  std::set<std::string> given_;
  std::map<std::string, std::string> texts_;
  std::map<std::string, std::vector<std::string>> values_;
  CircleFiles circle_files_;
  Points points_;
  Shard shard_;

  Settings without_points() const;
  void begin_points(Points& points, const std::vector<std::string>& keys) const;
  void add_point(Points& points, const std::vector<std::string>& texts) const;
  std::set<std::string> keys_that_follow() const;
  void assign(const std::string& name, const std::string& text);
};

}  // namespace clog::sweep
