#include "clog/store/trajectory_file.hpp"

#include <gtest/gtest.h>

#include "clog/core/tools/error.hpp"
#include "support.hpp"

namespace clog::store {
namespace {

namespace fs = std::filesystem;

using TrajectoryFileTest = FolderTest;

Trajectory some_trajectory() {
  Trajectory trajectory;
  trajectory.columns = {{"time", "[t0]", {0, 1, 2}}};
  return trajectory;
}

TEST_F(TrajectoryFileTest, NeverReplacesAFile) {
  write_text("run.h5", "a user's");
  EXPECT_THROW(write_trajectory(path("run.h5"), some_trajectory()), Error);
  EXPECT_EQ(text_of("run.h5"), "a user's");
  EXPECT_EQ(num_files(), 1);
}

TEST_F(TrajectoryFileTest, IsMadeWhereALinkLeads) {
  fs::create_symlink("target.h5", path("link.h5"));
  write_trajectory(path("link.h5"), some_trajectory());
  EXPECT_TRUE(fs::is_symlink(path("link.h5")));
  EXPECT_GT(fs::file_size(path("target.h5")), 0u);
  EXPECT_EQ(num_files(), 2);
}

}  // namespace
}  // namespace clog::store
