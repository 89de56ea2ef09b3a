#include "wall_windows.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

namespace clog {
namespace {

bool is_same_circle(const kernel::WallWindow& window, const WallContacts::Item& item) {
  return window.x == item.x && window.y == item.y && window.reach == item.reach;
}

}  // namespace

void list_windows(const std::vector<WallContacts::Item>& near, int num_groups,
                  std::vector<kernel::WallWindow>& windows) {
  windows.clear();
  for (const WallContacts::Item& item : near) {
    const int begin = item.group * kernel::edges_per_group;
    assert(item.group >= 0 && item.group < num_groups);
    assert(windows.empty() || !is_same_circle(windows.back(), item) || windows.back().first < begin);
    for (unsigned edges = item.edges; edges != 0;) {
      const int edge = begin + std::countr_zero(edges);
      const bool is_inside = !windows.empty() && is_same_circle(windows.back(), item) &&
                             edge >= windows.back().first &&
                             edge - windows.back().first < kernel::edges_per_group;
      if (!is_inside)
        // A window must not start behind the last group, because entries beyond its end cannot be read.
        windows.push_back({item.x, item.y, item.reach,
                           std::min(edge, (num_groups - 1) * kernel::edges_per_group), 0, item.layer});
      kernel::WallWindow& window = windows.back();
      const int ahead = begin - window.first;
      const unsigned inside = (ahead >= 0 ? edges << ahead : edges >> -ahead) & 0xffU;
      window.edges |= static_cast<std::uint8_t>(inside);
      edges &= ~(ahead >= 0 ? inside >> ahead : inside << -ahead);
    }
  }
}

void mark_pushed_groups(const kernel::WallWindow& window, std::vector<std::uint8_t>& is_pushed) {
  const auto first =
      is_pushed.begin() + (window.first - 1 + kernel::edges_per_group) / kernel::edges_per_group;
  assert((window.first + kernel::edges_per_group + 1) / kernel::edges_per_group + 2 <= std::ssize(is_pushed));
  std::fill(first,
            is_pushed.begin() + (window.first + kernel::edges_per_group + 1) / kernel::edges_per_group + 2,
            std::uint8_t{1});
}

}  // namespace clog
