#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace clog::campaign {

using Record = std::vector<std::byte>;
/// Hands a record to the process that waits for it.
using Tell = std::function<void(std::span<const std::byte>)>;

/// What `work` tells within a time, in a process of its own that is ended then: what takes long in it, such
/// as the release of a droplet that comes to no rest, cannot be stopped otherwise. A signal to stop ends it,
/// too.
/// @param record_size  of each record [bytes]; @param seconds  for all of the work
/// @throws std::system_error if there can be no such process
std::vector<Record> told_within(double seconds, std::size_t record_size,
                                const std::function<void(const Tell&)>& work);

}  // namespace clog::campaign
