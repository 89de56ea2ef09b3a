#include "clog/console/printable.hpp"

#include <algorithm>
#include <cstddef>

namespace clog::console {
namespace {

unsigned char byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

/// Number of bytes of a UTF-8 character with this first byte; 0 if no character begins with this byte.
std::size_t length_by(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return 2;
  if (first >= 0xe0 && first <= 0xef) return 3;
  return first >= 0xf0 && first <= 0xf4 ? 4 : 0;
}

/// Number of bytes of the text's first character; 0 for a control character, or invalid UTF-8.
std::size_t printable_length(std::string_view text) {
  const unsigned char first = byte_at(text, 0);
  const std::size_t length = length_by(first);
  if (length == 1) return first >= 0x20 && first != 0x7f ? 1 : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte_at(text, i) & 0xc0) != 0x80) return 0;
  const bool is_control = first == 0xc2 && byte_at(text, 1) < 0xa0;  // U+0080 to U+009F
  return is_control ? 0 : length;
}

std::string escaped(unsigned char byte) {
  if (byte == '\n') return "\\n";
  if (byte == '\t') return "\\t";
  if (byte == '\r') return "\\r";
  constexpr const char* digits = "0123456789abcdef";
  return {'\\', 'x', digits[byte >> 4], digits[byte & 0xf]};
}

}  // namespace

std::string printable(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const std::size_t length = printable_length(text);
    line += length > 0 ? std::string(text.substr(0, length)) : escaped(byte_at(text, 0));
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return line;
}

}  // namespace clog::console
