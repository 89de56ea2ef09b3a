#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "clog/core/tools/descriptor.hpp"

namespace clog::scheduler {

/// One end of a connection between two processes of one machine. A message is received completely, or the
/// other process has ended.
class Socket {
 public:
  Socket() = default;
  explicit Socket(int descriptor) : descriptor_(descriptor) {}

  /// @throws std::system_error
  static std::pair<Socket, Socket> pair();

  struct Message {
    std::int64_t kind = 0;
    std::int64_t job = 0;  ///< the job to which the message belongs
    std::vector<std::byte> bytes;
  };
  bool is_open() const { return descriptor_.is_open(); }
  /// Sets a timeout for messages in either direction that have begun. If the transfer of a message halts for
  /// this long, the other process counts as ended, although it may only be suspended.
  void limit_halts(std::chrono::milliseconds longest) const;
  void close() { descriptor_ = Descriptor(); }
  /// Sends a message. If the other process has ended, the message is lost.
  void send(std::int64_t kind, std::int64_t job, std::span<const std::byte> bytes) const;
  /// Waits for a message, without a timeout unless limit_halts() was called. Returns nullopt if the other
  /// process has ended.
  std::optional<Message> receive() const;
  /// Waits for a message or for the end of the connection. Returns false after the timeout `longest`.
  bool wait(std::chrono::milliseconds longest) const;

  /// Sends one end of another connection to the other process (SCM_RIGHTS).
  void send_socket(const Socket& socket) const;
  /// Waits for a socket. The result is not open if the other process has ended.
  Socket receive_socket() const;

 private:
  Descriptor descriptor_;

  bool read_all(void* bytes, std::size_t num_bytes) const;
  bool write_all(const void* bytes, std::size_t num_bytes) const;
};

}  // namespace clog::scheduler
