#include "file_io.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <vector>

namespace {
/// The next calls of fsync() fail with these errors. The last error comes first.
std::vector<int> next_errors;
}  // namespace

/// Replaces the function of the C library in this program.
// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name): the library's name is reserved
extern "C" int fsync(int descriptor) {
  if (next_errors.empty()) return static_cast<int>(syscall(SYS_fsync, descriptor));
  errno = next_errors.back();
  next_errors.pop_back();
  return -1;
}

namespace clog::store {
namespace {

class Sync : public testing::Test {
 protected:
  void SetUp() override {
    path_ = testing::TempDir() + "file_io." + std::to_string(getpid());
    descriptor_ = open(path_.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
    ASSERT_GE(descriptor_, 0);
  }
  void TearDown() override {
    next_errors.clear();
    close(descriptor_);
    unlink(path_.c_str());
  }

  std::string path_;
  int descriptor_ = -1;
};

TEST_F(Sync, GoesOnAfterASignal) {
  next_errors = {EINTR, EINTR, EINTR};
  EXPECT_FALSE(sync(descriptor_));
  EXPECT_TRUE(next_errors.empty());
}

TEST_F(Sync, TellsAFaultOfTheDisk) {
  next_errors = {EIO, EINTR};
  EXPECT_EQ(sync(descriptor_), std::errc::io_error);
  EXPECT_TRUE(next_errors.empty());
}

}  // namespace
}  // namespace clog::store
