#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace clog {

/// The description of a run's laboratory, `key = value; key = value`. Results are also printed in units of
/// this laboratory; the runs do not depend on it. A result row contains only the checksum of the description.
/// A process can find the text of a checksum only if it has read this text before.
class LaboratoryText {
 public:
  /// @throws Error if the text contains no `key = value`
  explicit LaboratoryText(const std::string& text);
  /// @throws Error if the argument does not have the form of check_sum()
  static LaboratoryText from_check_sum(std::string_view check_sum);

  /// CRC-64/XZ of the text: 16 hexadecimal digits.
  std::string check_sum() const;
  /// Empty if this process has read no text of this checksum.
  std::string text() const;

  bool operator==(const LaboratoryText&) const = default;

 private:
  std::uint64_t check_sum_;

  explicit LaboratoryText(std::uint64_t check_sum) : check_sum_(check_sum) {}
};

}  // namespace clog
