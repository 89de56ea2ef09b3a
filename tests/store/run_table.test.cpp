#include "clog/store/run_table.hpp"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/messages.hpp"
#include "support.hpp"

namespace clog::store {
namespace {

namespace fs = std::filesystem;

class RunTableTest : public FolderTest {
 protected:
  std::string path(const std::string& name = "sweep.h5") const { return FolderTest::path(name); }
};

sweep::RunRow some_row(std::int64_t task) {
  sweep::RunRow row = sweep::describe(resolve(RunParameters{}));
  row.task = task;
  row.status = RunStatus::clogged;
  row.distance = 1.0 / 3 + static_cast<double>(task);
  row.speed.mean = std::nan("");
  row.message = "some words";
  row.host = "node7";
  return row;
}

std::string reading_refusal(const std::string& path) {
  try {
    read_sweep(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::vector<sweep::RunRow> some_rows(int number) {
  std::vector<sweep::RunRow> rows;
  rows.reserve(number);
  for (int task = 0; task < number; ++task) rows.push_back(some_row(task));
  return rows;
}

TEST_F(RunTableTest, GivesBackFamilies) {
  std::vector<sweep::RunRow> rows = some_rows(3);
  rows[1].family.resize(3);
  rows[1].family[0].status = MemberEnd::broken;
  rows[1].family[1] = {.path = "0",
                       .diameter = 0.6,
                       .birth = {1, 2, 3},
                       .end = {4, 5, 6},
                       .status = MemberEnd::small,
                       .mechanism = ClogMechanism::none};
  rows[1].family[2].path = "1";
  rows[1].family[2].mechanism = ClogMechanism::wrapped;
  publish(path(), rows, {});
  const SweepFile file = read_sweep(path());
  EXPECT_TRUE(file.rows[0].family.empty());
  ASSERT_EQ(file.rows[1].family.size(), 3);
  const Member& member = file.rows[1].family[1];
  EXPECT_EQ(member.path, "0");
  EXPECT_EQ(member.diameter, 0.6);
  EXPECT_EQ(member.end.lateral, 5);
  EXPECT_EQ(member.status, MemberEnd::small);
  EXPECT_EQ(file.rows[1].family[2].mechanism, ClogMechanism::wrapped);
}

TEST_F(RunTableTest, GivesBackEveryRowBitForBit) {
  for (const int number : {0, 1, 200, 1000}) {  // each table replaces the previous table
    const std::vector<sweep::RunRow> rows = some_rows(number);
    publish(path(), rows, {{"version", "1.2.3"}, {"empty", ""}});
    const SweepFile file = read_sweep(path());
    ASSERT_EQ(file.rows.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      EXPECT_EQ(sweep::to_bytes({file.rows[i], {}}), sweep::to_bytes({rows[i], {}}));
    EXPECT_EQ(num_files(), 1) << "no draft is left";
  }
}

TEST_F(RunTableTest, KeepsCirclesOfAUsersOwn) {
  const std::vector<CircleFile> circles = {{"one.csv", OwnCircles({{1.0 / 3, 2, 0}, {4, 5, 0.25}})},
                                           {"", OwnCircles({{1, 2, 3}})}};
  publish(path(), some_rows(2), {{"config", "a = 1\n"}}, circles);
  const SweepFile file = read_sweep(path());
  EXPECT_EQ(file.checked, Checked::everything);
  ASSERT_EQ(file.circles.size(), 2u);
  for (const CircleFile& one : circles)
    EXPECT_TRUE(std::ranges::any_of(file.circles, [&](const CircleFile& other) {
      return other.name == one.name && other.circles.circles() == one.circles.circles();
    })) << one.name;
}

TEST_F(RunTableTest, IsTheSameFromRowsThatAreGivenOneByOne) {
  const std::vector<sweep::RunRow> rows = some_rows(2500);  // enough rows for several blocks
  std::size_t next = 0;
  const auto row = [&](std::size_t i) {
    EXPECT_EQ(i, next++);
    return rows[i];
  };
  EXPECT_TRUE(publish_sweep(OutputPath::resolve(path("parts.h5")), "", {rows.size(), row},
                            {{"config", "a = 1\n"}}, {}));
  EXPECT_EQ(next, rows.size());
  const std::vector<sweep::RunRow> stored = read_sweep(path("parts.h5")).rows;
  ASSERT_EQ(stored.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    EXPECT_EQ(sweep::to_bytes({stored[i], {}}), sweep::to_bytes({rows[i], {}}));
}

TEST_F(RunTableTest, KeepsTheProvenance) {
  publish(path(), {}, {{"version", "1.2.3"}, {"config", "a = 1\nb = 2\n"}});
  const SweepFile file = read_sweep(path());
  EXPECT_TRUE(file.rows.empty());
  EXPECT_NE(std::find(file.provenance.begin(), file.provenance.end(),
                      std::pair<std::string, std::string>("config", "a = 1\nb = 2\n")),
            file.provenance.end());
}

TEST_F(RunTableTest, LeavesNothingBehindWhereItCannotWrite) {
  EXPECT_THROW(publish((folder_ / "no" / "such" / "folder.h5").string(), {}, {}), Error);
  EXPECT_EQ(num_files(), 0);
  for (const rlim_t num_bytes : {0, 10, 1000})
    EXPECT_EXIT(run_on_full_disk(num_bytes, [&] { publish(path(), some_rows(1), {}); }),
                testing::ExitedWithCode(2), "cannot .*sweep.h5");
  EXPECT_EQ(num_files(), 0);
}

TEST_F(RunTableTest, IsPublishedOnlyInPlaceOfTheFileThatIsKnown) {
  publish(path(), some_rows(1), {});
  const OutputPath place = OutputPath::resolve(path());
  const std::string stamp = place.stamp();
  EXPECT_TRUE(publish_sweep(place, stamp, {some_rows(2), {}, {}}));
  EXPECT_EQ(read_sweep(path()).rows.size(), 2u);
  // Another user has moved another file to this name.
  write_text("other", "another's");
  fs::rename(path("other"), path());
  EXPECT_FALSE(publish_sweep(place, stamp, {some_rows(3), {}, {}}));
  EXPECT_FALSE(publish_sweep(place, "", {some_rows(3), {}, {}}));
  EXPECT_EQ(text_of("sweep.h5"), "another's");
  fs::remove(path());
  EXPECT_TRUE(publish_sweep(place, stamp, {some_rows(4), {}, {}}));
  EXPECT_EQ(read_sweep(path()).rows.size(), 4u);
  EXPECT_EQ(num_files(), 1) << "no draft is left";
}

TEST_F(RunTableTest, IsTheSameUnderAnotherInode) {
  // Some network file systems change the inode of a file after a while.
  publish(path(), some_rows(2), {});
  const OutputPath place = OutputPath::resolve(path());
  const std::string stamp = place.stamp();
  fs::rename(path(), path("earlier.h5"));
  fs::copy_file(path("earlier.h5"), path());
  EXPECT_EQ(place.stamp(), stamp);
  EXPECT_TRUE(publish_sweep(place, stamp, {some_rows(3), {}, {}}));
  EXPECT_NE(place.stamp(), stamp);
}

TEST_F(RunTableTest, RemovesItsStaleDraftsAndNoOthers) {
  write_text("sweep.h5.new", "a user's");
  write_text("sweep.h5.clogsweep-draft1", "also a user's");
  write_text("sweep.h5.clogsweep-draft2", "\x89HDF\r\n\x1a\n of a process that was killed");
  publish(path(), some_rows(2), {});
  EXPECT_EQ(read_sweep(path()).rows.size(), 2u);
  EXPECT_EQ(text_of("sweep.h5.new"), "a user's");
  EXPECT_EQ(text_of("sweep.h5.clogsweep-draft1"), "also a user's");
  EXPECT_EQ(num_files(), 3);
}

TEST_F(RunTableTest, LeavesTheDraftOfALivingProcessAlone) {
  const std::string mark = "\x89HDF\r\n\x1a\n of a process that lives";
  const std::string name = write_text("sweep.h5.clogsweep-draft1", mark);
  const int descriptor = open(name.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(flock(descriptor, LOCK_EX), 0);
  publish(path(), some_rows(2), {});
  EXPECT_EQ(text_of("sweep.h5.clogsweep-draft1"), mark);
  close(descriptor);
}

TEST_F(RunTableTest, UpdatesTheFileThatALinkLeadsTo) {
  fs::create_directory(path("scratch"));
  fs::create_symlink("scratch/target.h5", path());
  for (const int number : {1, 2}) {  // the first time the link points to no file
    publish(path(), some_rows(number), {});
    EXPECT_TRUE(fs::is_symlink(path()));
    EXPECT_EQ(read_sweep(path("scratch/target.h5")).rows.size(), static_cast<std::size_t>(number));
    EXPECT_EQ(num_files(), 2);
  }
  fs::create_symlink("loop.h5", path("loop.h5"));
  EXPECT_THROW(publish(path("loop.h5"), {}, {}), Error);
}

TEST_F(RunTableTest, IsWholeForAReaderAtEveryMoment) {
  publish(path(), some_rows(1), {});
  const pid_t writer = fork();
  if (writer == 0) {
    for (int number = 2; number < 150; ++number) publish(path(), some_rows(number), {});
    _exit(0);
  }
  int num_reads = 0;
  for (std::size_t before = 1; waitpid(writer, nullptr, WNOHANG) == 0; ++num_reads) {
    const std::size_t now = read_sweep(path()).rows.size();
    EXPECT_GE(now, before);
    before = now;
  }
  EXPECT_GT(num_reads, 3);
  EXPECT_EQ(read_sweep(path()).rows.size(), 149u);
}

TEST_F(RunTableTest, IsNeverLockedWhereReadersLookForIt) {
  // In h5py and pandas, HDF5 locks a file before reading it.
  publish(path(), some_rows(1), {});
  const pid_t writer = fork();
  if (writer == 0) {
    for (int number = 2; number < 150; ++number) publish(path(), some_rows(number), {});
    _exit(0);
  }
  int num_locked = 0, num_looks = 0;
  for (; waitpid(writer, nullptr, WNOHANG) == 0; ++num_looks) {
    const int file = open(path().c_str(), O_RDONLY);
    ASSERT_GE(file, 0);
    num_locked += flock(file, LOCK_SH | LOCK_NB) != 0;
    close(file);
  }
  EXPECT_GT(num_looks, 100);
  EXPECT_EQ(num_locked, 0);
}

TEST_F(RunTableTest, KeepsTheLastTableWhenTheDiskIsFull) {
  const auto publish_until_refused = [&] {
    for (int number = 0; number < 1000; ++number) publish(path(), some_rows(number), {});
  };
  EXPECT_EXIT(run_on_full_disk(200'000, publish_until_refused), testing::ExitedWithCode(2),
              "cannot write .*sweep.h5");
  const SweepFile file = read_sweep(path());
  EXPECT_GT(file.rows.size(), 50u);
  for (std::size_t task = 0; task < file.rows.size(); ++task)
    EXPECT_EQ(file.rows[task].task, static_cast<std::int64_t>(task));
  EXPECT_EQ(num_files(), 1);
}

TEST_F(RunTableTest, SaysWhatIsWrongWithAFile) {
  EXPECT_NE(reading_refusal(path("missing.h5")).find("no such file"), std::string::npos);
  std::ofstream(path("text.h5")) << "not a table";
  EXPECT_NE(reading_refusal(path("text.h5")).find("not an HDF5 file"), std::string::npos);
  publish(path(), some_rows(100), {});
  fs::copy_file(path(), path("torn.h5"));
  fs::resize_file(path("torn.h5"), fs::file_size(path()) / 2);
  EXPECT_NE(reading_refusal(path("torn.h5")).find("damaged"), std::string::npos)
      << reading_refusal(path("torn.h5"));
  EXPECT_NE(reading_refusal(folder_.string()).find("not a regular file"), std::string::npos);
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_NE(reading_refusal(path("pipe")).find("not a regular file"), std::string::npos)
      << "it does not wait";
}

/// Flips one bit of a file's content.
std::string flipped(std::string content, std::size_t byte) {
  content[byte] = static_cast<char>(content[byte] ^ (1 << byte % 8));
  return content;
}

constexpr std::size_t seal_size = 64;  // docs/reference/files.md

TEST_F(RunTableTest, NoticesEveryFlippedBit) {
  publish(path(), some_rows(3), {{"config", "a = 1\n"}});
  const std::string content = text_of("sweep.h5");
  const std::size_t seal = content.size() - seal_size;
  for (std::size_t byte = 0; byte < content.size(); byte += byte < seal ? 307 : 1) {
    write_text("flipped.h5", flipped(content, byte));
    try {
      EXPECT_EQ(read_sweep(path("flipped.h5")).checked, Checked::rows_and_settings) << byte;
      EXPECT_GE(byte, seal) << "only one that hides the seal goes by with a word of caution";
    } catch (const Error&) {
      // refused, as expected
    }
  }
}

TEST_F(RunTableTest, GivesNoWrongRowOfACopyWithoutASeal) {
  const std::vector<sweep::RunRow> rows = some_rows(3);
  publish(path(), rows, {{"config", "a = 1\n"}});
  const std::string content = text_of("sweep.h5").substr(0, fs::file_size(path()) - seal_size);
  write_text("copy.h5", content);
  EXPECT_EQ(read_sweep(path("copy.h5")).checked, Checked::rows_and_settings);
  EXPECT_NE(caution("copy.h5", read_sweep(path("copy.h5"))), "");
  int num_noticed = 0, num_harmless = 0;
  for (std::size_t byte = 0; byte < content.size(); byte += 499) {
    write_text("flipped.h5", flipped(content, byte));
    try {
      const SweepFile file = read_sweep(path("flipped.h5"));
      ASSERT_EQ(file.rows.size(), rows.size()) << byte;
      for (std::size_t i = 0; i < rows.size(); ++i)
        EXPECT_EQ(sweep::to_bytes({file.rows[i], {}}), sweep::to_bytes({rows[i], {}})) << byte;
      EXPECT_EQ(file.provenance, read_sweep(path()).provenance) << byte;
      ++num_harmless;
    } catch (const Error&) {
      ++num_noticed;
    }
  }
  EXPECT_GT(num_noticed, 5);
  EXPECT_GT(num_harmless, 20) << "most of a chunk is empty";
}

TEST_F(RunTableTest, LosesNoAttributeByADamagedListOfChecksums) {
  publish(path(), some_rows(1), {{"config", "a = 1\n"}, {"num_wanted", "12"}});
  const std::string content = text_of("sweep.h5").substr(0, fs::file_size(path()) - seal_size);
  const std::string_view mark = " num_wanted\n";
  const std::size_t end = content.find(mark) + mark.size();
  ASSERT_NE(content.find(mark), std::string::npos);
  constexpr std::size_t line_size = 8;
  for (std::size_t byte = end - mark.size() - line_size; byte < end; ++byte)
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = content;
      damaged[byte] = static_cast<char>(damaged[byte] ^ (1 << bit));
      write_text("damaged.h5", damaged);
      // Two kinds of flipped bits leave the list valid: bits of the blank between digits and name, and bits
      // that change the case of a letter in a hexadecimal number.
      try {
        EXPECT_EQ(read_sweep(path("damaged.h5")).provenance, read_sweep(path()).provenance)
            << byte << ' ' << bit;
      } catch (const Error&) {
        // the damage was noticed
      }
    }
}

TEST_F(RunTableTest, TellsWholeRowsFromDamagedOnes) {
  publish(path(), some_rows(100), {{"config", "a = 1\n"}, {"version", "1"}});
  std::string content = text_of("sweep.h5");
  const double distance = some_row(70).distance;
  const std::size_t place =
      content.find(std::string(reinterpret_cast<const char*>(&distance), sizeof distance));
  ASSERT_NE(place, std::string::npos);
  content = flipped(content, place);
  content.replace(content.find("a = 1\n"), 5, "a = 2");
  write_text("damaged.h5", content);
  const Examination found = examine_sweep(path("damaged.h5"));
  ASSERT_EQ(found.damage.size(), 2u);
  EXPECT_NE(found.damage[0].find("row 70 (task 70)"), std::string::npos) << found.damage[0];
  EXPECT_NE(found.damage[1].find("attribute config"), std::string::npos) << found.damage[1];
  EXPECT_EQ(found.whole.rows.size(), 99u);
  EXPECT_EQ(found.whole.provenance, (Provenance{{"version", "1"}}));
  EXPECT_NE(reading_refusal(path("damaged.h5")).find("row 70 (task 70) is not as it was written, and 1 more"),
            std::string::npos)
      << reading_refusal(path("damaged.h5"));
}

}  // namespace
}  // namespace clog::store
