#pragma once

#include <string>

namespace clog::console {

/// Filled in by the build.
struct BuildInfo {
  std::string version;
  std::string git_describe;  ///< of the sources: tag, commits since, hash; or the hash alone
  std::string git_hash;      ///< unlike a tag, it never moves
  std::string compiler;
  std::string build_type;
};
BuildInfo build_info();

}  // namespace clog::console
