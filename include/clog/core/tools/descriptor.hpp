#pragma once

#include <unistd.h>

#include <cerrno>
#include <utility>

namespace clog {

/// Owns a file descriptor of the system, the number of an open file or socket.
class Descriptor {
 public:
  /// @param number  below 0: none is open
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (is_open()) ::close(number_);
  }
  bool is_open() const { return number_ >= 0; }
  operator int() const { return number_; }

 private:
  int number_;
};

/// Repeats a system call that a signal has interrupted. Returns the result of the last call; if it is below
/// 0, errno contains the reason.
template <class Call>
auto retried(const Call& call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

}  // namespace clog
