#pragma once

#include <string>

namespace clog::console {

/// Filled in by the build.
struct BuildInfo {
  std::string version;
  std::string git_describe;  ///< tag, number of commits since the tag, and hash; without a tag, the hash
  std::string git_hash;      ///< hash of the commit; unlike a tag, it never moves
  std::string compiler;
  std::string build_type;
};
BuildInfo build_info();

}  // namespace clog::console
