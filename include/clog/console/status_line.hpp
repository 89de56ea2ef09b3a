#pragma once

#include <chrono>
#include <iosfwd>
#include <string>

namespace clog::console {

/// Reports progress. On a terminal, one line is redrawn; in a file or a pipe, a new line appears from time to
/// time.
class StatusLine {
 public:
  enum class Screen { terminal, plain, none };
  /// The kind of screen on which the standard error appears.
  static Screen standard_error();

  StatusLine(std::ostream& out, Screen screen);

  /// Whether it is time to redraw the line.
  bool is_due() const;
  void redraw(const std::string& text);
  /// Prints a permanent line, on any screen.
  void say(const std::string& text);
  /// Keeps the line on a terminal; other text follows below it.
  void keep();
  /// Removes the line from a terminal.
  void wipe();

 private:
  using Clock = std::chrono::steady_clock;

  std::ostream& out_;
  Screen screen_;
  Clock::time_point last_drawn_ = Clock::now();
  std::string text_;
};

}  // namespace clog::console
