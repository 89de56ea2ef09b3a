#include "clog/core/droplet/droplet_state.hpp"

#include <gtest/gtest.h>

namespace clog {
namespace {

DropletState points(double x0, double x1, double y) {
  DropletState state;
  state.position.resize(4);
  state.position << x0, x1, y, y;
  state.velocity = Eigen::ArrayXd::Zero(4);
  state.frame.period = {10, 10};
  return state;
}

TEST(DropletState, RecentresByWholeUnitsWithoutMoving) {
  DropletState state = points(2.25, 2.75, -0.5);
  state.frame.origin = {3, 4};
  const Eigen::Array2d before = state.frame.global({state.x()[0], state.y()[0]});
  const Eigen::Array2d step = state.recentre();
  EXPECT_EQ(step[0], 3);  // 2.5 rounds away from zero
  EXPECT_EQ(step[1], -1);
  EXPECT_EQ(state.x()[0], -0.75);
  const Eigen::Array2d after = state.frame.global({state.x()[0], state.y()[0]});
  EXPECT_TRUE((before == after).all());
}

TEST(DropletState, LeavesACentredDropletAlone) {
  DropletState state = points(0.5, 0.9, 0.3);
  EXPECT_FALSE(state.recentre().any());
  EXPECT_EQ(state.x()[0], 0.5);
}

TEST(LocalFrame, CountsBoxesAndKeepsItsOriginInside) {
  LocalFrame frame{.period = {10, 10}};
  frame.shift({23, -1});
  EXPECT_EQ(frame.origin[0], 3);
  EXPECT_EQ(frame.origin[1], 9);
  EXPECT_EQ(frame.image[0], 2);
  EXPECT_EQ(frame.image[1], -1);
}

TEST(LocalFrame, MayBeLongerAlongTheFlow) {
  LocalFrame frame{.period = {30, 10}};
  frame.shift({47, 12});
  EXPECT_EQ(frame.origin[0], 17);
  EXPECT_EQ(frame.origin[1], 2);
  const Eigen::Array2d global = frame.global({0.5, 0.25});
  EXPECT_EQ(global[0], 47.5);
  EXPECT_EQ(global[1], 12.25);
}

TEST(LocalFrame, MeasuresDisplacementsAcrossBoxes) {
  LocalFrame start{.period = {10, 10}};
  start.shift({9, 9});
  LocalFrame end = start;
  end.shift({6001, 0});
  const Eigen::Array2d displacement = end.displacement({0.25, 0}, start, {0.5, 0.125});
  EXPECT_EQ(displacement[0], 6000.75);
  EXPECT_EQ(displacement[1], -0.125);
}

}  // namespace
}  // namespace clog
