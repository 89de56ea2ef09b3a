#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "clog/core/parameters/circles.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/sweep/keys.hpp"
#include "clog/sweep/points.hpp"

namespace clog::sweep {

/// Escapes a value for a line of a config. Characters that would end or cut the line (control characters, #,
/// a backslash, blanks at the ends) become a backslash, x and two digits. unescaped() restores the value,
/// whatever bytes it contains.
std::string escaped(const std::string& text);
/// The inverse of escaped(). Any other backslash stays a backslash.
std::string unescaped(const std::string& text);

/// Circles by the name of their file, as in the key obstacles.
using CircleFiles = std::map<std::string, OwnCircles>;
inline constexpr const char* circles_key = "obstacles";

/// Whether a config explains its keys.
enum class Comments { none, help };

/// The settings of a sweep: a text for every key. The user gives some texts; the other texts follow from
/// these or are defaults. The parameter sets are the product of all lists. With points, there is one such
/// product for each point, over the lists of the keys that the point does not set.
class Settings {
 public:
  /// Reads the text that to_config() wrote. @throws Error as set(), or if a line is not a line of a config
  static Settings from_config(const std::string& text);

  /// @throws Error if there is no such key or its list cannot be read
  void set(const std::string& name, const std::string& text);
  /// Whether set() gave the key its text. Other keys have the text of the preset, a text that follows from
  /// other keys, or the default.
  bool is_given(const std::string& name) const;
  /// The reference is valid until the key's text changes.
  const std::string& text(const std::string& name) const { return entry(name).text; }
  /// The expanded values of a key. The reference is valid until the key's text changes.
  const std::vector<std::string>& values(const std::string& name) const { return entry(name).values; }
  /// The scene of all runs; nullptr if the runs have several scenes.
  const Scene* scene() const;

  /// @throws Error that names the point, if the point has an unknown key or a text that cannot be read
  void set_points(const Points& points);
  const Points& points() const { return points_; }
  void set_shard(Shard shard) { shard_ = shard; }
  const Shard& shard() const { return shard_; }

  /// Calls `visit` for each branch of the settings. There is a branch for each combination of a point and
  /// values of the keys of kind `word`. The settings of a branch have no points and one value for each of
  /// these keys. So the branch's runs are the product of the lists of all other keys.
  /// @param point  place of the branch's point among the points; -1 without points
  using VisitBranch = std::function<void(const Settings& branch, std::int64_t point)>;
  void visit_branches(const VisitBranch& visit) const;
  /// All values() that each key has in any of the branches.
  std::map<std::string, std::vector<std::string>> all_values() const;

  /// A line of a config: a key with its text, or one of the lines `point-keys`, `point`, `shard`.
  void set_line(const std::string& name, const std::string& text);
  /// Whether this is the name of a line that is not a key: `point-keys`, `point` or `shard`.
  static bool is_plan_line(const std::string& name);

  /// The circles in the files that the key obstacles names. The caller that sets the key reads them.
  const CircleFiles& circle_files() const { return circle_files_; }
  void attach(const std::string& file, OwnCircles circles) { circle_files_.insert_or_assign(file, circles); }
  void detach(const std::string& file) { circle_files_.erase(file); }
  /// Files that the key obstacles names, but whose circles have not been attached.
  std::vector<std::string> missing_files() const;

  /// All settings, including circles, as text for other ranks, and the inverse function. @throws Error
  std::string packed() const;
  static Settings from_packed(const std::string& text);

  /// All keys as a config file. Reading this file gives the same settings.
  std::string to_config(Comments comments = Comments::none) const;

 private:
  struct Entry {
    std::string text;
    std::vector<std::string> values;
  };
  /// Entries by place in keys(). Branches of a sweep share them, because there may be many branches.
  using Entries = std::vector<std::shared_ptr<const Entry>>;

  Entries given_ = Entries(keys().size());
  mutable Entries all_;  // resolved(), if is_resolved_; references stay valid while the key keeps its text
  mutable bool is_resolved_ = false;
  CircleFiles circle_files_;
  Points points_;
  Shard shard_;

  const Entry& entry(const std::string& name) const;
  const Entries& entries() const;
  Entries resolved() const;
  std::set<std::string> keys_that_follow() const;
};

/// Refuses keys that have no effect because of another key or of the scene. check_each() refuses further
/// keys.
/// @param settings  a branch, which has one value for each key of kind `word` @throws Error
void refuse_contradictions(const Settings& settings);
/// The setting because of which all seeds give the same run; empty if something is random.
std::string why_nothing_is_random(const RunParameters& run);
/// A question about a list that may be a mistyped decimal below one, such as 0,5; empty for any other list.
std::string possible_decimal(const Key& key, const Settings& settings);

}  // namespace clog::sweep
