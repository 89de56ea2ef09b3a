#include "clog/diagnostics/limits.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace clog::diagnostics {
namespace {

namespace fs = std::filesystem;

/// A simulated host: a temporary folder with the files of /proc and /sys that the program reads. The files
/// state that 8 GB of memory are available.
class HostLimits : public testing::Test {
 protected:
  HostLimits() {
    write("proc/meminfo", "MemTotal: 16000000 kB\nMemAvailable: 8000000 kB\nHugePages_Total: 0\n");
  }
  ~HostLimits() override { fs::remove_all(root_); }

  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }

  const fs::path root_ = fs::temp_directory_path() / ("host_limits_" + std::to_string(getpid()));
};

TEST_F(HostLimits, AreTheHostsOwnWithoutControlGroups) {
  EXPECT_EQ(available_memory(root_), 8e9 * 1.024);
  EXPECT_EQ(granted_cores(root_), 0);
}

TEST_F(HostLimits, AreNoneWhereControlGroupsSayMax) {
  write("proc/self/cgroup", "0::/user.slice\n");
  write("sys/fs/cgroup/user.slice/cpu.max", "max 100000\n");
  write("sys/fs/cgroup/user.slice/memory.max", "max\n");
  write("sys/fs/cgroup/user.slice/memory.current", "1000\n");
  EXPECT_EQ(available_memory(root_), 8e9 * 1.024);
  EXPECT_EQ(granted_cores(root_), 0);
}

TEST_F(HostLimits, AreTheTightestFromTheOwnControlGroupUp) {
  write("proc/self/cgroup", "4:memory:/elsewhere\n0::/system.slice/job_7/step_0\n");
  write("sys/fs/cgroup/system.slice/cpu.max", "max 100000\n");
  write("sys/fs/cgroup/system.slice/job_7/cpu.max", "150000 100000\n");
  write("sys/fs/cgroup/system.slice/job_7/step_0/cpu.max", "400000 100000\n");
  write("sys/fs/cgroup/system.slice/job_7/memory.max", "4000000000\n");
  write("sys/fs/cgroup/system.slice/job_7/memory.current", "3000000000\n");
  write("sys/fs/cgroup/system.slice/job_7/step_0/memory.max", "2000000000\n");
  write("sys/fs/cgroup/system.slice/job_7/step_0/memory.current", "500000000\n");
  write("sys/fs/cgroup/system.slice/job_8/cpu.max", "1000 100000\n");  // the limit of another job
  EXPECT_EQ(granted_cores(root_), 1.5);
  EXPECT_EQ(available_memory(root_), 1e9);
}

TEST_F(HostLimits, CountsWhatTheKernelKeepsOfFilesAsAvailable) {
  write("proc/self/cgroup", "0::/job\n");
  write("sys/fs/cgroup/job/memory.max", "4000000000\n");
  write("sys/fs/cgroup/job/memory.current", "3900000000\n");
  write("sys/fs/cgroup/job/memory.stat", "anon 900000000\nfile 3000000000\ninactive_file 2900000000\n");
  EXPECT_EQ(available_memory(root_), 3e9);
}

TEST_F(HostLimits, AreNoLessThanNothing) {
  write("proc/self/cgroup", "0::/job\n");
  write("sys/fs/cgroup/job/memory.max", "1000000\n");
  // More than the limit, because the limit has been lowered.
  write("sys/fs/cgroup/job/memory.current", "1004096\n");
  EXPECT_EQ(available_memory(root_), 0);
}

TEST_F(HostLimits, AreSeenFromWithinAContainer) {
  // In a container the control group of the process is mounted as the root. The group's path in
  // /proc/self/cgroup is the path on the host, or a path outside the mounted group.
  write("sys/fs/cgroup/cpu.max", "50000 100000\n");
  for (const char* path : {"0::/\n", "0::/kubepods/pod1\n", "0::/../other\n"}) {
    write("proc/self/cgroup", path);
    EXPECT_EQ(granted_cores(root_), 0.5) << path;
  }
}

}  // namespace
}  // namespace clog::diagnostics
