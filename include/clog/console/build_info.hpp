#pragma once

#include <string>

namespace clog::console {

/// Filled in by the build.
struct BuildInfo {
  std::string version;
  std::string git_hash;
  std::string compiler;
  std::string build_type;
};
BuildInfo build_info();

}  // namespace clog::console
