#include "clog/store/journal.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <future>
#include <optional>

#include "clog/core/tools/error.hpp"
#include "support.hpp"

namespace clog::store {
namespace {

namespace fs = std::filesystem;

class JournalTest : public FolderTest {
 protected:
  std::string path(const std::string& name = "sweep.h5.journal") const { return FolderTest::path(name); }
  OutputPath place() const { return OutputPath::resolve(path()); }
  /// Overwrites a byte.
  void damage(std::uintmax_t place) const {
    std::fstream file(path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(place));
    file.put('x');
  }
};

sweep::RunRow journal_row(std::int64_t task) {
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
    const sweep::RunRow expected = journal_row(static_cast<std::int64_t>(i));
    EXPECT_EQ(sweep::to_bytes({entries[i].row, {}}), sweep::to_bytes({expected, {}}));
    EXPECT_EQ(entries[i].snapshot, some_snapshot(100 * i));
  }
}

void add_entries(Journal& journal, std::int64_t begin, std::int64_t end) {
  for (std::int64_t i = begin; i < end; ++i)
    journal.add(journal_row(i), some_snapshot(static_cast<std::size_t>(100 * i)));
}

TEST_F(JournalTest, GivesBackWhatWasAdded) {
  {
    Journal journal(place());
    EXPECT_TRUE(journal.take_entries().empty());
    add_entries(journal, 0, 3);
  }
  {
    Journal journal(place());
    expect_entries(journal.take_entries(), 3);
    add_entries(journal, 3, 7);
    journal.flush();
  }
  expect_entries(Journal(place()).take_entries(), 7);
}

TEST_F(JournalTest, DropsATornRecordAndGoesOnWhereItBegan) {
  { add_entries(*std::make_unique<Journal>(place()), 0, 5); }
  const auto whole = fs::file_size(path());
  for (const std::uintmax_t cut :
       {1u, 100u, 400u, 401u, 1000u}) {  // the last record has a snapshot of 400 bytes
    { add_entries(*std::make_unique<Journal>(place()), 5, 5); }
    fs::resize_file(path(), whole - cut);
    Journal journal(place());
    expect_entries(journal.take_entries(), 4);
    add_entries(journal, 4, 5);
    EXPECT_EQ(fs::file_size(path()), whole) << cut;
  }
  expect_entries(Journal(place()).take_entries(), 5);
}

TEST_F(JournalTest, DropsWhatIsNotWhatWasWritten) {
  { add_entries(*std::make_unique<Journal>(place()), 0, 5); }
  damage(fs::file_size(path()) - 10);
  Journal journal(place());
  expect_entries(journal.take_entries(), 4);
  EXPECT_EQ(journal.num_unreadable(), 0) << "the last one may be torn";
}

TEST_F(JournalTest, CountsARecordWithAWordThatNoColumnCanHold) {
  {
    Journal journal(place());
    add_entries(journal, 0, 2);
    sweep::RunRow row = journal_row(2);
    row.hold.mechanism = ClogMechanism{99};
    journal.add(row, {});
  }
  Journal journal(place());
  expect_entries(journal.take_entries(), 2);
  EXPECT_EQ(journal.num_unreadable(), 1);
}

TEST_F(JournalTest, LosesNoOtherRecordToADamagedOne) {
  std::vector<std::uintmax_t> begins;  // of the records
  {
    Journal journal(place());
    for (std::int64_t i = 0; i < 5; ++i) {
      begins.push_back(journal.num_bytes());
      add_entries(journal, i, i + 1);
    }
  }
  const std::string whole = text_of("sweep.h5.journal");
  struct Case {
    const char* what;
    std::vector<std::uintmax_t> places;
    std::vector<std::int64_t> tasks;  // the tasks of the remaining records
  };
  for (const Case& damaged :
       {Case{"a row", {begins[1] + 100}, {0, 2, 3, 4}}, Case{"a size", {begins[1] + 1}, {0, 2, 3, 4}},
        Case{"a magic word", {begins[1] + 12}, {0, 2, 3, 4}},
        Case{"neighbours", {begins[1] + 100, begins[2] + 100}, {0, 3, 4}},
        Case{"two", {begins[0] + 100, begins[2] + 100}, {1, 3, 4}}}) {
    write_text("sweep.h5.journal", whole);
    for (const std::uintmax_t place : damaged.places) damage(place);
    Journal journal(place());
    std::vector<std::int64_t> tasks;
    for (const Journal::Entry& entry : journal.take_entries()) tasks.push_back(entry.row.task);
    EXPECT_EQ(tasks, damaged.tasks) << damaged.what;
    EXPECT_EQ(journal.num_unreadable(), 5 - static_cast<std::int64_t>(tasks.size())) << damaged.what;
  }
}

TEST_F(JournalTest, CanBeLookedAtWhileItIsWrittenTo) {
  EXPECT_FALSE(Journal::look(path()));
  Journal journal(place());
  add_entries(journal, 0, 5);
  fs::resize_file(path(), fs::file_size(path()) - 1);
  const Journal::Contents contents = Journal::look(path()).value();
  expect_entries(contents.entries, 4);
  EXPECT_TRUE(contents.has_torn_end);
  EXPECT_EQ(fs::file_size(path()), journal.num_bytes() - 1) << "it stays as it is";
}

TEST_F(JournalTest, RefusesAFileOfAnotherKind) {
  for (const std::string text : {"something else, longer than the journal's header is", "short"}) {
    write_text("sweep.h5.journal", text);
    EXPECT_THROW(Journal journal(place()), Error);
    EXPECT_THROW(Journal::look(path()), Error);
    EXPECT_EQ(text_of("sweep.h5.journal"), text);
  }
}

TEST_F(JournalTest, BeginsAnewWhereItsMakerDiedAtOnce) {
  { add_entries(*std::make_unique<Journal>(place()), 0, 1); }
  for (const std::uintmax_t size : {0u, 5u, 23u}) {
    fs::resize_file(path(), size);
    Journal journal(place());
    EXPECT_TRUE(journal.take_entries().empty());
    add_entries(journal, 0, 2);
  }
  expect_entries(Journal(place()).take_entries(), 2);
}

TEST_F(JournalTest, LeavesNoFileWithoutRecords) {
  { Journal journal(place()); }
  EXPECT_EQ(num_files(), 0);
  EXPECT_EXIT(run_on_full_disk(10, [&] { Journal journal(place()); }), testing::ExitedWithCode(2),
              "cannot write .*journal");
  EXPECT_EQ(num_files(), 0);
}

TEST_F(JournalTest, RemovesItsStaleDraftsAndNoOthers) {
  write_text("sweep.h5.journal.clogsweep-draft1", "a user's notes");
  write_text("sweep.h5.journal.clogsweep-draft2", "clogsweep jrnl of a process that was killed");
  Journal journal(place());
  EXPECT_EQ(num_files(), 2);
  journal.rewrite({});
  EXPECT_EQ(text_of("sweep.h5.journal.clogsweep-draft1"), "a user's notes");
  EXPECT_EQ(num_files(), 2);
}

TEST_F(JournalTest, IsRewrittenOnlyWhenItHasDoubled) {
  const Journal::Entry large{journal_row(0), some_snapshot(70'000'000)};
  const std::vector<const Journal::Entry*> needed{&large};
  Journal journal(place());
  EXPECT_FALSE(journal.is_to_be_rewritten());
  journal.add(large.row, large.snapshot);
  EXPECT_TRUE(journal.is_to_be_rewritten());
  journal.rewrite(needed);
  EXPECT_FALSE(journal.is_to_be_rewritten());
  journal.add(journal_row(1), some_snapshot(60'000'000));
  EXPECT_FALSE(journal.is_to_be_rewritten());
  journal.add(journal_row(1), some_snapshot(20'000'000));
  EXPECT_TRUE(journal.is_to_be_rewritten());
}

TEST_F(JournalTest, LiesBesideTheFileThatALinkLeadsTo) {
  fs::create_directory(path("scratch"));
  fs::create_symlink("scratch/target.h5", path("link.h5"));
  EXPECT_EQ(journal_path(path("link.h5")), path("scratch/target.h5.journal"));
  EXPECT_EQ(journal_path(path("sweep.h5")), path());
}

TEST_F(JournalTest, IsReadByThoseWhoMayReadItsTable) {
  const std::string table = path("sweep.h5");
  write_text("sweep.h5", "a table");
  for (const fs::perms mode : {fs::perms{0600}, fs::perms{0640}, fs::perms{0666}}) {
    fs::permissions(table, mode);
    const OutputPath table_place = OutputPath::resolve(table);
    Journal journal(journal_place(table_place), &table_place);
    EXPECT_EQ(fs::status(path()).permissions(), mode);
    add_entries(journal, 0, 2);
    const Journal::Entry entry{journal_row(0), {}};
    const std::vector<const Journal::Entry*> one{&entry};
    journal.rewrite(one);
    EXPECT_EQ(fs::status(path()).permissions(), mode) << "rewritten";
    fs::remove(path());
    EXPECT_TRUE(journal.recreate(table_place));
    EXPECT_EQ(fs::status(path()).permissions(), mode) << "made anew";
    journal.remove();
  }
}

TEST_F(JournalTest, IsOpenOnlyOnceAndItsLockDiesWithItsProcess) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t other = fork();
  if (other == 0) {
    Journal journal(place());
    add_entries(journal, 0, 2);
    if (write(ready[1], "x", 1) != 1) _exit(1);
    pause();
    _exit(0);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  EXPECT_THROW(Journal journal(place()), Error);
  EXPECT_TRUE(Journal::is_open(path()));
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
  EXPECT_FALSE(Journal::is_open(path()));
  expect_entries(Journal(place()).take_entries(), 2);
  close(ready[0]);
  close(ready[1]);
}

TEST_F(JournalTest, KeepsOnlyWhatItIsRewrittenWith) {
  {
    Journal journal(place());
    add_entries(journal, 10, 20);
    std::vector<Journal::Entry> kept{{journal_row(0), {}}, {journal_row(1), some_snapshot(100)}};
    const std::vector<const Journal::Entry*> pointers{&kept[0], &kept[1]};
    journal.rewrite(pointers);
    EXPECT_THROW(Journal second(place()), Error) << "it is still locked";
    add_entries(journal, 2, 4);
    EXPECT_EQ(fs::file_size(path()), journal.num_bytes());
  }
  expect_entries(Journal(place()).take_entries(), 4);
}

TEST_F(JournalTest, LosesNoRecordThatComesWhileItIsRewritten) {
  {
    Journal journal(place());
    add_entries(journal, 3, 7);
    const std::uint64_t end = journal.num_bytes();
    add_entries(journal, 1, 50);
    const Journal::Entry kept{journal_row(0), {}};
    auto preparing = std::async([&] { journal.prepare(std::vector{&kept}, end); });
    add_entries(journal, 50, 100);
    preparing.get();
    add_entries(journal, 100, 110);
    journal.replace();
    add_entries(journal, 110, 112);
    EXPECT_EQ(fs::file_size(path()), journal.num_bytes());
  }
  expect_entries(Journal(place()).take_entries(), 112);
}

TEST_F(JournalTest, LeavesOutARecordThatAFullDiskUndoesWhileItIsRewritten) {
  {
    Journal journal(place());
    add_entries(journal, 0, 3);
    const std::uint64_t end = journal.num_bytes();
    std::ofstream(path(), std::ios::app) << std::string(5000, 'x');  // half a record
    journal.prepare({}, end);
    fs::resize_file(path(), end);
    journal.replace();
    add_entries(journal, 0, 3);
  }
  Journal journal(place());
  EXPECT_EQ(journal.num_unreadable(), 0);
  expect_entries(journal.take_entries(), 3);
}

TEST_F(JournalTest, CanBeRemoved) {
  Journal journal(place());
  add_entries(journal, 0, 1);
  journal.remove();
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(JournalTest, StopsWhenItsFileIsNoLongerInTheFolder) {
  Journal first(place());
  fs::remove(path());
  {
    Journal second(place());
    EXPECT_THROW(add_entries(first, 0, 1), Error);
    EXPECT_THROW(first.flush(), Error);
    EXPECT_THROW(first.rewrite({}), Error);
    add_entries(second, 0, 2);
    first.remove();
  }
  expect_entries(Journal(place()).take_entries(), 2);
}

TEST_F(JournalTest, IsARegularFile) {
  ASSERT_EQ(mkfifo(path().c_str(), 0600), 0);
  EXPECT_THROW(Journal journal(place()), Error);
  EXPECT_THROW(Journal::look(path()), Error);
  EXPECT_THROW(Journal::is_open(path()), Error);
}

TEST_F(JournalTest, KeepsWholeRecordsWhenTheDiskIsFull) {
  const auto add_until_refused = [&] {
    Journal journal(place());
    add_entries(journal, 0, 1000);
  };
  EXPECT_EXIT(run_on_full_disk(20'000, add_until_refused), testing::ExitedWithCode(2),
              "cannot write .*journal");
  Journal journal(place());
  const std::vector<Journal::Entry> entries = journal.take_entries();
  EXPECT_GT(entries.size(), 5u);
  EXPECT_EQ(fs::file_size(path()), journal.num_bytes());
  expect_entries(entries, entries.size());
}

}  // namespace
}  // namespace clog::store
