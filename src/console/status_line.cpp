#include "clog/console/status_line.hpp"

#include <unistd.h>

#include <ostream>

namespace clog::console {
namespace {

constexpr const char* to_left_edge = "\r";
constexpr const char* clear_rest = "\x1b[K";

}  // namespace

StatusLine::Screen StatusLine::standard_error() {
  return isatty(STDERR_FILENO) ? Screen::terminal : Screen::plain;
}

StatusLine::StatusLine(std::ostream& out, Screen screen) : out_(out), screen_(screen) {}

bool StatusLine::is_due() const {
  const double interval = screen_ == Screen::terminal ? 0.2 : 10;
  return std::chrono::duration<double>(Clock::now() - last_drawn_).count() >= interval;
}

void StatusLine::redraw(const std::string& text) {
  last_drawn_ = Clock::now();
  text_ = text;
  if (screen_ == Screen::terminal) out_ << to_left_edge << text << clear_rest << std::flush;
  if (screen_ == Screen::plain) out_ << text << std::endl;
}

void StatusLine::say(const std::string& text) {
  if (screen_ != Screen::terminal) {
    out_ << text << std::endl;
    return;
  }
  out_ << to_left_edge << text << clear_rest << '\n';
  redraw(text_);
}

void StatusLine::keep() {
  if (screen_ == Screen::terminal) out_ << std::endl;
}

void StatusLine::wipe() {
  if (screen_ == Screen::terminal) out_ << to_left_edge << clear_rest << std::flush;
}

}  // namespace clog::console
