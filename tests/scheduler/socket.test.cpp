#include "socket.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <chrono>
#include <cstddef>
#include <vector>

namespace clog::scheduler {
namespace {

TEST(Socket, GivesWhatWasSent) {
  const auto [ours, theirs] = Socket::pair();
  const std::vector<std::byte> bytes{std::byte{1}, std::byte{2}, std::byte{3}};
  ours.send(4, 5, bytes);
  ours.send(6, 7, {});
  const auto first = theirs.receive();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->kind, 4);
  EXPECT_EQ(first->job, 5);
  EXPECT_EQ(first->bytes, bytes);
  const auto second = theirs.receive();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->kind, 6);
  EXPECT_TRUE(second->bytes.empty());
}

TEST(Socket, GivesNothingOfADeadProcess) {
  auto [ours, theirs] = Socket::pair();
  ours.close();
  EXPECT_TRUE(theirs.wait(std::chrono::milliseconds(0)));
  EXPECT_FALSE(theirs.receive());
}

TEST(Socket, SendsAMessageInOnePiece) {
  // A message is sent in one piece, so that a process cannot be stopped in the middle. A SOCK_SEQPACKET
  // socket shows the pieces, because recv() never joins two of them.
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends), 0);
  const Socket ours(ends[0]), theirs(ends[1]);
  const std::vector<std::byte> report(4096);
  ours.send(1, 2, report);
  std::vector<std::byte> received(2 * report.size());
  EXPECT_GT(recv(ends[1], received.data(), received.size(), 0), static_cast<ssize_t>(report.size()));
  EXPECT_FALSE(theirs.wait(std::chrono::milliseconds(0)));
}

}  // namespace
}  // namespace clog::scheduler
