#include "clog/results/families.hpp"

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <string>

namespace clog::results {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double round_off = 1e-6;  // of places [sigma]

double area_of(const Member& member) { return member.diameter * member.diameter; }

/// A droplet that did not break up: its end, and the largest distance that it or one of its ancestors
/// reached.
struct Leaf {
  const Member* member;
  double reach;  ///< [sigma]

  /// Whether the droplet certainly goes no farther.
  bool has_stopped() const {
    return member->status == MemberEnd::clogged || member->status == MemberEnd::small;
  }
};

/// One family as a tree.
class Tree {
 public:
  explicit Tree(const ReleasedFamily& family) : release_(family.release) {
    for (const Member& member : family.members) members_.emplace(member.path, &member);
  }

  /// Calls visit(member, true) for each droplet that passes the line if none of its ancestors has passed.
  /// Calls visit(member, false) for each droplet that ends before the line.
  template <class Visit>
  void at_line(double distance, const Visit& visit, const std::string& path = "") const {
    const auto found = members_.find(path);
    if (found == members_.end()) return;
    const Member& member = *found->second;
    const bool passes = reach_of(member) >= distance - round_off;
    if (passes || member.status != MemberEnd::broken) {
      visit(member, passes);
      return;
    }
    for (const char part : {'0', '1'}) at_line(distance, visit, path + part);
  }

  std::vector<Leaf> leaves() const {
    std::vector<Leaf> all;
    add_leaves("", release_, all);
    return all;
  }

 private:
  std::map<std::string, const Member*> members_;
  double release_;

  double reach_of(const Member& member) const {
    return release_ + std::max(member.birth.distance, member.end.distance);
  }

  void add_leaves(const std::string& path, double reach, std::vector<Leaf>& all) const {
    const auto found = members_.find(path);
    if (found == members_.end()) return;
    const Member& member = *found->second;
    reach = std::max(reach, reach_of(member));
    if (member.status != MemberEnd::broken) all.push_back({&member, reach});
    for (const char part : {'0', '1'}) add_leaves(path + part, reach, all);
  }
};

void add(const Member& member, Diameters& all) {
  const auto number =
      std::min(static_cast<std::size_t>(member.diameter / diameter_class), num_diameter_classes - 1);
  all.number += 1;
  all.area += area_of(member);
  all.mean += member.diameter;
  all.numbers[number] += 1;
  all.areas[number] += area_of(member);
}

/// Divides sums over all ancestors by their number.
void make_means(Diameters& all, double num_ancestors) {
  all.mean = all.number > 0 ? all.mean / all.number : no_number;
  for (double* sum : {&all.number, &all.area}) *sum /= num_ancestors;
  for (auto* sums : {&all.numbers, &all.areas})
    for (double& sum : *sums) sum /= num_ancestors;
}

/// Lines of 10, 20, 50, 100, ... sigma, and more lines.
std::vector<double> lines_up_to(double farthest, std::span<const double> more_lines) {
  std::vector<double> lines(more_lines.begin(), more_lines.end());
  for (double decade = 10; decade <= farthest; decade *= 10)
    for (const double factor : {1, 2, 5})
      if (factor * decade <= farthest) lines.push_back(factor * decade);
  std::ranges::sort(lines);
  const auto is_same = [](double one, double other) { return other - one < round_off; };
  lines.erase(std::unique(lines.begin(), lines.end(), is_same), lines.end());
  return lines;
}

/// Number of droplets of each family that pass a line.
std::vector<int> numbers_at(double distance, const std::vector<Tree>& trees) {
  std::vector<int> numbers;
  for (const Tree& tree : trees) {
    numbers.push_back(0);
    tree.at_line(distance, [&](const Member&, bool passes) { numbers.back() += passes; });
  }
  return numbers;
}

/// Product-limit estimates at the lines.
/// @param leaves  leaves of all families
/// @param times  number of times that each family counts
class ProductLimit {
 public:
  ProductLimit(const std::vector<std::vector<Leaf>>& leaves) {
    for (std::size_t family = 0; family < leaves.size(); ++family)
      for (const Leaf& leaf : leaves[family])
        steps_.push_back({leaf.reach, area_of(*leaf.member), leaf.has_stopped(), family});
    std::ranges::sort(steps_, {}, &Step::reach);
  }

  /// The shares of the area that pass the lines. Beyond the last droplet the share is constant.
  std::vector<double> at(const std::vector<double>& lines, const std::vector<int>& times) const {
    double at_risk = 0;
    for (const Step& step : steps_) at_risk += times[step.family] * step.area;
    std::vector<double> passing;
    double share = 1;
    auto step = steps_.begin();
    for (const double line : lines) {
      for (; step != steps_.end() && step->reach < line - round_off; ++step) {
        const double area = times[step->family] * step->area;
        if (step->is_end && at_risk > 0) share *= std::max(0.0, 1 - area / at_risk);
        at_risk -= area;
      }
      passing.push_back(share);
    }
    return passing;
  }

  /// Place of the last droplet [sigma].
  double last() const { return steps_.back().reach; }

