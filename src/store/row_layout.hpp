#pragma once

#include <hdf5.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "clog/sweep/run_row.hpp"
#include "hdf5.hpp"

namespace clog::store {

/// One column: how it is called in the file, what it means, where it is in a row in memory.
struct Column {
  std::string name;
  std::string meaning;
  std::size_t offset;
  std::size_t size;
  Type type;
};

/// How a row lies in a file: one column after the other without gaps. Older files have fewer columns.
class RowLayout {
 public:
  enum class Columns { all, some };

  /// What this version writes.
  static RowLayout present();
  /// That of a stored table; nothing unless it is, member for member, a row of ours.
  static std::optional<RowLayout> of(hid_t stored, Columns expected);

  hid_t type() const { return type_; }
  std::size_t size() const { return size_; }
  /// Writes name and meaning of each column to the table's attributes.
  void describe(hid_t table) const;

  /// @param packed  size() bytes
  void pack(const sweep::RunRow& row, std::byte* packed) const;
  /// Columns that the file does not have keep the values of a new row.
  sweep::RunRow unpack(const std::byte* packed) const;

 private:
  explicit RowLayout(std::vector<Column> columns);

  std::vector<Column> columns_;
  std::size_t size_ = 0;
  Type type_;
};

}  // namespace clog::store
