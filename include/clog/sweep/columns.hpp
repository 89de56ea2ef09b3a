#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "clog/core/parameters/schema.hpp"
#include "clog/sweep/run_row.hpp"

/// Every column of the table of runs is described once. The columns of the parameters follow from
/// parameter_schema(); the columns of results are listed in columns.cpp. A new result needs a member of
/// RunResult and an entry in columns.cpp.
namespace clog::sweep {

/// The kind of information in a column.
enum class ColumnRole {
  parameter,     ///< describes the run: equal runs have equal values
  result,        ///< the outcome: equal runs have equal values, bit for bit
  circumstance,  ///< for instance the host, or the time that the run took: differs between equal runs
};

}  // namespace clog::sweep

template <>
struct clog::Words<clog::sweep::ColumnRole> {
  static constexpr Worded<sweep::ColumnRole> all[] = {{sweep::ColumnRole::parameter, "parameter"},
                                                      {sweep::ColumnRole::result, "result"},
                                                      {sweep::ColumnRole::circumstance, "circumstance"}};
};

namespace clog::sweep {

/// A row's value in a column; std::monostate if it is unknown, or does not apply to the run.
using Value = ParameterValue;

struct Column {
  std::string name;
  std::string symbol;  ///< the symbol as TeX writes it; may be empty
  std::string unit;    ///< may be empty
  std::string meaning;
  ColumnRole role;
  ValueKind kind;
  std::size_t size;  ///< bytes in a packed row; shorter text is filled up with zeros, longer text is cut
  const Parameter*
      parameter;      ///< the parameter in this column; nullptr if the column has no parameter or several
  bool shapes_array;  ///< see Parameter
  /// Runs to which the column applies; nullptr: all.
  const ParameterScope* scope = nullptr;
  std::function<Value(const RunRow&)> get;
  /// @throws Error if no row can have this value
  std::function<void(RunRow&, const Value&)> set;
  /// Sets the value of a row whose file does not have this column.
  std::function<void(RunRow&)> set_unknown;
  /// Returns the value by which rows are compared; the value is unset if it follows from other columns. If
  /// null, Parameter::compared is used.
  std::function<Value(const RunRow&)> compared = nullptr;
  /// Returns the default of the column for a row with this model and preset; the value is unset if there is
  /// no default. If null, the default is that of a run with defaults for all other parameters. @throws Error
  /// if the row's parameters are impossible
  std::function<Value(const RunRow&)> usual = nullptr;

  bool applies_to(const RunParameters& run) const { return !scope || scope->holds(run); }

  /// See Parameter.
  bool may_be_automatic(const RunParameters& run) const {
    return parameter && parameter->may_be_automatic(run);
  }

  /// Whether the column stores the checksum of a file.
  bool holds_file() const { return parameter && parameter->kind == ValueKind::file; }
  /// Whether the column stores the checksum of a text.
  bool holds_text() const { return parameter && parameter->kind == ValueKind::text; }
  bool holds_check_sum() const { return holds_file() || holds_text(); }

  /// Writes `size` bytes in a file's layout; unset values are stored as NaN, -1 or "".
  void pack(const RunRow& row, std::byte* bytes) const;
  /// Reads these bytes; columns must be read in the order of columns(). `unpacked` keeps the first fault.
  void unpack(const std::byte* bytes, UnpackedRow& unpacked) const;
};

/// All columns, in their order in files.
std::span<const Column> columns();
/// Name of the column with the length of a dwell of Dwells::longest. With `_at` or `_from` appended, it is
/// the name of the column with the place or the time at which this dwell began.
std::string dwell_column(std::size_t place);
/// @throws std::out_of_range if there is no column of this name
const Column& column(std::string_view name);

/// The value as text: a word as it is, a number by its shortest exact text; empty for unset.
std::string text_of(const Value& value);

}  // namespace clog::sweep