 private:
  struct Step {
    double reach, area;
    bool is_end;
    std::size_t family;
  };
  std::vector<Step> steps_;
};

/// Percentiles of resampled values; NaN if there are too few values.
fit::Interval percentiles(std::vector<double> values, double confidence) {
  std::ranges::sort(values);
  const double last = static_cast<double>(values.size()) - 1, tail = (1 - confidence) / 2 * last;
  if (tail < 1) return {no_number, no_number};
  return {values[static_cast<std::size_t>(tail)], values[static_cast<std::size_t>(std::ceil(last - tail))]};
}

/// Interval by Clopper and Pearson of a share that is 0 in each of `num_families` families, or 1 in each of
/// them.
fit::Interval without_variation(double share, int num_families, double confidence) {
  if (num_families == 0) return {no_number, no_number};
  const double certain = std::pow((1 - confidence) / 2, 1.0 / num_families);
  return share == 0 ? fit::Interval{0, 1 - certain} : fit::Interval{certain, 1};
}

/// Number of families whose whole area passes a line (`pass`), or whose whole area ends before the line.
int num_alike(const std::vector<std::vector<Leaf>>& leaves, double distance, bool pass) {
  return static_cast<int>(std::ranges::count_if(leaves, [&](const std::vector<Leaf>& family) {
    return std::ranges::all_of(family, [&](const Leaf& leaf) {
      const bool has_passed = leaf.reach >= distance - round_off;
      return pass ? has_passed : !has_passed && leaf.has_stopped();
    });
  }));
}

/// Sets the shares that pass the lines, and the intervals from resampled ancestors.
void set_estimates(const std::vector<Tree>& trees, const std::vector<std::vector<Leaf>>& leaves,
                   double confidence, const std::vector<double>& distances, std::vector<FamilyLine>& lines) {
  constexpr int num_resamples = 2000;
  const ProductLimit estimator(leaves);
  const std::size_t num_families = trees.size();
  const std::vector<double> passing = estimator.at(distances, std::vector<int>(num_families, 1));
  std::seed_seq sequence{std::uint32_t{0x66616d69}};  // fixed, so that the output is reproducible
  boost::random::mt19937_64 engine(sequence);
  boost::random::uniform_int_distribution<std::size_t> draw(0, num_families - 1);
  std::vector<std::vector<double>> shares(lines.size()), numbers(lines.size());
  std::vector<std::vector<int>> counts;
  for (const double distance : distances) counts.push_back(numbers_at(distance, trees));
  for (int i = 0; i < num_resamples; ++i) {
    std::vector<int> times(num_families);
    for (std::size_t j = 0; j < num_families; ++j) ++times[draw(engine)];
    const std::vector<double> drawn = estimator.at(distances, times);
    for (std::size_t line = 0; line < lines.size(); ++line) {
      shares[line].push_back(drawn[line]);
      numbers[line].push_back(std::inner_product(times.begin(), times.end(), counts[line].begin(), 0.0) /
                              static_cast<double>(num_families));
    }
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool is_known = passing[i] == 0 || distances[i] <= estimator.last() + round_off;
    const fit::Interval unknown{no_number, no_number};
    FamilyLine& line = lines[i];
    line.passing = is_known ? passing[i] : no_number;
    const auto [fewest, most] = std::ranges::minmax(counts[i]);
    const bool are_all_counted = line.not_known < round_off;
    line.passed.number_interval =
        are_all_counted && fewest < most ? percentiles(numbers[i], confidence) : unknown;
    if (!is_known)
      line.interval = unknown;
    else if (passing[i] == 0 || passing[i] == 1)
      line.interval =
          without_variation(passing[i], num_alike(leaves, distances[i], passing[i] == 1), confidence);
    else
      line.interval = num_families > 1 ? percentiles(shares[i], confidence) : unknown;
  }
}

FamilyLine line_at(double distance, const std::vector<Tree>& trees) {
  FamilyLine line{.distance = distance, .passed = {}};
  for (const Tree& tree : trees)
    tree.at_line(distance, [&](const Member& member, bool passes) {
      if (passes)
        add(member, line.passed);
      else if (member.status == MemberEnd::clogged)
        line.clogged += area_of(member);
      else if (member.status == MemberEnd::small)
        line.small += area_of(member);
      else
        line.not_known += area_of(member);
    });
  const auto num_ancestors = static_cast<double>(trees.size());
  make_means(line.passed, num_ancestors);
  for (double* area : {&line.clogged, &line.small, &line.not_known}) *area /= num_ancestors;
  return line;
}

}  // namespace

Families families_of(std::span<const ReleasedFamily> families, double confidence,
                     std::span<const double> more_lines) {
  fit::require_confidence(confidence);
  Families found;
  if (families.empty()) return found;
  std::vector<Tree> trees;
  std::vector<std::vector<Leaf>> leaves;
  double farthest = 0, num_daughters = 0;
  for (const ReleasedFamily& family : families) {
    trees.emplace_back(family);
    leaves.push_back(trees.back().leaves());
    num_daughters += static_cast<double>(family.members.size() - 1);
    for (const Leaf& leaf : leaves.back()) {
      farthest = std::max(farthest, leaf.reach);
      if (leaf.member->status == MemberEnd::clogged) add(*leaf.member, found.clogged);
    }
  }
  const auto num_ancestors = static_cast<double>(families.size());
  found.num_ancestors = static_cast<int>(families.size());
  found.num_daughters = num_daughters / num_ancestors;
  make_means(found.clogged, num_ancestors);
  const std::vector<double> distances = lines_up_to(farthest, more_lines);
  for (const double distance : distances) found.lines.push_back(line_at(distance, trees));
  set_estimates(trees, leaves, confidence, distances, found.lines);
  return found;
}

}  // namespace clog::results
