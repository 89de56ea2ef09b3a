#include "clog/core/polygon/contact/self_contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "clog/core/tools/instruction_set.hpp"
#include "support.hpp"

namespace clog {
namespace {

TEST(NearestPoint, OfAnEdgeItsEndAndItsMiddle) {
  const double x[] = {0, 2, 0.5, 3};
  const double y[] = {0, 0, 0.3, 0.4};
  const EdgeContact middle = nearest_point({2, 0}, x, y, 4);
  EXPECT_DOUBLE_EQ(middle.distance, 0.3);
  EXPECT_DOUBLE_EQ(middle.fraction, 0.25);
  const EdgeContact end = nearest_point({3, 0}, x, y, 4);
  EXPECT_DOUBLE_EQ(end.distance, std::hypot(1, 0.4));
  EXPECT_DOUBLE_EQ(end.fraction, 1);
}

TEST(NearestPoint, OfTheEdgeThatClosesTheContour) {
  const double x[] = {0, -1, 2, 1, 0.1};
  const double y[] = {0, 0, 0, 0, 0.2};
  EXPECT_DOUBLE_EQ(nearest_point({4, 3}, x, y, 4).distance, 0.2);
}

TEST(SelfContacts, AConvexDropletHasNone) {
  const DropletState state = test::state_of(regular_polygon(256, units::rest_area));
  const double rest_edge = units::regular_edge_length(256);
  SelfContacts contacts(rest_edge, rest_edge);
  contacts.update(state, {});
  EXPECT_TRUE(contacts.pairs().empty());
}

TEST(SelfContacts, ListsEveryVertexAndEdgeThatTouchWhileTheShapeMoves) {
  const int n = 256;
  const double diameter = units::regular_edge_length(n);
  SelfContacts contacts(diameter, diameter);
  DropletState state = test::state_of(test::dumbbell(n, 0.03));
  ASSERT_GT(polygon_shape(state.position).perimeter / n, diameter);
  state.velocity.tail(n) = -0.05 * state.y();  // the neck closes
  int num_touching = 0;
  for (int step = 0; step < 300; ++step) {
    state.position += 0.1 * state.velocity;
    contacts.update(state, state.possible_travel(0.1));
    std::set<std::pair<int, int>> listed;
    for (const auto& [vertex, edge] : contacts.pairs()) listed.insert({vertex, edge});
    for (int vertex = 0; vertex < n; ++vertex)
      for (int edge = 0; edge < n; ++edge) {
        if (contacts.are_neighbours(vertex, edge) || contacts.are_neighbours(vertex, (edge + 1) % n))
          continue;
        if (nearest_point({vertex, edge}, state.position.data(), state.position.data() + n, n).distance >=
            diameter)
          continue;
        ++num_touching;
        EXPECT_TRUE(listed.count({vertex, edge}))
            << "vertex " << vertex << ", edge " << edge << ", step " << step;
      }
  }
  EXPECT_GT(num_touching, 100);
}

/// Two strands that nearly touch. The vertices are shaken along the strands and across them.
Eigen::ArrayXd flattened(int n, double thickness, double shaking, unsigned seed) {
  Eigen::ArrayXd position = regular_polygon(n, units::rest_area);
  position.tail(n) *= thickness;
  return test::shaken(position, shaking, seed);
}

TEST(SelfContacts, AreThoseOfAllVerticesAndEdgesWithEveryInstructionSet) {
  // The numbers of vertices cover several cases: fewer than two groups of edges, groups that are not full,
  // contours so coarse that vertices of the two strands are neighbours along the contour, and fine contours
  // with many excluded vertices. On a stretched contour, the length of the contour decides which vertices are
  // excluded.
  for (const std::string& set : instruction_sets())
    for (const int n : {16, 17, 24, 25, 30, 31, 32, 33, 64, 101, 256, 700})
      for (const double stretch : {0.7, 1.0, 2.5}) {
        use_instruction_set(set);
        const double edge = units::regular_edge_length(n),
                     range = std::min(0.6 * edge, published_vertex_diameter);
        SelfContacts contacts(range, edge);
        const DropletState state =
            test::state_of(stretch * flattened(n, 1.5 * range, 0.3 * range, static_cast<unsigned>(n)));
        contacts.update(state, {.absolute = 0, .relative = range});
        const double* x = state.position.data();
        std::set<std::pair<int, int>> listed, touching;
        for (const auto& [vertex, other] : contacts.pairs()) listed.insert({vertex, other});
        EXPECT_EQ(listed.size(), contacts.pairs().size()) << "no pair is listed twice; " << n << ", " << set;
        for (int vertex = 0; vertex < n; ++vertex)
          for (int other = 0; other < n; ++other)
            if (!contacts.are_neighbours(vertex, other) &&
                !contacts.are_neighbours(vertex, (other + 1) % n) &&
                nearest_point({vertex, other}, x, x + n, n).distance < 2 * range)
              touching.insert({vertex, other});
        EXPECT_GT(touching.size(), 0U) << n;
        EXPECT_TRUE(std::ranges::includes(listed, touching)) << n << ", " << stretch << ", " << set;
      }
  use_instruction_set("auto");
}

/// The first vertex of a stretched circle has neighbours, which are excluded from its self-contacts. Returns
/// the number of neighbours on one side.
int neighbours_of_first(double stretch) {
  const int n = 128;
  const double range = 0.0125, rest_edge = 0.025;
  SelfContacts contacts(range, rest_edge);
  contacts.update(test::state_of(regular_polygon(n, units::rest_area * stretch * stretch)), {});
  int count = 0;
  while (contacts.are_neighbours(0, count + 1)) ++count;
  EXPECT_EQ(contacts.exclusion(), 2);
  return count;
}

TEST(SelfContacts, LeavesOutThreeRangesOfTheContour) {
  // Vertices within three ranges along the contour are excluded. Three ranges are 1.5 edges at rest. A
  // compressed contour excludes the next vertex, but never the vertex after the next. A contour that is
  // stretched enough excludes no vertex.
  EXPECT_EQ(neighbours_of_first(1), 1);
  EXPECT_EQ(neighbours_of_first(0.2), 1);
  EXPECT_EQ(neighbours_of_first(1.4), 1);
  EXPECT_EQ(neighbours_of_first(1.6), 0);
}

TEST(SelfContacts, ItemsAreThePairs) {
  constexpr int group = WallContacts::edges_per_group;
  for (const int n : {64, 101, 256})
    for (const int first : {0, n / 4 + 1}) {
      const double rest_edge = units::regular_edge_length(n);
      SelfContacts contacts(rest_edge, rest_edge);
      // One half of the contour is compressed lengthwise, so that parts of one strand with equal directions
      // touch each other.
      Eigen::ArrayXd position = test::dumbbell(n, 0.03);
      position.tail(n) *= (position.head(n) > 0).select(Eigen::ArrayXd::Constant(n, 0.05), 1.0);
      const Eigen::ArrayXd narrow = (position.head(n) > 0).select(0.2 * position.head(n), position.head(n));
      position.head(n) = narrow;
      contacts.update(test::state_of(test::renumbered(position, first)), {});
      std::multiset<std::pair<int, int>> pairs, of_items;
      for (const auto& [vertex, edge] : contacts.pairs()) pairs.insert({vertex, edge});
      bool forwards = false, backwards = false;
      int last_edges = 0;
      for (const SelfContacts::Item& item : contacts.items()) {
        EXPECT_EQ(item.edges % group, 0);
        EXPECT_GE(item.edges, last_edges) << "a group's items follow each other";
        last_edges = item.edges;
        (item.backwards ? backwards : forwards) = true;
        for (int b = 0; b < group; ++b)
          if (item.pairs >> b & 1)
            of_items.insert({(item.vertices + (item.backwards ? group - 1 - b : b)) % n, item.edges + b});
      }
      EXPECT_EQ(of_items, pairs);
      EXPECT_TRUE(forwards && backwards) << n;
      EXPECT_LT(contacts.items().size(), contacts.pairs().size());
    }
}

}  // namespace
}  // namespace clog
