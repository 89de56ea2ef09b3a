#include "clog/sweep/run_job.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "clog/core/run/dwell_record.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/messages.hpp"
#include "clog/sweep/row_check.hpp"
#include "support.hpp"

namespace clog::sweep {
namespace {

std::vector<std::byte> packed(const RunRow& row) {
  std::vector<std::byte> bytes(packed_size());
  pack(row, bytes);
  return bytes;
}

Plan small_plan(const char* seeds) {
  return Plan(settings_of({{"vertices", "64"}, {"box", "20"}, {"max-time", "20"}, {"seeds", seeds}}));
}

TEST(RunJob, GivesTheRowOfItsRun) {
  const Plan plan = small_plan("5,6");
  RunJob job(plan.task(1), 1);
  while (!job.advance()) {
  }
  DropletRun run(plan.task(1));
  while (!run.advance(100)) {
  }
  const RunRow row = job.row();
  EXPECT_EQ(row.task, 1);
  EXPECT_EQ(row.parameters.seed, 6);
  EXPECT_EQ(row.distance, run.result().distance);
  EXPECT_EQ(row.steps, run.result().steps);
  EXPECT_EQ(row.status, run.result().status);
  EXPECT_GT(row.wall_seconds, 0);
}

TEST(RunJob, IsInterruptedUntilItIsOver) {
  const Plan plan = small_plan("5");
  RunJob job(plan.task(0), 0);
  EXPECT_EQ(job.row().status, RunStatus::interrupted);
}

TEST(BegunRow, KnowsEveryResultThatIsKnownAtTheRelease) {
  const RunParameters run = small_plan("5").task(0);
  RunRow released = describe(run);
  record(DropletRun(run).result(), released);
  released.dwells = {};  // dwells count from the first step on
  const RunRow begun = begun_row(run, 0);
  for (const Column& column : columns()) {
    const bool is_known = column.role != ColumnRole::result || column.get(begun) != Value();
    EXPECT_TRUE(is_known || column.get(released) == Value()) << column.name;
  }
}

TEST(RunJob, TurnsAnImpossibleReleaseIntoAFailedRow) {
  // The obstacles are so close together that some seeds give no void near the centre of the box.
  const Plan plan(settings_of({{"obstacle-diameter", "3"},
                               {"obstacle-gap", "0.06"},
                               {"obstacle-density", "saturated"},
                               {"vertices", "64"},
                               {"self-contact-range", "0.1"},
                               {"box", "13"},
                               {"seeds", "51..70"}}));
  int num_failed = 0;
  for (std::int64_t task = 0; task < plan.size(); ++task) {
    RunJob job(plan.task(task), task);
    job.advance();
    const RunRow row = job.row();
    if (row.status != RunStatus::failed) continue;
    ++num_failed;
    EXPECT_TRUE(row.message.starts_with("cannot release the droplet")) << row.message;
    EXPECT_TRUE(job.advance()) << "a failed job is over";
  }
  EXPECT_GT(num_failed, 0);
}

/// A snapshot of a run in which `change` has changed the dwells. The dwells are an array of numbers: a
/// length, a distance and a beginning for each of eight dwells, and then the smallest duration of known
/// dwells.
template <class Change>
std::vector<std::byte> changed_snapshot(const RunParameters& run, Change change) {
  RunJob job(run, 0);
  while (job.snapshot().empty() && !job.advance()) {
  }
  std::vector<std::byte> snapshot = job.snapshot();
  const double known_from = DwellRecord::shortest * run.dwell_length / run.drag.terminal_speed;
  std::byte bytes[sizeof(double)];
  std::memcpy(bytes, &known_from, sizeof(bytes));
  const auto found = std::search(snapshot.begin(), snapshot.end(), std::begin(bytes), std::end(bytes));
  if (found == snapshot.end()) throw std::runtime_error("no snapshot, or one without dwells");
  constexpr std::ptrdiff_t num_before = 3 * std::ptrdiff_t{Dwells::most};
  std::array<double, num_before + 1> dwells{};
  std::byte* const place = &*found - num_before * std::ptrdiff_t{sizeof(double)};
  std::memcpy(dwells.data(), place, sizeof(dwells));
  change(dwells);
  std::memcpy(place, dwells.data(), sizeof(dwells));
  return snapshot;
}

RunRow finished(RunJob job) {
  while (!job.advance()) {
  }
  return job.row();
}

RunParameters long_run() {
  return Plan(settings_of({{"vertices", "64"},
                           {"box", "20"},
                           {"line-tension", "0.1"},
                           {"max-time", "2000"},
                           {"seeds", "5"}}))
      .task(0);
}

TEST(RunJob, ResumesFromASnapshot) {
  const RunParameters run = long_run();
  const double known_from = DwellRecord::shortest * run.dwell_length / run.drag.terminal_speed / 2;
  const auto snapshot = changed_snapshot(run, [=](auto& dwells) { dwells.back() = known_from; });
  EXPECT_EQ(finished(RunJob(run, 0, snapshot)).dwells.known_from, known_from);
}

TEST(RunJob, BeginsAnewIfNoRunCanHaveComeToItsSnapshot) {
  const RunParameters run = long_run();
  const auto snapshot = changed_snapshot(run, [](auto& dwells) { dwells[0] = dwells[1] = dwells[2] = 0; });
  RunRow row = finished(RunJob(run, 0, snapshot)), undisturbed = finished(RunJob(run, 0));
  EXPECT_EQ(fault_of(row), "");
  EXPECT_NE(row.message, "") << "the reason";
  row.message.clear();
  row.wall_seconds = undisturbed.wall_seconds;
  row.processor_seconds = undisturbed.processor_seconds;
  EXPECT_EQ(packed(row), packed(undisturbed));
}

TEST(RunJob, SaysWhyItCannotUseItsSnapshot) {
  const RunParameters run = long_run();
  auto snapshot = changed_snapshot(run, [](auto&) {});
  RunJob usual(run, 0, snapshot);
  usual.advance();
  EXPECT_EQ(usual.row().message, "");
  snapshot[0] ^= std::byte{1};
  RunJob job(run, 0, snapshot);
  job.advance();
  EXPECT_EQ(job.row().message, "the snapshot is of another version");
  EXPECT_EQ(job.row().status, RunStatus::interrupted);
}

TEST(Report, KeepsAFamilyInPlaceOfTheSnapshot) {
  RunRow row = RunJob(small_plan("5").task(0), 0).row();
  row.status = RunStatus::broken;
  const std::vector<std::byte> snapshot(100, std::byte{42});
  EXPECT_EQ(report_from(to_bytes({row, snapshot})).snapshot, snapshot);
  row.family.resize(3);
  row.family[0].status = MemberEnd::broken;
  row.family[2].path = "1";
  row.family[2].diameter = 0.8;
  const Report report = report_from(to_bytes({row, snapshot}));
  EXPECT_TRUE(report.snapshot.empty());
  ASSERT_EQ(report.row.family.size(), 3);
  EXPECT_EQ(report.row.family[2].path, "1");
  EXPECT_EQ(report.row.family[2].diameter, 0.8);
}

TEST(Report, RefusesATornFamily) {
  RunRow row = RunJob(small_plan("5").task(0), 0).row();
  row.status = RunStatus::flowing;
  row.family = {Member()};
  std::vector<std::byte> bytes = to_bytes({row, {}});
  bytes.resize(bytes.size() - 1);
  EXPECT_THROW(report_from(bytes), Error);
}

}  // namespace
}  // namespace clog::sweep
