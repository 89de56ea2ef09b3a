#include "clog/scheduler/machine_trust.hpp"

#include <gtest/gtest.h>

namespace clog::scheduler {
namespace {

using Tasks = std::set<std::int64_t>;
using Names = std::vector<std::string>;

/// Three hosts with a rank each.
MachineTrust three_hosts() { return {{"a", "b", "c"}, 0}; }

/// The names of the machines that a success sets aside.
Names set_aside_by_success(MachineTrust& trust, std::int64_t task, int rank) {
  Names names;
  for (const MachineTrust::Suspect& suspect : trust.succeeded(task, rank))
    if (suspect.is_set_aside) names.push_back(suspect.name);
  return names;
}

/// The tasks that other machines should try after this failure.
Tasks in_doubt(MachineTrust& trust, std::int64_t task, int rank) {
  const auto suspect = trust.failed(task, rank, "");
  return suspect ? suspect->tasks : Tasks();
}

/// Lets tasks 1, 2 and 3 fail on a rank.
void fail_three(MachineTrust& trust, int rank) {
  for (const std::int64_t task : {1, 2, 3}) {
    const auto suspect = trust.failed(task, rank, "");
    EXPECT_FALSE(suspect && suspect->is_set_aside);
  }
}

TEST(MachineTrust, HoldsAMachineOnWhichThreeTasksFailed) {
  MachineTrust trust = three_hosts();
  EXPECT_EQ(in_doubt(trust, 1, 1), Tasks());
  EXPECT_EQ(in_doubt(trust, 2, 1), Tasks());
  EXPECT_EQ(in_doubt(trust, 3, 1), (Tasks{1, 2, 3}));
  EXPECT_FALSE(trust.may_work(1));
  EXPECT_TRUE(trust.may_work(0));
}

TEST(MachineTrust, ForgetsFailuresAfterASuccess) {
  MachineTrust trust({"a", "b"}, 0);
  trust.failed(1, 1, "");
  trust.failed(2, 1, "");
  trust.succeeded(7, 1);
  trust.failed(3, 1, "");
  trust.failed(4, 1, "");
  EXPECT_TRUE(trust.may_work(1));
}

TEST(MachineTrust, SetsAMachineAsideWhenOneOfItsThreeSucceedsElsewhere) {
  MachineTrust trust = three_hosts();
  fail_three(trust, 1);
  const auto suspects = trust.succeeded(2, 0);
  ASSERT_EQ(suspects.size(), 1u);
  EXPECT_TRUE(suspects[0].is_set_aside);
  EXPECT_EQ(suspects[0].name, "host b");
  EXPECT_EQ(suspects[0].tasks, (Tasks{1, 3}));
  EXPECT_EQ(trust.num_in_service(), 2);
  EXPECT_FALSE(trust.may_work(1));
  trust.end_holds();
  EXPECT_FALSE(trust.may_work(1)) << "for good";
}

TEST(MachineTrust, SetsAMachineAsideThatGoesOnFailingAfterASuccessElsewhere) {
  MachineTrust trust({"a", "b"}, 0);
  trust.failed(1, 1, "");
  EXPECT_EQ(set_aside_by_success(trust, 1, 0), Names());
  EXPECT_FALSE(trust.failed(2, 1, ""));
  const auto suspect = trust.failed(3, 1, "no library");
  ASSERT_TRUE(suspect && suspect->is_set_aside);
  EXPECT_EQ(suspect->message, "no library");
}

TEST(MachineTrust, BlamesATaskThatFailsOnATrustedMachineToo) {
  MachineTrust trust({"a", "b"}, 0);
  fail_three(trust, 1);
  trust.succeeded(9, 0);
  trust.failed(2, 0, "");
  EXPECT_TRUE(trust.may_work(1));
  EXPECT_EQ(in_doubt(trust, 4, 1), (Tasks{1, 3, 4}));
}

TEST(MachineTrust, BelievesNoMachineThatHasNotSucceeded) {
  MachineTrust trust = three_hosts();
  fail_three(trust, 1);
  fail_three(trust, 2);
  EXPECT_FALSE(trust.may_work(1));
  EXPECT_FALSE(trust.may_work(2));
  EXPECT_EQ(set_aside_by_success(trust, 3, 0), (Names{"host b", "host c"}));
}

TEST(MachineTrust, LetsMachinesGoThatNobodyCanClear) {
  MachineTrust trust({"a", "b"}, 0);
  fail_three(trust, 0);
  fail_three(trust, 1);
  trust.end_holds();
  EXPECT_TRUE(trust.may_work(0));
  EXPECT_TRUE(trust.may_work(1));
}

TEST(MachineTrust, NeverHoldsAMachineThatIsAlone) {
  MachineTrust trust({"a"}, 0);
  fail_three(trust, 0);
  trust.failed(4, 0, "");
  EXPECT_TRUE(trust.may_work(0));
  EXPECT_EQ(trust.num_in_service(), 1);
}

TEST(MachineTrust, SetsTheLastOfSeveralAside) {
  MachineTrust trust({"a", "b"}, 0);
  fail_three(trust, 1);
  trust.succeeded(1, 0);
  trust.failed(4, 0, "");
  trust.failed(5, 0, "");
  EXPECT_TRUE(trust.failed(6, 0, "")->is_set_aside);
  EXPECT_EQ(trust.num_in_service(), 0);
}

TEST(MachineTrust, SendsAFailedTaskToEveryOtherMachineFirst) {
  MachineTrust trust = three_hosts();
  trust.failed(1, 0, "");
  EXPECT_FALSE(trust.is_next_for(1, 0));
  EXPECT_TRUE(trust.is_next_for(1, 1));
  trust.failed(1, 1, "");
  EXPECT_FALSE(trust.is_next_for(1, 1));
  trust.failed(1, 2, "");
  EXPECT_TRUE(trust.is_next_for(1, 0));
}

TEST(MachineTrust, JudgesAHostWithAllItsRanks) {
  MachineTrust trust({"a", "a", "b", "b"}, 0);
  trust.failed(1, 2, "");
  EXPECT_FALSE(trust.is_next_for(1, 3)) << "the other rank of this host";
  trust.failed(2, 3, "");
  trust.failed(3, 2, "");
  EXPECT_FALSE(trust.may_work(2));
  EXPECT_FALSE(trust.may_work(3));
  EXPECT_EQ(set_aside_by_success(trust, 1, 1), Names{"host b"});
  EXPECT_EQ(trust.num_in_service(), 1);
  EXPECT_EQ(in_doubt(trust, 4, 3), Tasks{4}) << "a task that ran there when the host was set aside";
}

TEST(MachineTrust, JudgesRanksOnASingleHost) {
  MachineTrust trust({"a", "a", "a"}, 0);
  fail_three(trust, 1);
  EXPECT_FALSE(trust.may_work(1));
  EXPECT_TRUE(trust.may_work(2));
  EXPECT_EQ(set_aside_by_success(trust, 1, 2), Names{"rank 1 on a"});
}

TEST(MachineTrust, IgnoresTheHostOfAMasterThatDoesNotCompute) {
  MachineTrust trust({"a", "b", "b"}, 1);
  fail_three(trust, 1);
  EXPECT_EQ(set_aside_by_success(trust, 1, 2), Names{"rank 1 on b"});
}

}  // namespace
}  // namespace clog::scheduler
