#include "clog/scheduler/rank_trust.hpp"

#include <gtest/gtest.h>

namespace clog::scheduler {
namespace {

using Ranks = std::vector<int>;
using Tasks = std::vector<std::int64_t>;

/// Lets tasks 1, 2 and 3 fail on a rank.
void fail_three(RankTrust& trust, int rank) {
  for (const std::int64_t task : {1, 2, 3}) EXPECT_EQ(trust.failed(task, rank), Ranks());
}

TEST(RankTrust, HoldsARankOnWhichThreeTasksFailed) {
  RankTrust trust({0, 1, 2});
  fail_three(trust, 1);
  EXPECT_FALSE(trust.may_work(1));
  EXPECT_TRUE(trust.may_work(0));
  EXPECT_EQ(trust.unsettled_tasks(1), (Tasks{1, 2, 3}));
}

TEST(RankTrust, ForgetsFailuresAfterASuccess) {
  RankTrust trust({0, 1});
  trust.failed(1, 1);
  trust.failed(2, 1);
  trust.succeeded(7, 1);
  trust.failed(3, 1);
  trust.failed(4, 1);
  EXPECT_TRUE(trust.may_work(1));
}

TEST(RankTrust, SetsARankAsideWhenOneOfItsThreeSucceedsElsewhere) {
  RankTrust trust({0, 1, 2});
  fail_three(trust, 1);
  EXPECT_EQ(trust.succeeded(2, 0), Ranks{1});
  EXPECT_EQ(trust.num_in_service(), 2);
  EXPECT_FALSE(trust.may_work(1));
  EXPECT_EQ(trust.unsettled_tasks(1), (Tasks{1, 3}));
  trust.let_go();
  EXPECT_FALSE(trust.may_work(1)) << "for good";
}

TEST(RankTrust, SetsARankAsideThatGoesOnFailingAfterASuccessElsewhere) {
  RankTrust trust({0, 1});
  trust.failed(1, 1);
  EXPECT_EQ(trust.succeeded(1, 0), Ranks());
  EXPECT_EQ(trust.failed(2, 1), Ranks());
  EXPECT_EQ(trust.failed(3, 1), Ranks{1});
}

TEST(RankTrust, BlamesATaskThatFailsOnATrustedRankToo) {
  RankTrust trust({0, 1});
  fail_three(trust, 1);
  trust.succeeded(9, 0);
  trust.failed(2, 0);
  EXPECT_TRUE(trust.may_work(1));
  EXPECT_EQ(trust.unsettled_tasks(1), (Tasks{1, 3}));
}

TEST(RankTrust, BelievesNoRankThatHasNotSucceeded) {
  // Two of the ranks are on a broken node.
  RankTrust trust({0, 1, 2});
  fail_three(trust, 1);
  fail_three(trust, 2);
  EXPECT_FALSE(trust.may_work(1));
  EXPECT_FALSE(trust.may_work(2));
  EXPECT_EQ(trust.succeeded(3, 0), (Ranks{1, 2}));
}

TEST(RankTrust, LetsRanksGoThatNobodyCanClear) {
  RankTrust trust({0, 1});
  fail_three(trust, 0);
  fail_three(trust, 1);
  trust.let_go();
  EXPECT_TRUE(trust.may_work(0));
  EXPECT_TRUE(trust.may_work(1));
}

TEST(RankTrust, NeverHoldsARankThatIsAlone) {
  RankTrust trust({0});
  fail_three(trust, 0);
  trust.failed(4, 0);
  EXPECT_TRUE(trust.may_work(0));
  EXPECT_EQ(trust.num_in_service(), 1);
}

TEST(RankTrust, SetsTheLastOfSeveralAside) {
  RankTrust trust({0, 1});
  fail_three(trust, 1);
  trust.succeeded(1, 0);
  trust.failed(4, 0);
  trust.failed(5, 0);
  EXPECT_EQ(trust.failed(6, 0), Ranks{0});
  EXPECT_EQ(trust.num_in_service(), 0);
}

TEST(RankTrust, SendsAFailedTaskToEveryOtherRankFirst) {
  RankTrust trust({0, 1, 2});
  trust.failed(1, 0);
  EXPECT_FALSE(trust.is_next_for(1, 0));
  EXPECT_TRUE(trust.is_next_for(1, 1));
  trust.failed(1, 1);
  EXPECT_FALSE(trust.is_next_for(1, 1));
  trust.failed(1, 2);
  EXPECT_TRUE(trust.is_next_for(1, 0));
}

}  // namespace
}  // namespace clog::scheduler
