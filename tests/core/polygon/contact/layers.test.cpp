/// Tests the layers of an interface that rests on itself over a circle (docs/explanation/model.md).

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "clog/core/polygon/contact/wall_contacts.hpp"
#include "support.hpp"

namespace clog::test_of_layers {
namespace {

using std::numbers::pi;

constexpr double disc = 0.5, range = 0.01, film = 0.02;
constexpr int on_arc = 41;

/// A contour of half circles around the origin at these distances from the disc. Their directions alternate.
/// The end of the last half circle is joined to the first one far outside.
DropletState stack(const std::vector<double>& heights) {
  std::vector<double> radii;
  radii.reserve(heights.size() + 1);
  for (const double height : heights) radii.push_back(disc + height);
  if (radii.size() % 2 != 0) radii.push_back(3 * disc);
  const int n = static_cast<int>(radii.size()) * on_arc;
  DropletState state = test::state_of(Eigen::ArrayXd(Eigen::Index{2} * n));
  for (int i = 0; i < n; ++i) {
    const int arc = i / on_arc, k = i % on_arc;
    const double angle = pi * (arc % 2 == 0 ? k : on_arc - 1 - k) / (on_arc - 1);
    state.position[i] = radii[static_cast<std::size_t>(arc)] * std::cos(angle);
    state.position[n + i] = radii[static_cast<std::size_t>(arc)] * std::sin(angle);
  }
  return state;
}

/// For each arc and layer, the number of edges in the middle of the arc that have a contact with the disc in
/// this layer.
std::map<std::pair<int, int>, int> layers_of(const DropletState& state, double thickness = film) {
  const ObstacleArray walls(20, {{0, 0, disc}});
  WallContacts contacts(walls, range, WallContacts::Keep::touched_by_edge, thickness);
  contacts.update(state, {});
  std::map<std::pair<int, int>, int> found;
  for (const WallContacts::Item& item : contacts.items())
    for (unsigned bits = item.edges; bits != 0; bits &= bits - 1) {
      const int edge = item.group * WallContacts::edges_per_group + std::countr_zero(bits);
      EXPECT_DOUBLE_EQ(item.reach, disc + range + item.layer * thickness);
      const int k = edge % on_arc;
      if (k > on_arc / 4 && k < 3 * on_arc / 4) ++found[{edge / on_arc, item.layer}];
    }
  return found;
}

TEST(Layers, AreCountedFromTheCircleOutwards) {
  const int num = 3 * on_arc / 4 - on_arc / 4 - 1;
  const std::vector<double> heights = {range, range + film, range + 2 * film, range + 3 * film};
  const std::map<std::pair<int, int>, int> expected = {
      {{0, 0}, num}, {{1, 1}, num}, {{2, 2}, num}, {{3, 3}, num}};
  EXPECT_EQ(layers_of(stack(heights)), expected);
  // Without self-contact there are no layers: all parts of the interface touch the circle itself.
  for (const auto& [arc_and_layer, count] : layers_of(stack(heights), 0)) EXPECT_EQ(arc_and_layer.second, 0);
}

TEST(Layers, AboveTheThirdAreNotCounted) {
  const auto found =
      layers_of(stack({range, range + film, range + 2 * film, range + 3 * film, range + 3.5 * film}));
  EXPECT_TRUE(found.contains({4, WallContacts::highest_layer}));
  EXPECT_FALSE(found.contains({4, WallContacts::highest_layer + 1}));
}

TEST(Layers, NeedOtherPartsBelow) {
  // The lowest arc hovers, but nothing is between it and the disc.
  const auto found = layers_of(stack({range + film, range + 2 * film}));
  EXPECT_TRUE(found.contains({0, 0}));
  EXPECT_TRUE(found.contains({1, 1}));
}

TEST(Layers, DoNotThrowOffAnEdgeThatIsTooLow) {
  const auto found = layers_of(stack({range, range + 0.5 * film}));
  EXPECT_TRUE(found.contains({1, 0}));
  EXPECT_FALSE(found.contains({1, 1}));
}

}  // namespace
}  // namespace clog::test_of_layers
