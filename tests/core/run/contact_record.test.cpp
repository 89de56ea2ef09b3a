#include "clog/core/run/contact_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/tools/byte_archive.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"

namespace clog {
namespace {

/// A round droplet that the test moves along the flow, among given circles, from x = 2 and y = `across`.
class Passage {
 public:
  explicit Passage(std::vector<Obstacle> circles, double across = 5, double range = 0)
      : obstacles_({10, 1}, std::move(circles)), record_({range, true}) {
    state_.frame.period = {10, 10};
    state_.position = regular_polygon(128, units::rest_area);
    state_.velocity = Eigen::ArrayXd::Zero(256);
    state_.frame.shift({2, across});
  }
  void move_to(double x) {
    state_.x() += x - x_;
    x_ = x;
    state_.recentre();
    const LocalFrame& frame = state_.frame;
    const Eigen::Array2d release = frame.global({0, 0}) - start_;
    record_.add(state_, obstacles_, release, x);
  }
  /// Moves the droplet in steps as long as its path between two checks of a run.
  void move_by_steps_to(double x) {
    constexpr double step = 0.002;
    while (x_ + step < x) move_to(x_ + step);
    move_to(x);
  }
  ContactRecord& record() { return record_; }
  const Contacts& found() const { return record_.found(); }

 private:
  ObstacleArray obstacles_;
  ContactRecord record_;
  DropletState state_;
  double x_ = 0;
  Eigen::Array2d start_{2, 5};
};

TEST(ContactRecord, CountsCirclesThatTheOutlineReaches) {
  Passage passage({{5, 5.55, 0.1}, {7, 5.65, 0.1}});
  passage.move_by_steps_to(2);
  EXPECT_EQ(passage.found().number, 0);
  EXPECT_TRUE(std::isnan(passage.found().first_distance));
  passage.move_by_steps_to(7);
  EXPECT_EQ(passage.found().number, 1) << "the second is 0.05 away from the lane";
  // Droplet and circle touch if their centres are 0.6 apart. The distance of the centres across the flow is
  // 0.55.
  EXPECT_NEAR(passage.found().first_distance, 3 - std::sqrt(0.36 - 0.55 * 0.55), 0.004);
}

TEST(ContactRecord, CountsNoneThatAreFarEvenAfterManyPeriods) {
  Passage passage({{5, 9.5, 0.3}});
  passage.move_by_steps_to(35);
  EXPECT_EQ(passage.found().number, 0);
}

TEST(ContactRecord, CountsAnObstacleOncePerPeriodAndMeeting) {
  Passage passage({{5, 5.55, 0.1}});
  passage.move_by_steps_to(33);
  EXPECT_EQ(passage.found().number, 4);
  Passage shaken({{5, 5, 0.1}});
  shaken.move_to(2.41);
  for (int i = 0; i < 10; ++i) shaken.move_to(2.35), shaken.move_to(2.41);
  EXPECT_EQ(shaken.found().number, 1) << "it has not been left";
  shaken.move_to(2.25);
  shaken.move_to(2.41);
  EXPECT_EQ(shaken.found().number, 2);
}

/// Overlapping circles in a row along the flow, beside the droplet's path.
std::vector<Obstacle> row(double from, double to) {
  std::vector<Obstacle> circles;
  for (double x = from; x < to; x += 0.05) circles.push_back({x, 5.55, 0.1});
  return circles;
}

TEST(ContactRecord, CountsAPostOfManyCirclesOnce) {
  // Circles are searched only near the droplet, and the row is longer than this range.
  Passage along_a_row(row(4, 8));
  along_a_row.move_by_steps_to(8);
  EXPECT_EQ(along_a_row.found().number, 1);
  std::vector<Obstacle> circles = row(4, 6);
  for (const Obstacle& circle : row(6.3, 8)) circles.push_back(circle);
  Passage along_two_rows(circles);
  along_two_rows.move_by_steps_to(8);
  EXPECT_EQ(along_two_rows.found().number, 2);
}

TEST(ContactRecord, BeginsAtTheRangeOfTheContact) {
  Passage passage({{5, 5, 0.1}}, 5, 0.05);
  passage.move_to(2.34);
  EXPECT_EQ(passage.found().number, 0);
  passage.move_to(2.36);
  EXPECT_EQ(passage.found().number, 1);
}

TEST(ContactRecord, SeesATouchBetweenTwoVertices) {
  // A circle overlaps the middle of an edge, but so little that it does not reach the ends of the edge.
  const double edge = units::regular_edge_length(128);
  const double apothem = edge / 2 / std::tan(std::numbers::pi / 128);
  const Obstacle circle{2 + apothem + 0.001 - 1e-6, 5, 0.001};
  Passage passage({circle});
  DropletState turned;
  turned.frame.period = {10, 10};
  turned.frame.shift({2, 5});
  turned.velocity = Eigen::ArrayXd::Zero(256);
  turned.position.resize(256);
  for (int i = 0; i < 128; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / 128;
    turned.x()[i] = apothem / std::cos(std::numbers::pi / 128) * std::cos(angle);
    turned.y()[i] = apothem / std::cos(std::numbers::pi / 128) * std::sin(angle);
  }
  const ObstacleArray obstacles({10, 1}, {circle});
  ContactRecord by_edges({0, true}), by_vertices({0, false});
  by_edges.add(turned, obstacles, {0, 0}, 0);
  by_vertices.add(turned, obstacles, {0, 0}, 0);
  EXPECT_EQ(by_edges.found().number, 1);
  EXPECT_EQ(by_vertices.found().number, 0);
}

TEST(ContactRecord, GoesOnWhereItWasSaved) {
  Passage passage({{5, 5, 0.1}});
  passage.move_to(2.41);
  ByteWriter bytes;
  passage.record().save(bytes);
  const std::vector<std::byte> saved = bytes.take();
  ByteReader reader(saved);
  passage.record().restore(reader);
  EXPECT_TRUE(reader.at_end());
  passage.move_to(2.42);
  EXPECT_EQ(passage.found().number, 1) << "it is still the same contact";
}

TEST(ContactRecord, RefusesWhatItCannotHaveSaved) {
  ByteWriter bytes;
  bytes.put(Contacts{.number = -1});
  bytes.put(std::vector<double>());
  const std::vector<std::byte> saved = bytes.take();
  ByteReader reader(saved);
  ContactRecord record({0, true});
  EXPECT_THROW(record.restore(reader), Error);
}

}  // namespace
}  // namespace clog
