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

#include "clog/fit/percentiles.hpp"
#include "clog/fit/share.hpp"

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

  /// Whether the droplet certainly goes no farther. Nobody knows this of a droplet that was too small to be
  /// followed.
  bool has_stopped() const { return member->status == MemberEnd::clogged; }
};

/// One family as a tree.
class Tree {
 public:
  explicit Tree(const ReleasedFamily& family) : release_(family.release) {
    for (const Member& member : family.members) members_.emplace(member.path, &member);
    add_leaves("", release_);
  }

  double release() const { return release_; }
  const std::vector<Leaf>& leaves() const { return leaves_; }

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

 private:
  std::map<std::string, const Member*> members_;
  double release_;
  std::vector<Leaf> leaves_;

  double reach_of(const Member& member) const {
    return release_ + std::max(member.birth.distance, member.end.distance);
  }

  void add_leaves(const std::string& path, double reach) {
    const auto found = members_.find(path);
    if (found == members_.end()) return;
    const Member& member = *found->second;
    reach = std::max(reach, reach_of(member));
    if (member.status != MemberEnd::broken) leaves_.push_back({&member, reach});
    for (const char part : {'0', '1'}) add_leaves(path + part, reach);
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
/// @param first  the place of the first release; no line is upstream of it
std::vector<double> lines_between(double first, double farthest, std::span<const double> more_lines) {
  std::vector<double> lines(more_lines.begin(), more_lines.end());
  for (double decade = 10; decade <= farthest; decade *= 10)
    for (const double factor : {1, 2, 5})
      if (factor * decade <= farthest) lines.push_back(factor * decade);
  std::erase_if(lines, [first](double line) { return line <= first; });
  std::ranges::sort(lines);
  const auto is_same = [](double one, double other) { return other - one < round_off; };
  lines.erase(std::unique(lines.begin(), lines.end(), is_same), lines.end());
  return lines;
}

/// The product-limit estimator of the share of the area that passes a line.
class ProductLimit {
 public:
  /// @param families  those released before the line
  ProductLimit(double line, const std::vector<const Tree*>& families) : line_(line) {
    for (std::size_t family = 0; family < families.size(); ++family)
      for (const Leaf& leaf : families[family]->leaves())
        steps_.push_back({leaf.reach, area_of(*leaf.member), leaf.has_stopped(), family});
    std::ranges::sort(steps_, {}, &Step::reach);
  }

  /// The share that passes. @param times  number of times that each family counts
  double share(const std::vector<int>& times) const {
    double at_risk = 0;
    for (const Step& step : steps_) at_risk += times[step.family] * step.area;
    double passing = 1;
    for (const Step& step : steps_) {
      if (step.reach >= line_ - round_off) break;
      const double area = times[step.family] * step.area;
      if (step.is_end && at_risk > 0) passing *= std::max(0.0, 1 - area / at_risk);
      at_risk -= area;
    }
    return passing;
  }

  /// Whether a droplet was followed to the line.
  bool has_reached_line() const { return steps_.back().reach >= line_ - round_off; }

 private:
  struct Step {
    double reach, area;
    bool is_end;
    std::size_t family;
  };
  double line_;
  std::vector<Step> steps_;
};

/// Number of families of which each droplet is known to pass the line, or to end before it.
int num_known(double line, const std::vector<const Tree*>& families) {
  return static_cast<int>(std::ranges::count_if(families, [line](const Tree* family) {
    return std::ranges::all_of(family->leaves(), [line](const Leaf& leaf) {
      return leaf.reach >= line - round_off || leaf.has_stopped();
    });
  }));
}

/// The smaller one of two numbers of families: those of which a droplet stopped before the line, and those of
/// which a droplet passed it.
std::ptrdiff_t num_of_rarer_fate(double line, const std::vector<const Tree*>& families) {
  const auto lost = std::ranges::count_if(families, [line](const Tree* family) {
    return std::ranges::any_of(family->leaves(), [line](const Leaf& leaf) {
      return leaf.has_stopped() && leaf.reach < line - round_off;
    });
  });
  const auto passed = std::ranges::count_if(families, [line](const Tree* family) {
    return std::ranges::any_of(family->leaves(),
                               [line](const Leaf& leaf) { return leaf.reach >= line - round_off; });
  });
  return std::min(lost, passed);
}

/// Sets the share that passes, and intervals from resampled families.
/// @param families  those released before the line
void set_estimates(const std::vector<const Tree*>& families, double confidence, FamilyLine& line) {
  constexpr int num_resamples = 2000;
  constexpr std::size_t enough_families = 10;   // Percentiles of fewer families are too narrow,
  constexpr std::ptrdiff_t enough_of_each = 5;  // and so are those of shares that nearly all families have.
  const std::size_t num_families = families.size();
  const ProductLimit estimator(line.distance, families);
  const double passing = estimator.share(std::vector<int>(num_families, 1));
  std::vector<int> counts;  // droplets of each family that pass
  for (const Tree* family : families) {
    counts.push_back(0);
    family->at_line(line.distance, [&](const Member&, bool passes) { counts.back() += passes; });
  }
  std::seed_seq sequence{std::uint32_t{0x66616d69}};  // fixed, so that the output is reproducible
  boost::random::mt19937_64 engine(sequence);
  boost::random::uniform_int_distribution<std::size_t> draw(0, num_families - 1);
  std::vector<double> shares, numbers;
  for (int i = 0; i < num_resamples; ++i) {
    std::vector<int> times(num_families);
    for (std::size_t j = 0; j < num_families; ++j) ++times[draw(engine)];
    shares.push_back(estimator.share(times));
    numbers.push_back(std::inner_product(times.begin(), times.end(), counts.begin(), 0.0) /
                      static_cast<double>(num_families));
  }
  line.passing = no_number;
  line.passed.number_interval = line.interval = {no_number, no_number};
  const bool are_enough = num_families >= enough_families;
  if (are_enough && line.not_known < round_off)
    line.passed.number_interval = fit::percentile_interval(numbers, num_families, confidence);
  if (passing > 0 && !estimator.has_reached_line()) return;
  if (are_enough && num_of_rarer_fate(line.distance, families) >= enough_of_each)
    line.interval = fit::percentile_interval(shares, num_families, confidence);
  const int trials = num_known(line.distance, families);
  if (std::isnan(line.interval.lower) && trials > 0)
    line.interval = fit::share_interval(passing * trials, trials, confidence);
  if (!std::isnan(line.interval.lower)) line.passing = passing;
}

FamilyLine line_at(double distance, const std::vector<Tree>& trees, double confidence) {
  std::vector<const Tree*> families;
  for (const Tree& tree : trees)
    if (tree.release() < distance) families.push_back(&tree);
  FamilyLine line{.distance = distance, .passed = {}};
  for (const Tree* tree : families)
    tree->at_line(distance, [&](const Member& member, bool passes) {
      if (passes)
        add(member, line.passed);
      else if (member.status == MemberEnd::clogged)
        line.clogged += area_of(member);
      else if (member.status == MemberEnd::small)
        line.small += area_of(member);
      else
        line.not_known += area_of(member);
    });
  const auto num_ancestors = static_cast<double>(families.size());
  make_means(line.passed, num_ancestors);
  for (double* area : {&line.clogged, &line.small, &line.not_known}) *area /= num_ancestors;
  set_estimates(families, confidence, line);
  return line;
}

}  // namespace

Families families_of(std::span<const ReleasedFamily> families, double confidence,
                     std::span<const double> more_lines) {
  fit::require_confidence(confidence);
  Families found;
  if (families.empty()) return found;
  std::vector<Tree> trees;
  double first = std::numeric_limits<double>::infinity(), farthest = 0, num_daughters = 0;
  for (const ReleasedFamily& family : families) {
    trees.emplace_back(family);
    num_daughters += static_cast<double>(family.members.size() - 1);
    first = std::min(first, family.release);
    for (const Leaf& leaf : trees.back().leaves()) {
      farthest = std::max(farthest, leaf.reach);
      if (leaf.member->status == MemberEnd::clogged) add(*leaf.member, found.clogged);
    }
  }
  const auto num_ancestors = static_cast<double>(families.size());
  found.num_ancestors = static_cast<int>(families.size());
  found.num_daughters = num_daughters / num_ancestors;
  make_means(found.clogged, num_ancestors);
  for (const double distance : lines_between(first, farthest, more_lines))
    found.lines.push_back(line_at(distance, trees, confidence));
  return found;
}

}  // namespace clog::results
