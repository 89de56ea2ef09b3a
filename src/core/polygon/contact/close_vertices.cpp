#include "close_vertices.hpp"

#include "core/tools/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/polygon/contact/close_vertices.cpp"
#include <hwy/foreach_target.h>
// The targets' code follows.
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace clog::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int group_size = 8;
using D = hn::CappedTag<double, group_size>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

constexpr int lanes = static_cast<int>(MaxLanes(D()));

HWY_INLINE V all(double value) { return hn::Set(D(), value); }
HWY_INLINE V load(const double* p) { return hn::LoadU(D(), p); }
HWY_INLINE V square(V x, V y) { return hn::MulAdd(x, x, hn::Mul(y, y)); }

/// Calls visit(k) for every lane k of the mask.
template <class Visit>
HWY_INLINE void for_lanes(M mask, Visit visit) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(D(), mask, bytes);
  for (unsigned bits = bytes[0]; bits != 0; bits &= bits - 1) visit(std::countr_zero(bits));
}

class Search {
 public:
  Search(const CloseSearch& search, std::vector<double>& groups, std::vector<VertexPair>& pairs)
      : c_(search), reach2_(all(c_.reach * c_.reach)), groups_(groups), pairs_(pairs) {}

  void run() {
    if (along_may_meet()) list_along();
    list_far();
  }

 private:
  /// list_along() finds pairs that are at most this many vertices apart. list_far() finds all other pairs;
  /// their groups are not neighbours.
  static constexpr int last_along = 2 * group_size - 1;
  static_assert(last_along + group_size <= close_vertices_beyond);

  CloseSearch c_;
  V reach2_;
  std::vector<double>& groups_;
  std::vector<VertexPair>& pairs_;

  /// Squared distances of the vertices from i on to the vertices that are `ahead` places further along the
  /// contour.
  HWY_INLINE V distance2(int i, int ahead) const {
    return square(hn::Sub(load(c_.x + i + ahead), load(c_.x + i)),
                  hn::Sub(load(c_.y + i + ahead), load(c_.y + i)));
  }

  bool excluded_are_long() const { return (c_.exclusion - 1) * c_.longest_edge >= c_.arc; }

  /// Returns false only if no pair that list_along() would find is close. Tests all pairs up to 7 vertices
  /// apart. Pairs that are 9 vertices apart stand for pairs that are 8 to 10 apart; they are tested with a
  /// reach longer by one edge. Pairs that are 13 apart stand for pairs that are 11 to 15 apart, with a reach
  /// longer by two edges.
  bool along_may_meet() const {
    constexpr int last_tested = 7, third = 9, fifth = 13;
    if (c_.exclusion > last_tested || excluded_are_long()) return true;
    const auto farther = [&](int edges) {
      const double reach = c_.reach + edges * c_.longest_edge;
      return all(reach * reach);
    };
    const V one_more = farther(1), two_more = farther(2);
    M hit = hn::FirstN(D(), 0);
    for (int i = 0; i < c_.n; i += lanes) {
      for (int k = c_.exclusion; k <= last_tested; ++k) hit = hn::Or(hit, hn::Le(distance2(i, k), reach2_));
      hit = hn::Or(hit, hn::Or(hn::Le(distance2(i, third), one_more), hn::Le(distance2(i, fifth), two_more)));
    }
    return !hn::AllFalse(D(), hit);
  }

  void list_along() {
    // A pair that is more than half the contour apart is found from the other vertex of the pair.
    const int last = std::min(last_along, c_.n / 2);
    for (int k = excluded_are_long() ? 1 : c_.exclusion; k <= last; ++k) {
      const int end = 2 * k == c_.n ? k : c_.n;
      for (int i = 0; i < end; i += lanes) {
        M near = hn::Le(distance2(i, k), reach2_);
        if (k < c_.exclusion)
          near = hn::And(near, hn::Ge(hn::Sub(load(c_.along + i + k), load(c_.along + i)), all(c_.arc)));
        if (hn::AllFalse(D(), near)) continue;
        for_lanes(near, [&](int lane) {
          const int vertex = i + lane;
          if (vertex < end) pairs_.push_back({vertex, vertex + k < c_.n ? vertex + k : vertex + k - c_.n});
        });
      }
    }
  }

  /// Lists pairs in groups that are not neighbours. A test of bounding circles excludes most pairs of groups.
  /// The centre of a bounding circle is midway between the ends of the group's arc, because no point of the
  /// arc is farther from there than half of the arc's length.
  void list_far() {
    const int num_groups = (c_.n + group_size - 1) / group_size;
    const int stride = num_groups + lanes;
    groups_.assign(std::size_t{3} * stride, 0);
    double *x = groups_.data(), *y = x + stride, *radius = y + stride;
    for (int g = 0; g < num_groups; ++g) {
      const int begin = g * group_size,
                end = begin + group_size - 1;  // entries beyond the last entry repeat the first ones
      x[g] = (c_.x[begin] + c_.x[end]) / 2;
      y[g] = (c_.y[begin] + c_.y[end]) / 2;
      radius[g] = (c_.along[end] - c_.along[begin]) / 2;
    }
    for (int g = 0; g + 2 < num_groups; ++g) {
      const V to_x = all(x[g]), to_y = all(y[g]), own = all(c_.reach + radius[g]);
      const int end = g == 0 ? num_groups - 1 : num_groups;  // the last group is next to the first
      for (int h = g + 2; h < end; h += lanes) {
        const V way = hn::Add(load(radius + h), own);
        const M near =
            hn::Le(square(hn::Sub(load(x + h), to_x), hn::Sub(load(y + h), to_y)), hn::Mul(way, way));
        if (hn::AllFalse(D(), near)) continue;
        for_lanes(near, [&](int lane) {
          if (h + lane < end) list_between(g * group_size, (h + lane) * group_size);
        });
      }
    }
  }

  /// Lists the pairs of two groups; the first group precedes the second.
  void list_between(int first, int second) {
    const int end = std::min(second + group_size, c_.n);
    for (int i = first; i < first + group_size; i += lanes) {
      const V x = load(c_.x + i), y = load(c_.y + i);
      for (int j = second; j < end; ++j) {
        const M near = hn::Le(square(hn::Sub(x, all(c_.x[j])), hn::Sub(y, all(c_.y[j]))), reach2_);
        if (hn::AllFalse(D(), near)) continue;
        for_lanes(near, [&](int lane) {
          const int vertex = i + lane, apart = std::min(j - vertex, c_.n - (j - vertex));
          if (apart > last_along) pairs_.push_back({vertex, j});
        });
      }
    }
  }
};

void find_close_vertices(const CloseSearch& search, std::vector<double>& groups,
                         std::vector<VertexPair>& pairs) {
  pairs.clear();
  Search(search, groups, pairs).run();
}

}  // namespace clog::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clog::kernel {

HWY_EXPORT(find_close_vertices);

void find_close_vertices(const CloseSearch& search, std::vector<double>& groups,
                         std::vector<VertexPair>& pairs) {
  HWY_DYNAMIC_DISPATCH(find_close_vertices)(search, groups, pairs);
}

}  // namespace clog::kernel
#endif
