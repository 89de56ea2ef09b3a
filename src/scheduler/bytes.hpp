#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace clog::scheduler {

/// A message that is not a report: a plain value and a snapshot, which may be empty.
template <class T>
std::vector<std::byte> to_bytes(const T& value, std::span<const std::byte> snapshot) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<std::byte> bytes(sizeof value + snapshot.size());
  std::memcpy(bytes.data(), &value, sizeof value);
  std::copy(snapshot.begin(), snapshot.end(), bytes.begin() + sizeof value);
  return bytes;
}

template <class T>
std::pair<T, std::vector<std::byte>> from_bytes(const std::vector<std::byte>& bytes) {
  std::pair<T, std::vector<std::byte>> message;
  std::memcpy(&message.first, bytes.data(), sizeof(T));
  message.second.assign(bytes.begin() + sizeof(T), bytes.end());
  return message;
}

}  // namespace clog::scheduler
