#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "clog/core/tools/descriptor.hpp"

namespace clog::sweep {

/// Memory that processes of one user on one machine share, found by its name. The memory is a memfd, which is
/// sealed when it is complete. Other processes find it in /proc. So there is no file to remove: the memory is
/// freed when the last process that holds it ends, for any reason.
class SharedMemory {
 public:
  /// Memory that this or another process holds under the name; nullptr if no memory has this name, or if it
  /// is not accessible.
  static std::shared_ptr<const SharedMemory> find(const std::string& name);
  /// Publishes consecutive pieces as one memory. Returns nullptr if the system has no memfd, or not enough
  /// memory.
  /// @param name  up to 200 characters
  static std::shared_ptr<const SharedMemory> publish(const std::string& name,
                                                     std::span<const std::span<const std::byte>> pieces);

  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  ~SharedMemory();

  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  Descriptor file_;  // stays open, so that other processes can find it
  std::span<const std::byte> bytes_;

  explicit SharedMemory(Descriptor file) : file_(std::move(file)) {}
  static std::shared_ptr<const SharedMemory> map(Descriptor file);
};

/// A lock that at most one process of this user on this machine holds at a time. The end of the process
/// releases it.
class NameLock {
 public:
  enum class State { held, held_by_another, impossible };

  /// Takes the lock if it is free and the system supports it.
  explicit NameLock(const std::string& name);

  State state() const { return state_; }
  /// Whether a process of another user holds the lock. Processes of all users can take the lock, by accident
  /// or on purpose; the processes that need the lock would then wait in vain. This call is slow, because it
  /// inspects all processes of this user.
  bool is_taken_by_another_user() const;

 private:
  std::string address_;
  Descriptor socket_;
  State state_ = State::impossible;
};

}  // namespace clog::sweep
