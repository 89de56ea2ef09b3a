#include "clog/console/text_file.hpp"

#include <fcntl.h>
#include <iconv.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "clog/console/signals.hpp"
#include "clog/core/tools/descriptor.hpp"
#include "clog/core/tools/error.hpp"

namespace clog::console {
namespace {

/// The byte-order mark of UTF-8, which editors and spreadsheets of Windows write.
constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw Error("cannot read " + path + " (" + reason + "); give a text file");
}

/// @param error  a value of errno
[[noreturn]] void refuse(const std::string& path, int error) {
  if (error == ENOENT) throw Error("cannot read " + path + " (no such file); check the name");
  refuse(path, std::strerror(error));
}

/// Waits for input, at most until a signal arrives.
void wait_for(const Descriptor& file, const std::string& path) {
  constexpr int milliseconds = 100;
  pollfd state{file, POLLIN, 0};
  do {
    if (stop_signalled()) throw Stopped("stopped by a signal while reading " + path);
  } while (poll(&state, 1, milliseconds) <= 0);
}

/// Reads without blocking, so that a signal can end the program even if nobody writes to a pipe.
std::string read_to_end(const std::string& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!file.is_open()) refuse(path, errno);
  std::string text;
  std::array<char, 65536> bytes;
  for (ssize_t size = 1; size != 0;) {
    wait_for(file, path);
    size = retried([&] { return read(file, bytes.data(), bytes.size()); });
    if (size < 0 && errno != EAGAIN) refuse(path, errno);
    text.append(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  }
  return text;
}

/// Text in UTF-16 with a byte-order mark, as spreadsheets write it. @throws Error  if it is damaged
std::string from_utf16(const std::string& path, std::string text) {
  auto* const converter = iconv_open("UTF-8", "UTF-16");
  std::string converted(2 * text.size(), '\0');  // two bytes become three at most
  char* from = text.data();
  char* to = converted.data();
  std::size_t from_left = text.size(), to_left = converted.size();
  const bool has_failed = iconv(converter, &from, &from_left, &to, &to_left) == static_cast<std::size_t>(-1);
  iconv_close(converter);
  if (has_failed) refuse(path, "it is damaged UTF-16");
  converted.resize(converted.size() - to_left);
  return converted;
}

/// Converts line ends of Windows and old Macs.
void unify_line_ends(std::string& text) {
  std::size_t length = 0;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] != '\r')
      text[length++] = text[i];
    else if (i + 1 == text.size() || text[i + 1] != '\n')
      text[length++] = '\n';
  text.resize(length);
}

}  // namespace

std::string read_text(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) refuse(path, errno);
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode))
    refuse(path, "a folder, device or socket, neither a file nor a pipe");
  std::string text = read_to_end(path);
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) text = from_utf16(path, std::move(text));
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  unify_line_ends(text);
  return text;
}

}  // namespace clog::console
