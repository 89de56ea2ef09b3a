#include "clog/results/sweep_state.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "../store/support.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/results/merger.hpp"
#include "clog/results/salvage.hpp"
#include "clog/store/journal.hpp"
#include "clog/store/run_table.hpp"

namespace {

/// Simulates another user who moves a file onto the sweep's file. The move takes place when the program
/// synchronises the folder after it has renamed the sweep's file.
struct Move {
  std::filesystem::path from, to;
};
std::optional<Move> move_at_sync_of_folder;
/// While is_disk_slow is true, fsync() of a draft of a table or a journal waits.
std::atomic<bool> is_disk_slow = false, is_draft_waiting = false;

bool is_draft(int descriptor) {
  std::error_code none;
  const auto path = std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), none);
  return path.string().find("draft") != std::string::npos;
}

}  // namespace

/// Replaces the system's fsync() in this test program.
extern "C" int our_fsync(int descriptor) __asm__("fsync");
int our_fsync(int descriptor) {
  for (; is_disk_slow && is_draft(descriptor); is_draft_waiting = true) usleep(1000);
  struct stat status {};
  if (move_at_sync_of_folder && std::filesystem::exists(move_at_sync_of_folder->to) &&
      fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode)) {
    std::filesystem::rename(move_at_sync_of_folder->from, move_at_sync_of_folder->to);
    move_at_sync_of_folder.reset();
  }
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}

namespace clog::results {
namespace {

/// Tests the state of a sweep of two runs. The tests open the state repeatedly, as if the sweep had been
/// killed and resumed.
class SweepStateTest : public testing::Test {
 protected:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("clog_sweep_state_" + std::to_string(::getpid()));
  sweep::Settings settings_ = [] {
    sweep::Settings settings;
    settings.set("seeds", "1..2");
    return settings;
  }();
  sweep::Plan plan_{settings_};

