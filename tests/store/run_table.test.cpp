#include "clog/store/run_table.hpp"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <vector>

#include "clog/core/error.hpp"

namespace clog::store {
namespace {

namespace fs = std::filesystem;

class RunTableTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              (std::string("clog_store_") + info->name() + "_" + std::to_string(getpid()));
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const char* name = "sweep.h5") const { return (folder_ / name).string(); }
  std::size_t num_files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

sweep::RunRow some_row(std::int64_t task) {
  sweep::RunRow row = sweep::describe(resolve(RunParameters{}));
  row.task = task;
  row.status = "clogged";
  row.distance = 1.0 / 3 + static_cast<double>(task);
  row.mean_speed = std::nan("");
  row.message = "some words";
  row.host = "node7";
  return row;
}

std::string refusal(const std::string& path) {
  try {
    read_sweep(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST_F(RunTableTest, GivesBackEveryRowBitForBit) {
  RunTable table = RunTable::create(path(), {{"version", "1.2.3"}, {"empty", ""}});
  for (int task = 0; task < 200; ++task) {
    table.append(some_row(task));
    if (task == 0) {
      EXPECT_EQ(read_sweep(path()).rows.size(), 1u);
    }
  }
  const SweepFile file = read_sweep(path());
  ASSERT_EQ(file.rows.size(), 200u);
  for (int task = 0; task < 200; ++task) {
    const sweep::RunRow expected = some_row(task);
    EXPECT_EQ(std::memcmp(&file.rows[task], &expected, sizeof expected), 0) << task;
  }
}

TEST_F(RunTableTest, TakesManyRowsAtOnce) {
  RunTable table = RunTable::create(path(), {});
  std::vector<sweep::RunRow> rows;
  for (int task = 0; task < 1000; ++task) rows.push_back(some_row(task));
  table.append(rows[0]);
  table.append(std::span(rows).subspan(1));
  table.append(std::span<const sweep::RunRow>());
  const SweepFile file = read_sweep(path());
  ASSERT_EQ(file.rows.size(), rows.size());
  EXPECT_EQ(std::memcmp(file.rows.data(), rows.data(), rows.size() * sizeof(sweep::RunRow)), 0);
}

TEST_F(RunTableTest, KeepsTheProvenance) {
  RunTable::create(path(), {{"version", "1.2.3"}, {"config", "a = 1\nb = 2\n"}});
  const SweepFile file = read_sweep(path());
  EXPECT_TRUE(file.rows.empty());
  EXPECT_NE(std::find(file.provenance.begin(), file.provenance.end(),
                      std::pair<std::string, std::string>("config", "a = 1\nb = 2\n")),
            file.provenance.end());
}

TEST_F(RunTableTest, NeverOverwrites) {
  RunTable::create(path(), {}).append(some_row(1));
  EXPECT_THROW(RunTable::create(path(), {}), Error);
  EXPECT_EQ(read_sweep(path()).rows.size(), 1u);
}

TEST_F(RunTableTest, LeavesNothingBehindWhereItCannotWrite) {
  EXPECT_THROW(RunTable::create((folder_ / "no" / "such" / "folder.h5").string(), {}), Error);
  EXPECT_EQ(num_files(), 0u);
  RunTable::create(path(), {});
  EXPECT_EQ(num_files(), 1u) << "no draft is left";
}

/// Leaves by _Exit(2) when a row is refused. A limit on the size of a file stands for a full disk.
[[noreturn]] void append_until_refused(const std::string& path) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{200'000, 200'000};
  setrlimit(RLIMIT_FSIZE, &tight);
  try {
    RunTable table = RunTable::create(path, {});
    for (int task = 0; task < 1000; ++task) table.append(some_row(task));
  } catch (const Error& error) {
    std::fputs(error.what(), stderr);
    std::_Exit(2);
  }
  std::_Exit(0);
}

TEST_F(RunTableTest, KeepsEveryRowBeforeTheDiskIsFull) {
  EXPECT_EXIT(append_until_refused(path()), testing::ExitedWithCode(2), "cannot write .*sweep.h5");
  const SweepFile file = read_sweep(path());
  EXPECT_GT(file.rows.size(), 50u);
  for (std::size_t task = 0; task < file.rows.size(); ++task)
    EXPECT_EQ(file.rows[task].task, static_cast<std::int64_t>(task));
}

TEST_F(RunTableTest, SaysWhatIsWrongWithAFile) {
  EXPECT_NE(refusal(path("missing.h5")).find("no such file"), std::string::npos);
  std::ofstream(path("text.h5")) << "not a table";
  EXPECT_NE(refusal(path("text.h5")).find("not an HDF5 file"), std::string::npos);
  RunTable table = RunTable::create(path(), {});
  for (int i = 0; i < 100; ++i) table.append(some_row(i));
  fs::copy_file(path(), path("torn.h5"));
  fs::resize_file(path("torn.h5"), fs::file_size(path()) / 2);
  EXPECT_NE(refusal(path("torn.h5")).find("cannot open"), std::string::npos) << refusal(path("torn.h5"));
}

}  // namespace
}  // namespace clog::store
