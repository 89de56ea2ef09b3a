#include "socket.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace clog::scheduler {
namespace {

struct Header {
  std::int64_t kind;
  std::int64_t job;
  std::uint64_t num_bytes;
};

/// A message of one byte, and room for a socket. (A socket can be sent only together with a byte.)
struct Parcel {
  char byte = 0;
  iovec content{&byte, 1};
  alignas(cmsghdr) char room[CMSG_SPACE(sizeof(int))] = {};
  msghdr message{};

  Parcel() {
    message.msg_iov = &content;
    message.msg_iovlen = 1;
    message.msg_control = room;
    message.msg_controllen = sizeof room;
  }
};

}  // namespace

std::pair<Socket, Socket> Socket::pair() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot make a socket");
  return {Socket(ends[0]), Socket(ends[1])};
}

void Socket::limit_halts(std::chrono::milliseconds longest) const {
  const timeval limit{longest.count() / 1000, longest.count() % 1000 * 1000};
  setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  setsockopt(descriptor_, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
}

bool Socket::write_all(const void* bytes, std::size_t num_bytes) const {
  const char* next = static_cast<const char*>(bytes);
  while (num_bytes > 0) {
    // MSG_NOSIGNAL: the end of the other process must not kill this process.
    const ssize_t sent = retried([&] { return ::send(descriptor_, next, num_bytes, MSG_NOSIGNAL); });
    if (sent <= 0) return false;
    next += sent;
    num_bytes -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool Socket::read_all(void* bytes, std::size_t num_bytes) const {
  char* next = static_cast<char*>(bytes);
  while (num_bytes > 0) {
    const ssize_t received = retried([&] { return ::recv(descriptor_, next, num_bytes, 0); });
    if (received <= 0) return false;
    next += received;
    num_bytes -= static_cast<std::size_t>(received);
  }
  return true;
}

void Socket::send(std::int64_t kind, std::int64_t job, std::span<const std::byte> bytes) const {
  const Header header{kind, job, bytes.size()};
  // The message is sent in one piece, because a sender that is suspended between two pieces would leave half
  // a message.
  std::vector<std::byte> message(sizeof header + bytes.size());
  std::memcpy(message.data(), &header, sizeof header);
  std::ranges::copy(bytes, message.begin() + sizeof header);
  // If only half of the message was sent, the receiver could not parse the next message, so the connection is
  // closed.
  if (!write_all(message.data(), message.size())) ::shutdown(descriptor_, SHUT_RDWR);
}

std::optional<Socket::Message> Socket::receive() const {
  Header header;
  if (!read_all(&header, sizeof header)) return std::nullopt;
  Message message{header.kind, header.job, std::vector<std::byte>(header.num_bytes)};
  if (!read_all(message.bytes.data(), message.bytes.size())) return std::nullopt;
  return message;
}

bool Socket::wait(std::chrono::milliseconds longest) const {
  pollfd state{descriptor_, POLLIN, 0};
  return retried([&] { return ::poll(&state, 1, static_cast<int>(longest.count())); }) > 0;
}

void Socket::send_socket(const Socket& socket) const {
  Parcel parcel;
  cmsghdr* rights = CMSG_FIRSTHDR(&parcel.message);
  rights->cmsg_level = SOL_SOCKET;
  rights->cmsg_type = SCM_RIGHTS;
  rights->cmsg_len = CMSG_LEN(sizeof(int));
  const int descriptor = socket.descriptor_;
  std::memcpy(CMSG_DATA(rights), &descriptor, sizeof descriptor);
  retried([&] { return sendmsg(descriptor_, &parcel.message, MSG_NOSIGNAL); });
}

Socket Socket::receive_socket() const {
  Parcel parcel;
  if (retried([&] { return recvmsg(descriptor_, &parcel.message, MSG_CMSG_CLOEXEC); }) <= 0) return {};
  const cmsghdr* rights = CMSG_FIRSTHDR(&parcel.message);
  if (!rights || rights->cmsg_type != SCM_RIGHTS) return {};
  int descriptor = -1;
  std::memcpy(&descriptor, CMSG_DATA(rights), sizeof descriptor);
  return Socket(descriptor);
}

}  // namespace clog::scheduler
