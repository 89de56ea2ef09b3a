#pragma once

#include <stdexcept>

namespace clog {

/// An error of the user or the environment: what is wrong, why, and a remedy, in one line.
/// Programs print it and leave with exit code 2. Our own mistakes are asserts, not Errors.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace clog
