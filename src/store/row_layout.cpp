#include "row_layout.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace clog::store {

using sweep::Column;

namespace {

Type hdf5_type(const Column& column) {
  switch (column.kind) {
    case ValueKind::number:
    case ValueKind::number_or_share:
      return Type(H5Tcopy(H5T_NATIVE_DOUBLE));
    case ValueKind::integer:
      return Type(H5Tcopy(H5T_NATIVE_INT64));
    case ValueKind::word:
    case ValueKind::file:
    case ValueKind::text:
      break;
  }
  return text_type(column.size);
}

std::vector<const Column*> all_columns() {
  std::vector<const Column*> all;
  for (const Column& column : sweep::columns()) all.push_back(&column);
  return all;
}

/// The columns of a stored row, in the order of the row. Unknown and repeated names are skipped.
std::vector<const Column*> columns_of(hid_t stored) {
  std::vector<const Column*> left = all_columns();
  std::vector<const Column*> found;
  const int num_members = H5Tget_nmembers(stored);
  for (int i = 0; i < num_members; ++i) {
    const std::string name = member_name(stored, static_cast<unsigned>(i));
    const auto column = std::ranges::find(left, name, &Column::name);
    if (column == left.end()) continue;
    found.push_back(*column);
    left.erase(column);
  }
  return found;
}

std::string described(const Column& column) {
  return column.meaning + (column.unit.empty() ? "" : " [" + column.unit + "]");
}

}  // namespace

RowLayout::RowLayout(std::vector<const Column*> columns)
    : columns_(std::move(columns)), places_(sweep::columns().size(), absent) {
  for (const Column* column : columns_) {
    places_[static_cast<std::size_t>(column - sweep::columns().data())] = size_;
    size_ += column->size;
  }
  type_ = Type(H5Tcreate(H5T_COMPOUND, size_));
  for (const Column* column : columns_)
    H5Tinsert(type_, column->name.c_str(),
              places_[static_cast<std::size_t>(column - sweep::columns().data())], hdf5_type(*column));
}

RowLayout RowLayout::present() { return RowLayout(all_columns()); }

std::optional<RowLayout> RowLayout::of(hid_t stored, std::size_t least) {
  if (H5Tget_class(stored) != H5T_COMPOUND) return std::nullopt;
  std::vector<const Column*> found = columns_of(stored);
  if (found.empty() || found.size() < least) return std::nullopt;
  RowLayout layout(std::move(found));
  if (H5Tequal(layout.type_, stored) <= 0) return std::nullopt;
  return layout;
}

void RowLayout::describe(hid_t table) const {
  for (const Column* column : columns_) write_attribute(table, column->name, described(*column));
}

sweep::UnpackedRow RowLayout::unpack(const std::byte* packed) const {
  sweep::UnpackedRow unpacked;
  const auto columns = sweep::columns();
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (places_[i] == absent)
      columns[i].set_unknown(unpacked.row);
    else
      columns[i].unpack(packed + places_[i], unpacked);
  return unpacked;
}

}  // namespace clog::store
