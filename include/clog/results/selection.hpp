#pragma once

#include <span>
#include <string>
#include <vector>

#include "clog/store/run_table.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/run_row.hpp"

namespace clog::results {

/// The end of a message about a column that does not exist.
/// @param meant  the column that the user may mean, or empty
std::string hint_at_column(const std::string& name, const std::string& meant);

/// A condition on a column: `line_tension>=0.5`, `status=clogged,broken`, `preset!=robust`.
class Condition {
 public:
  /// @throws Error if `text` is not a condition, its column does not exist, a number cannot be read, or the
  /// relation orders words or a list
  explicit Condition(const std::string& text);

  /// A row without a value in the column satisfies no condition.
  bool holds(const sweep::RunRow& row) const;

  /// Without this check, a misspelt word would select no row, or all rows with the relation !=.
  /// @throws Error if no row has one of the words
  void require_known_words(std::span<const sweep::RunRow> rows) const;

 private:
  enum class Relation { equal, unequal, less, at_most, more, at_least };

  std::string text_;
  const sweep::Column* column_;
  Relation relation_;
  std::vector<std::string> words_;  // a row satisfies the condition with any of them
  std::vector<double> numbers_;

  template <class T>
  bool compare(const T& value, const std::vector<T>& others) const;
};

/// The rows of a file that satisfy all conditions, as a sweep of exactly these runs.
/// @param maker  the program that makes the file, from cli::origin()
/// @throws Error if no row satisfies all conditions, or if a word of a condition is in no row
store::SweepFile select(const std::string& path, const std::vector<std::string>& conditions,
                        const store::Provenance& maker);

}  // namespace clog::results
