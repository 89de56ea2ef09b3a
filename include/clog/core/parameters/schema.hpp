#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "clog/core/parameters/parameters.hpp"

/// The schema describes every parameter of a run once. Keys, their checks, columns, groups, labels and
/// documentation derive from this description. A new parameter needs a member of RunParameters, an entry of
/// parameter_schema(), and its physics.
namespace clog {

/// The value of a parameter; `std::monostate` (unset) if the value is automatic, or if the parameter has no
/// meaning for the run.
using ParameterValue = std::variant<std::monostate, double, std::int64_t, std::string>;

/// `number_or_share`: a number, or a share of the largest possible number, as text like `12.5%`. `file`: the
/// key gives the name of a file, the parameter contains its content. `text`: a description; results contain
/// only its checksum.
enum class ValueKind { number, number_or_share, integer, word, file, text };

/// The purpose of a parameter.
enum class ParameterRole {
  physics,   ///< describes what is modelled
  numerics,  ///< describes how a run is computed or evaluated; results should hardly depend on it
  ensemble,  ///< selects one of many runs that are otherwise equal
};
template <>
struct Words<ParameterRole> {
  static constexpr Worded<ParameterRole> all[] = {{ParameterRole::physics, "physics"},
                                                  {ParameterRole::numerics, "numerics"},
                                                  {ParameterRole::ensemble, "ensemble"}};
};

/// Runs to which a parameter applies.
struct ParameterScope {
  const char* word;    ///< "dp", "lattice", ...
  const char* reason;  ///< why the parameter does not apply to other runs
  const char* remedy;
  bool (*holds)(const RunParameters&);
};

/// The end of a parameter's range.
struct Bound {
  double value;
  bool is_allowed;     ///< whether the range includes this value
  const char* reason;  ///< why values beyond it are refused
  const char* remedy;
};
struct ParameterRange {
  std::optional<Bound> lower, upper;
};

struct Parameter {
  const char* key;      ///< name in config files and on command lines, e.g. "line-tension"
  const char* column;   ///< the column of the table of runs that holds its value
  const char* symbol;   ///< the symbol as TeX writes it
  const char* unit;     ///< e.g. "g rho sigma^2"; empty: a pure number, or a word
  const char* meaning;  ///< one line
  ParameterRole role;
  const ParameterScope* scope;
  const ParameterScope*
      automatic_in;  ///< runs in which the value, unless given, follows from other parameters
  /// Rank among automatic values. An automatic value depends only on automatic values of lower rank. An
  /// automatic value of rank 0 depends on no other automatic value, and no automatic value depends on it.
  int automatic_order;
  ParameterRange range;  ///< the range, if the values are numbers
  bool has_own_column;   ///< false: the column describes other parameters as well
  bool shapes_array;     ///< whether different values give different obstacle arrays
  /// The column's value for runs to which the parameter does not apply; usually unset.
  ParameterValue elsewhere;
  /// The value for runs in files that are older than the parameter; unset if the value is unknown.
  ParameterValue before;
  /// Returns the value by which runs are compared. If it returns an unset value, or is null, runs are
  /// compared by `get`.
  ParameterValue (*compared)(const RunParameters&);

  ValueKind kind;
  /// All values of a word; for a number, the words that select an automatic value.
  std::vector<std::string> words;
  ParameterValue (*get)(const RunParameters&);
  /// @throws Error if the value is out of the type's range, or the word is unknown
  void (*set)(RunParameters&, const ParameterValue&);

  bool applies_to(const RunParameters& run) const { return scope->holds(run); }
  /// Whether the parameter's value follows from other parameters of this run if the user does not give it.
  bool may_be_automatic(const RunParameters& run) const { return automatic_in && automatic_in->holds(run); }
  /// Whether the automatic value may follow from the automatic value of the other parameter.
  bool may_follow_from(const Parameter& other) const {
    return other.automatic_order > 0 && automatic_order > other.automatic_order;
  }
};

/// All parameters, in the order in which they are displayed. A plan's axes have the same order, which
/// determines the numbers of the tasks.
std::span<const Parameter> parameter_schema();
/// @throws std::out_of_range if no parameter has this key
const Parameter& parameter(std::string_view key);

/// Refuses numbers outside their range. Also refuses parameters that do not apply to the run, unless they
/// have their default.
/// @throws Error naming the key, its value, the reason and a remedy
void check_each(const RunParameters& run);

/// A range in words, e.g. "above 0, at most 100"; empty if every number is allowed.
std::string text_of(const ParameterRange& range);

}  // namespace clog
