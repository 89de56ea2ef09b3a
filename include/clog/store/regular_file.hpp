#pragma once

#include <string>

namespace clog::store {

/// Tables, trajectories and journals are regular files: opening a pipe would wait, and nothing else can be
/// locked, read at any place and replaced as a whole. Links are followed; a path to nothing is accepted.
/// Returns the path.
/// @throws Error if something else is there
std::string require_regular(std::string path);

}  // namespace clog::store
