#pragma once

#include <functional>
#include <string>

namespace clog::store {

/// Reads once in a process of its own what this one is going to read: HDF5 may crash or never end on metadata
/// that are damaged. Errors thrown there do not count, they come again.
/// @throws Error naming the path if the process dies of it
void rehearse(const std::string& path, const std::function<void()>& read);

}  // namespace clog::store
