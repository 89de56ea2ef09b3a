#pragma once

#include <stdexcept>

namespace clog {

/// An error of the user or the environment. The text says in one line what is wrong, why, and what to do.
/// Programs print it and exit with code 2. Programming mistakes are asserts, not Errors.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace clog
