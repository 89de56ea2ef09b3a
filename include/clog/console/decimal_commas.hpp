#pragma once

#include <string>
#include <string_view>

namespace clog::console {

/// Whether the commas of a number may separate thousands: true for 1,350 and 12,345,678, false for 0,350 and
/// 1,35.
bool may_have_thousands(std::string_view number);

/// Decides whether the commas in the numbers of one table are decimal commas or separate thousands.
class DecimalCommas {
 public:
  /// The number with a decimal point in place of its comma.
  /// @throws Error if some numbers so far have a comma and others have a point
  std::string with_point(std::string number);
  /// The number in a cell with a decimal point. @param separator  between the cells of the table; if this is
  /// a comma, a comma in a quoted cell may separate thousands
  /// @throws Error that begins with the column's name, if some numbers have a comma and others have a point,
  /// or if the comma may separate thousands
  std::string with_point(const std::string& column, const std::string& cell, char separator);
  /// @throws Error if every comma so far may separate thousands, so that the numbers are ambiguous.
  /// @param path  of the table
  void check(const std::string& path) const;
  /// @throws Error that names an ambiguous number. @param where  text before the number in the message
  [[noreturn]] static void refuse(std::string_view where, const std::string& number);

 private:
  std::string with_comma_, with_point_;  // the first number with a comma, and the first with a point
  bool is_one_decimal_ = false;
  std::string perhaps_thousands_;  // the first number whose comma may separate thousands
};

}  // namespace clog::console