  void SetUp() override { std::filesystem::create_directory(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path() const { return (folder_ / "s.h5").string(); }

  SweepState open(std::int64_t attempts = 1) {
    return SweepState(path(), plan_, settings_, {{"config", settings_.to_config()}}, 2, attempts);
  }
  static sweep::Report report(const SweepState& state, std::int64_t task, RunStatus status, double distance,
                              std::vector<std::byte> snapshot = {}) {
    sweep::Report report{state.row(task), std::move(snapshot)};
    sweep::RunRow& row = report.row;
    row.status = status;
    row.distance = distance;
    row.steps = 1'000'000;
    row.time = static_cast<double>(row.steps) * *row.parameters.time_step;
    row.shape_parameter = 1.2;
    if (row.status == RunStatus::clogged) {
      row.clogged_by = FoundBy::certified;
      row.stability = Stability::stable;
    }
    if (row.status == RunStatus::failed) {
      row.failed_by = FailedBy::crash;
      row.message = "its process was killed";
    }
    return report;
  }
  const std::vector<std::byte> snapshot_{10, std::byte{7}};
};

TEST_F(SweepStateTest, GoesOnFromTheSnapshotOfARunWhoseFailureWasWithdrawn) {
  {
    SweepState state = open();
    state.start(0, 1);
    state.report(report(state, 0, RunStatus::failed, std::nan("")));
    state.withdraw_failure(0);
    state.start(0, 0);
    state.report(report(state, 0, RunStatus::running, 3.5, snapshot_));
  }
  SweepState state = open();
  EXPECT_EQ(state.tasks_left(), (std::vector<std::int64_t>{0, 1}));
  EXPECT_EQ(state.num_resumed(), 1);
  EXPECT_EQ(state.start(0, 0).snapshot, snapshot_);
  EXPECT_EQ(state.row(0).distance, 3.5);
}

TEST_F(SweepStateTest, GivesARestartedRunTheInstructionSetOfItsNewStart) {
  const auto report_under = [&](SweepState& state, const char* instruction_set, RunStatus status,
                                const std::vector<std::byte>& snapshot) {
    sweep::Report sent = report(state, 0, status, 3.5, snapshot);
    sent.row.instruction_set = instruction_set;
    state.report(sent);
    return state.row(0).instruction_set;
  };
  {
    SweepState state = open();
    state.start(0, 1);
    report_under(state, "avx2", RunStatus::running, snapshot_);
  }
  SweepState state = open();
  state.start(0, 1);
  EXPECT_EQ(report_under(state, "baseline", RunStatus::running, snapshot_), "mixed");
  state.restarted(0);
  EXPECT_EQ(report_under(state, "baseline", RunStatus::clogged, {}), "baseline");
}

TEST_F(SweepStateTest, TakesNoDistanceFromAnAttemptThatDoesNotCount) {
  SweepState state = open();
  state.start(0, 1);
  sweep::Report failed = report(state, 0, RunStatus::failed, std::nan(""));
  failed.row.wall_seconds = 3;
  state.report(failed);
  state.withdraw_failure(0);
  EXPECT_EQ(state.row(0).status, RunStatus::interrupted);
  EXPECT_EQ(state.row(0).distance, 0);
  EXPECT_EQ(state.row(0).message, "");
  EXPECT_EQ(state.row(0).wall_seconds, 3);
  EXPECT_EQ(state.start(0, 0).attempt, 1);
}

TEST_F(SweepStateTest, KeepsAFailureThatCounts) {
  {
    SweepState state = open();
    state.start(1, 0);
    state.report(report(state, 1, RunStatus::failed, 0));
  }
  EXPECT_EQ(open().tasks_left(), std::vector<std::int64_t>{0});
  EXPECT_EQ(open(2).tasks_left(), (std::vector<std::int64_t>{0, 1}));
}

TEST_F(SweepStateTest, KeepsAFailureThatNoRetryCanChange) {
  for (const FailedBy cause : {FailedBy::divergence, FailedBy::crossing, FailedBy::crash}) {
    std::filesystem::remove(path());
    std::filesystem::remove(store::journal_path(path()));
    {
      SweepState state = open(3);
      state.start(0, 0);
      sweep::Report failed = report(state, 0, RunStatus::failed, 0);
      failed.row.failed_by = cause;
      failed.row.sound_distance = 0.5;
      state.report(failed);
      EXPECT_EQ(state.tries_again(failed.row), cause == FailedBy::crash);
      state.finish();
    }
    const sweep::RunRow shown = store::read_sweep(path()).rows.at(0);
    EXPECT_EQ(shown.status, cause == FailedBy::crash ? RunStatus::interrupted : RunStatus::failed);
    EXPECT_EQ(shown.sound_distance, cause == FailedBy::crash ? 0 : 0.5);
    EXPECT_EQ(open(3).tasks_left().size(), cause == FailedBy::crash ? 2u : 1u);
  }
}

TEST_F(SweepStateTest, ShowsAFailureToReadersOnceItsAttemptsAreUsedUp) {
  SweepState state = open(2);
  const auto shown = [&] {
    state.finish();
    return store::read_sweep(path()).rows.at(0);
  };
  state.start(0, 0);
  state.report(report(state, 0, RunStatus::failed, std::nan("")));
  EXPECT_EQ(shown().status, RunStatus::interrupted);
  EXPECT_EQ(shown().attempt, 2);
  EXPECT_EQ(shown().message, "");
  EXPECT_EQ(shown().distance, 0);
  state.start(0, 0);
  EXPECT_EQ(shown().status, RunStatus::running);
  state.report(report(state, 0, RunStatus::failed, std::nan("")));
  EXPECT_EQ(shown().status, RunStatus::failed);
  EXPECT_EQ(shown().attempt, 2);
  EXPECT_EQ(shown().message, "its process was killed");
}

TEST_F(SweepStateTest, CountsAnAttemptThatFailedThoughReadersDoNotSeeIt) {
  {
    SweepState state = open(2);
    state.start(0, 0);
    state.report(report(state, 0, RunStatus::failed, 0));
    state.finish();
  }
  EXPECT_EQ(open(2).start(0, 0).attempt, 2);
  std::filesystem::remove(store::journal_path(path()));
  EXPECT_EQ(open(2).start(0, 0).attempt, 2);
}

TEST_F(SweepStateTest, ComputesARunAgainWhoseRowHoldsWhatCannotBe) {
  {
    SweepState state = open();
    for (const std::int64_t task : {0, 1}) {
      state.start(task, 0);
      state.report(report(state, task, RunStatus::clogged, 2));
    }
    state.finish();
  }
  store::SweepFile file = store::read_sweep(path());
  file.rows[1].distance = 1e308;
  std::erase_if(file.provenance, [](const auto& attribute) {
    return attribute.first == "kind" || attribute.first == "format_version" ||
           attribute.first == "num_columns";
  });
  store::publish(path(), file.rows, file.provenance);
  SweepState state = open();
  EXPECT_EQ(state.num_faulty(), 1);
  EXPECT_EQ(state.tasks_left(), std::vector<std::int64_t>{1});
  EXPECT_EQ(store::read_sweep(path()).rows.size(), 1u);
}

TEST_F(SweepStateTest, KeepsTheFirstRowOfARunThatItsTableRepeats) {
  {
    SweepState state = open();
    state.start(0, 0);
    state.report(report(state, 0, RunStatus::clogged, 2));
    state.finish();
  }
  store::SweepFile file = store::read_sweep(path());
  file.rows.push_back(file.rows.front());
  file.rows.back().distance = 3;
  std::erase_if(file.provenance, [](const auto& attribute) {
    return attribute.first == "kind" || attribute.first == "format_version" ||
           attribute.first == "num_columns";
  });
  store::publish(path(), file.rows, file.provenance);
  SweepState state = open();
  EXPECT_EQ(state.row(0).distance, 2);
  EXPECT_EQ(store::read_sweep(path()).rows.size(), 1U);
}

TEST_F(SweepStateTest, RefusesARowOfAnotherRunThanTheTasks) {
  {
    SweepState state = open();
    state.start(0, 0);
    state.start(1, 0);
    sweep::Report other = report(state, 0, RunStatus::clogged, 2);
    other.row.parameters.dp.line_tension *= 2;
    EXPECT_THROW(state.report(other), Error);
    sweep::Report exchanged = report(state, 0, RunStatus::clogged, 2);
    exchanged.row.task = 1;
    EXPECT_THROW(state.report(exchanged), Error);
    exchanged.row.task = 2;
    EXPECT_THROW(state.report(exchanged), Error) << "has not begun";
    state.report(report(state, 0, RunStatus::clogged, 3));
    state.finish();
  }
  SweepState state = open();
  EXPECT_EQ(state.row(0).distance, 3);
  EXPECT_EQ(state.tasks_left(), std::vector<std::int64_t>{1});
}

/// The message of the error that the action throws.
template <class Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST_F(SweepStateTest, PublishesAllThatItKnowsWhenItsJournalIsRemoved) {
  {
    SweepState state = open();
    for (const std::int64_t task : {0, 1}) state.start(task, 0);
    state.report(report(state, 0, RunStatus::clogged, 2));
    state.report(report(state, 1, RunStatus::running, 1, snapshot_));
    std::filesystem::remove(store::journal_path(path()));
    const std::string said =
        refusal([&] { state.report(report(state, 1, RunStatus::running, 2, snapshot_)); });
    EXPECT_NE(said.find("nothing is lost"), std::string::npos) << said;
    EXPECT_EQ(store::read_sweep(path()).rows[0].distance, 2);
  }
  SweepState state = open();
  EXPECT_EQ(state.row(0).distance, 2);
  EXPECT_EQ(state.num_resumed(), 1) << "the snapshot, too";
}

TEST_F(SweepStateTest, OverwritesNoTableThatSomebodyElseHasPutThere) {
  const std::string other = (folder_ / "other.h5").string();
  store::publish(other, {}, {{"config", "a = 1\n"}});
  for (const bool has_journal : {true, false}) {
    SweepState state = open();
    if (has_journal) state.start(0, 0);
    if (has_journal) state.report(report(state, 0, RunStatus::clogged, 2));
    std::filesystem::rename(other, path());
    if (!has_journal) std::filesystem::remove(store::journal_path(path()));
    const std::string said = refusal([&] { state.finish(); });
    EXPECT_NE(said.find("somebody has replaced it"), std::string::npos) << said;
    EXPECT_EQ(store::read_sweep(path()).rows.size(), 0u);
    EXPECT_EQ(store::read_sweep(path() + ".rescued1").rows[0].distance, 2);
    std::filesystem::rename(path(), other);
    std::filesystem::rename(path() + ".rescued1", path());
  }
}

TEST_F(SweepStateTest, OverwritesNoTableThatComesWhileItsOwnIsBroughtToTheDisk) {
  const std::string other = (folder_ / "other.h5").string();
  store::publish(other, {}, {{"config", "a = 1\n"}});
  move_at_sync_of_folder = {other, path()};
  SweepState state = open();
  EXPECT_FALSE(move_at_sync_of_folder) << "the table was published";
  state.start(0, 0);
  state.report(report(state, 0, RunStatus::clogged, 2));
  const std::string said = refusal([&] { state.finish(); });
  EXPECT_NE(said.find("somebody has replaced it"), std::string::npos) << said;
  EXPECT_EQ(store::read_sweep(path()).rows.size(), 0u);
  EXPECT_EQ(store::read_sweep(path() + ".rescued1").rows[0].distance, 2);
}

TEST_F(SweepStateTest, LosesNoRowToATableThatComesWhileItsLastIsBroughtToTheDisk) {
  const std::string other = (folder_ / "other.h5").string();
  store::publish(other, {}, {{"config", "a = 1\n"}});
  SweepState state = open();
  for (const std::int64_t task : {0, 1}) {
    state.start(task, 0);
    state.report(report(state, task, RunStatus::clogged, 2));
  }
  move_at_sync_of_folder = {other, path()};
  const std::string said = refusal([&] { state.finish(); });
  EXPECT_NE(said.find("somebody has replaced it"), std::string::npos) << said;
  EXPECT_EQ(store::read_sweep(path()).rows.size(), 0u);
  EXPECT_EQ(store::read_sweep(path() + ".rescued1").rows.size(), 2u);
}

TEST_F(SweepStateTest, TakesManyRowsWhileItPublishesAndShortensItsJournal) {
  settings_.set("seeds", "1..20001");
  plan_ = sweep::Plan(settings_);
  const auto journal_size = [&] { return std::filesystem::file_size(store::journal_path(path())); };
  const std::vector<std::byte> large(70'000'000);
  {
    SweepState state = open();
    for (const std::int64_t task : {0, 1}) state.start(task, 0);
    state.report(report(state, 0, RunStatus::running, 1, large));
    state.report(report(state, 1, RunStatus::running, 1, snapshot_));
    is_disk_slow = true;
    while (!state.is_publishing()) state.tick();
    while (!is_draft_waiting) usleep(1000);
    state.report(report(state, 0, RunStatus::clogged, 2));
    for (std::int64_t task = 2; task < plan_.size(); ++task) {
      state.start(task, 0);
      state.report(report(state, task, RunStatus::clogged, 2));
    }
    state.tick();
    EXPECT_TRUE(state.is_publishing());
    EXPECT_EQ(store::read_sweep(path()).rows.size(), 0u) << "the earlier table";
    is_disk_slow = false;
    while (state.is_publishing()) state.tick();
    EXPECT_EQ(store::read_sweep(path()).rows.at(0).status, RunStatus::running) << "it was written before";
    EXPECT_LT(journal_size(), large.size());
  }
  SweepState state = open();  // as after a kill
  EXPECT_EQ(state.row(0).distance, 2);
  EXPECT_EQ(state.tasks_begun(), std::vector<std::int64_t>{1});
  EXPECT_EQ(state.num_resumed(), 1);
}

TEST_F(SweepStateTest, FindsItsRunsWhenTheListsHaveAnotherOrder) {
  {
    SweepState state = open();
    state.start(0, 0);
    state.report(report(state, 0, RunStatus::clogged, 2));
  }
  settings_.set("seeds", "2,1");
  plan_ = sweep::Plan(settings_);
  SweepState state = open();
  EXPECT_EQ(state.row(1).distance, 2);
  EXPECT_EQ(state.tasks_left(), std::vector<std::int64_t>{0});
  EXPECT_EQ(state.num_beyond(), 0);
}

TEST_F(SweepStateTest, LeavesTheJournalOfAnotherSweepAndKeepsItsOwnRows) {
  SweepState state = open();
  state.start(0, 0);
  state.report(report(state, 0, RunStatus::clogged, 2));
  std::filesystem::remove(store::journal_path(path()));
  const store::Journal other{store::OutputPath::resolve(store::journal_path(path()))};
  const std::string said = refusal([&] { state.finish(); });
  EXPECT_NE(said.find("or its journal"), std::string::npos) << said;
  EXPECT_TRUE(other.is_there());
  EXPECT_EQ(store::read_sweep(path() + ".rescued1").rows[0].distance, 2);
}

TEST_F(SweepStateTest, LeavesTheJournalAsItIsWhenItRefuses) {
  const std::string journal = store::journal_path(path());
  {
    SweepState state = open();
    state.start(0, 0);
    state.report(report(state, 0, RunStatus::running, 2, snapshot_));
    state.finish();
  }
  const auto size = std::filesystem::file_size(journal) - 1;
  std::filesystem::resize_file(journal, size);  // makes a record incomplete
  settings_.set("max-time", "17");
  EXPECT_NE(refusal([&] { open(); }).find("other settings"), std::string::npos);
  EXPECT_EQ(std::filesystem::file_size(journal), size);
  std::filesystem::remove(path());
  store::publish(path(), {}, {{"config", "line-tension = many\n"}});
  EXPECT_NE(refusal([&] { open(); }), "");
  EXPECT_EQ(std::filesystem::file_size(journal), size);
}

TEST_F(SweepStateTest, RefusesAJournalOfRunsWithOtherSettings) {
  const std::string journal = store::journal_path(path());
  open().finish();
  const auto left_by = [&](const sweep::Settings& settings, std::int64_t version) {
    store::Journal other{store::OutputPath::resolve(journal)};
    sweep::RunRow row = sweep::describe(sweep::Plan(settings).task(0));
    row.task = 0;
    row.model_version = version;
    row.clogged_by = FoundBy::not_clogged;
    row.hold.mechanism = ClogMechanism::none;
    other.add(row, {});
    return std::filesystem::file_size(journal);
  };
  sweep::Settings settings = settings_;
  settings.set("line-tension", "0.7");
  left_by(settings, model_version);  // the run belongs to a larger plan of this sweep
  EXPECT_EQ(open().num_beyond(), 1);
  std::filesystem::remove(journal);
  settings.set("max-time", "17");
  const auto size = left_by(settings, model_version);
  EXPECT_NE(refusal([&] { open(); }).find("is of another sweep: max-time="), std::string::npos);
  EXPECT_EQ(std::filesystem::file_size(journal), size);
  std::filesystem::remove(journal);
  left_by(settings_, model_version - 1);
  EXPECT_NE(refusal([&] { open(); }).find("is of another sweep: model version"), std::string::npos);
}

TEST_F(SweepStateTest, SalvagesResultsAndSnapshotsThatOnlyItsJournalHas) {
  {
    SweepState state = open();
    state.start(0, 0);
    state.report(report(state, 0, RunStatus::running, 1, snapshot_));
    state.report(report(state, 0, RunStatus::clogged, 2));
    state.start(1, 0);
    state.report(report(state, 1, RunStatus::running, 3, snapshot_));
  }
  EXPECT_TRUE(store::read_sweep(path()).rows.empty()) << "it was killed before it published";
  const Salvage found = salvage(path());
  EXPECT_EQ(found.num_from_journal, 1);
  EXPECT_TRUE(found.damage.empty());
  const std::string copy = (folder_ / "copy.h5").string();
  write(found.table, found.snapshots, copy);
  const store::SweepFile file = store::read_sweep(copy);
  ASSERT_EQ(file.rows.size(), 2u);
  EXPECT_EQ(file.rows[0].distance, 2);
  EXPECT_EQ(file.rows[1].status, RunStatus::interrupted);
  SweepState resumed(copy, plan_, settings_, {{"config", settings_.to_config()}}, 2, 1);
  EXPECT_EQ(resumed.tasks_left(), std::vector<std::int64_t>{1});
  EXPECT_EQ(resumed.start(1, 0).snapshot, snapshot_);
}

TEST_F(SweepStateTest, CountsASalvagedRunOnceHoweverOftenItFailed) {
  {
    SweepState state = open(2);
    for (const RunStatus status : {RunStatus::failed, RunStatus::clogged}) {
      state.start(0, 0);
      state.report(report(state, 0, status, 2));
    }
  }
  EXPECT_EQ(salvage(path()).num_from_journal, 1);
}

TEST_F(SweepStateTest, SalvagesNoRecordOfAnotherSweep) {
  open().finish();
  sweep::Settings settings = settings_;
  settings.set("max-time", "17");
  store::Journal other{store::OutputPath::resolve(store::journal_path(path()))};
  sweep::RunRow row = sweep::describe(sweep::Plan(settings).task(0));
  row.task = 0;
  row.clogged_by = FoundBy::not_clogged;
  row.hold.mechanism = ClogMechanism::none;
  other.add(row, {});
  const Salvage found = salvage(path());
  EXPECT_TRUE(found.table.rows.empty());
  EXPECT_EQ(found.damage, std::vector<std::string>{"of another sweep in its journal: 1 record"});
}

TEST_F(SweepStateTest, NamesTheFileWhoseConfigItCannotRead) {
  open().finish();
  store::publish(path(), {}, {{"config", "line-tension = many\n"}});
  try {
    open();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("cannot read " + path() + " (its attribute config: invalid"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(SweepStateTest, KeepsAResultOfTheTableWhateverTheJournalLacks) {
  {
    SweepState state = open();
    state.start(0, 0);
    state.report(report(state, 0, RunStatus::running, 1, snapshot_));
    state.start(1, 0);
    state.report(report(state, 1, RunStatus::running, 2, snapshot_));
    state.report(report(state, 0, RunStatus::clogged, 4));
    state.finish();
  }
  {
    store::Journal journal(store::OutputPath::resolve(store::journal_path(path())));
    sweep::RunRow older = store::read_sweep(path()).rows[0];
    older.status = RunStatus::running;
    journal.add(older, snapshot_);
  }
  SweepState state = open();
  EXPECT_EQ(state.tasks_left(), std::vector<std::int64_t>{1});
  EXPECT_EQ(state.row(0).distance, 4);
}

TEST_F(SweepStateTest, TablesWithoutRunsCanBeReadTogether) {
  const std::string other = (folder_ / "other.h5").string();
  store::publish(path(), {}, {});
  store::publish(other, {}, {});
  EXPECT_TRUE(read_together({path(), other}).rows.empty());
}

}  // namespace
}  // namespace clog::results
