#include "clog/store/journal.hpp"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "clog/core/error.hpp"

namespace clog::store {
namespace {

namespace fs = std::filesystem;

class JournalTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              (std::string("clog_journal_") + info->name() + "_" + std::to_string(getpid()));
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path() const { return (folder_ / "sweep.h5.journal").string(); }

  fs::path folder_;
};

sweep::RunRow some_row(std::int64_t task) {
  sweep::RunRow row;
  row.task = task;
  row.distance = 0.1 * static_cast<double>(task);
  row.host = "node7";
  return row;
}
std::vector<std::byte> some_snapshot(std::size_t size) { return std::vector<std::byte>(size, std::byte{42}); }

void expect_entries(std::vector<Journal::Entry> entries, std::size_t number) {
  ASSERT_EQ(entries.size(), number);
  for (std::size_t i = 0; i < number; ++i) {
    const sweep::RunRow expected = some_row(static_cast<std::int64_t>(i));
    EXPECT_EQ(std::memcmp(&entries[i].row, &expected, sizeof expected), 0);
    EXPECT_EQ(entries[i].snapshot, some_snapshot(100 * i));
  }
}

void add_entries(Journal& journal, std::int64_t begin, std::int64_t end) {
  for (std::int64_t i = begin; i < end; ++i)
    journal.add(some_row(i), some_snapshot(static_cast<std::size_t>(100 * i)));
}

TEST_F(JournalTest, GivesBackWhatWasAdded) {
  {
    Journal journal(path());
    EXPECT_TRUE(journal.take_entries().empty());
    add_entries(journal, 0, 3);
  }
  {
    Journal journal(path());
    expect_entries(journal.take_entries(), 3);
    add_entries(journal, 3, 7);
    journal.flush();
  }
  expect_entries(Journal(path()).take_entries(), 7);
}

TEST_F(JournalTest, DropsATornRecordAndGoesOnWhereItBegan) {
  { add_entries(*std::make_unique<Journal>(path()), 0, 5); }
  const auto whole = fs::file_size(path());
  for (const std::uintmax_t cut :
       {1u, 100u, 400u, 401u, 1000u}) {  // the last record has 400 bytes of snapshot
    { add_entries(*std::make_unique<Journal>(path()), 5, 5); }
    fs::resize_file(path(), whole - cut);
    Journal journal(path());
    expect_entries(journal.take_entries(), 4);
    add_entries(journal, 4, 5);
    EXPECT_EQ(fs::file_size(path()), whole) << cut;
  }
  expect_entries(Journal(path()).take_entries(), 5);
}

TEST_F(JournalTest, DropsWhatIsNotWhatWasWritten) {
  { add_entries(*std::make_unique<Journal>(path()), 0, 5); }
  std::fstream file(path(), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(fs::file_size(path())) - 10);
  file.put('x');
  file.close();
  expect_entries(Journal(path()).take_entries(), 4);
}

TEST_F(JournalTest, RefusesAFileOfAnotherKind) {
  std::ofstream(path()) << "something else, longer than the journal's header is";
  EXPECT_THROW(Journal journal(path()), Error);
  std::string text;
  std::getline(std::ifstream(path()), text);
  EXPECT_EQ(text, "something else, longer than the journal's header is");
}

TEST_F(JournalTest, IsOpenOnlyOnceAndItsLockDiesWithItsProcess) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t other = fork();
  if (other == 0) {
    Journal journal(path());
    add_entries(journal, 0, 2);
    if (write(ready[1], "x", 1) != 1) _exit(1);
    pause();
    _exit(0);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  EXPECT_THROW(Journal journal(path()), Error);
  EXPECT_TRUE(Journal::is_open(path()));
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
  EXPECT_FALSE(Journal::is_open(path()));
  expect_entries(Journal(path()).take_entries(), 2);
  close(ready[0]);
  close(ready[1]);
}

TEST_F(JournalTest, KeepsOnlyWhatItIsRewrittenWith) {
  {
    Journal journal(path());
    add_entries(journal, 10, 20);
    std::vector<Journal::Entry> kept{{some_row(0), {}}, {some_row(1), some_snapshot(100)}};
    const std::vector<const Journal::Entry*> pointers{&kept[0], &kept[1]};
    journal.rewrite(pointers);
    EXPECT_THROW(Journal second(path()), Error) << "it is still locked";
    add_entries(journal, 2, 4);
    EXPECT_EQ(fs::file_size(path()), journal.num_bytes());
  }
  expect_entries(Journal(path()).take_entries(), 4);
}

TEST_F(JournalTest, CanBeRemoved) {
  Journal(path()).remove();
  EXPECT_TRUE(fs::is_empty(folder_));
}

[[noreturn]] void add_until_refused(const std::string& path) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{20'000, 20'000};
  setrlimit(RLIMIT_FSIZE, &tight);
  Journal journal(path);
  try {
    add_entries(journal, 0, 1000);
  } catch (const Error& error) {
    std::fputs(error.what(), stderr);
    std::_Exit(2);
  }
  std::_Exit(0);
}

TEST_F(JournalTest, KeepsWholeRecordsWhenTheDiskIsFull) {
  EXPECT_EXIT(add_until_refused(path()), testing::ExitedWithCode(2), "cannot write .*journal");
  Journal journal(path());
  const std::vector<Journal::Entry> entries = journal.take_entries();
  EXPECT_GT(entries.size(), 5u);
  EXPECT_EQ(fs::file_size(path()), journal.num_bytes());
  expect_entries(entries, entries.size());
}

}  // namespace
}  // namespace clog::store
