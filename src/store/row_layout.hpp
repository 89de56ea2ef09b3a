#pragma once

#include <hdf5.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "clog/sweep/columns.hpp"
#include "hdf5.hpp"

namespace clog::store {

/// Arrangement of a row in a file: columns without gaps. Older files have fewer columns, in another order.
class RowLayout {
 public:
  /// The layout that this version writes.
  static RowLayout present();
  /// The layout of a stored table; nullopt if a member of the table is not a column of this program, or if
  /// the table has fewer than `least` columns.
  static std::optional<RowLayout> of(hid_t stored, std::size_t least);

  hid_t type() const { return type_; }
  std::size_t size() const { return size_; }
  /// Writes name and meaning of each column to the table's attributes.
  void describe(hid_t table) const;
  /// Missing columns are unknown. @param packed  size() bytes
  sweep::UnpackedRow unpack(const std::byte* packed) const;

 private:
  explicit RowLayout(std::vector<const sweep::Column*> columns);

  static constexpr std::size_t absent = static_cast<std::size_t>(-1);
  std::vector<const sweep::Column*> columns_;  // columns of the file, in the file's order
  std::vector<std::size_t> places_;  // for each of sweep::columns(), its place in a packed row, or `absent`
  std::size_t size_ = 0;
  Type type_;
};

}  // namespace clog::store
