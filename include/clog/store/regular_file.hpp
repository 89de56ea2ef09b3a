#pragma once

#include <string>

namespace clog::store {

/// Tables, trajectories and journals are regular files: whoever opens a pipe waits, and nothing else can be
/// locked, read at any place and replaced as a whole. Links are followed; a path at which nothing is passes.
/// Returns the path.
/// @throws Error if something else is there
std::string require_regular(std::string path);

}  // namespace clog::store
