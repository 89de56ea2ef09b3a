#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "clog/core/tools/descriptor.hpp"

namespace clog::sweep {

/// Memory that processes of one user on one machine read together, found by its name. It is a memfd, sealed
/// when complete and seen by others in /proc: no file of any kind is made, and the memory goes with the last
/// process that holds it, however that ends.
class SharedMemory {
 public:
  /// Memory that a process, perhaps this one, holds under the name; nullptr if there is none, or none can be
  /// had.
  static std::shared_ptr<const SharedMemory> find(const std::string& name);
  /// Makes it of pieces, one behind the other; nullptr if the system has no such memory, or no more.
  /// @param name  up to 200 characters
  static std::shared_ptr<const SharedMemory> publish(const std::string& name,
                                                     std::span<const std::span<const std::byte>> pieces);

  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  ~SharedMemory();

  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  Descriptor file_;  // kept open: it is what others find
  std::span<const std::byte> bytes_;

  explicit SharedMemory(Descriptor file) : file_(std::move(file)) {}
  static std::shared_ptr<const SharedMemory> map(Descriptor file);
};

/// A lock that at most one process of this user on this machine holds at a time. It ends with the process.
class NameLock {
 public:
  enum class State { held, held_by_another, impossible };

  /// Takes the lock, if nobody has it and the system can make one.
  explicit NameLock(const std::string& name);

  State state() const { return state_; }
  /// Anybody can take an address, so that others wait for nothing. Takes some time: all processes of this
  /// user are looked at.
  bool is_taken_by_another_user() const;

 private:
  std::string address_;
  Descriptor socket_;
  State state_ = State::impossible;
};

}  // namespace clog::sweep
