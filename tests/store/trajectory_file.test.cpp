#include "clog/store/trajectory_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

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

TEST_F(TrajectoryFileTest, IsReadAsItWasWritten) {
  Trajectory trajectory = some_trajectory();
  trajectory.columns.push_back({"h", "[sigma]", {-1, -0.5, 0.25}});
  trajectory.provenance = {{"orifice", "0.7"}};
  write_trajectory(path("run.h5"), trajectory);
  EXPECT_TRUE(looks_like_hdf5(path("run.h5")));
  const TrajectoryTable table = read_trajectory(path("run.h5"));
  EXPECT_TRUE(table.is_checked);
  ASSERT_EQ(table.columns.size(), 2u);
  EXPECT_EQ(table.column("h"), trajectory.columns[1].values);
  EXPECT_EQ(table.columns[1].meaning, "[sigma]");
  EXPECT_THROW(table.column("v"), std::out_of_range);
  EXPECT_NE(std::ranges::find(table.provenance, std::pair<std::string, std::string>("orifice", "0.7")),
            table.provenance.end());
}

TEST_F(TrajectoryFileTest, IsNotReadWhereAByteIsAnother) {
  write_trajectory(path("run.h5"), some_trajectory());
  std::string bytes = text_of("run.h5");
  bytes[bytes.size() / 2] ^= 1;
  write_text("damaged.h5", bytes);
  EXPECT_THROW(read_trajectory(path("damaged.h5")), Error);
  write_text("text.csv", "h,v");
  EXPECT_FALSE(looks_like_hdf5(path("text.csv")));
  EXPECT_FALSE(looks_like_hdf5(path("nowhere")));
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
