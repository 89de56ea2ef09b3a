#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "clog/fit/clogging_length.hpp"
#include "clog/sweep/run_row.hpp"

namespace clog::results {

/// Relative diameters are counted in classes of this width.
inline constexpr double diameter_class = 0.05;
inline constexpr std::size_t num_diameter_classes = 20;

/// Numbers of droplets in some families, by relative diameter, divided by the number of ancestors.
struct Diameters {
  double number = 0;                ///< droplets per ancestor
  fit::Interval number_interval{};  ///< interval of `number` at a line, from resampled ancestors; NaN for
                                    ///< fewer than ten ancestors, if all ancestors have equal
                                    ///< numbers, or if it is unknown
  double area = 0;                  ///< area of these droplets, divided by the area of the ancestors
  double mean = 0;                  ///< mean diameter of the droplets; NaN without any
  /// Numbers and areas by class. Class i contains the diameters from i * diameter_class to (i + 1) *
  /// diameter_class; the last class also contains the diameter 1.
  std::array<double, num_diameter_classes> numbers{}, areas{};
};

/// A family, and where its ancestor was released.
struct ReleasedFamily {
  std::vector<Member> members;
  double release = 0;  ///< x of the release in a device, otherwise 0 [sigma]
};

/// The fate at a line across the flow of the area of ancestors that were released before it. A droplet passes
/// the line when it is beyond the line for the first time, and no droplet from which it descends has passed
/// before.
struct FamilyLine {
  double distance;   ///< distance of the line from the release; in a device, x of the line [sigma]
  Diameters passed;  ///< droplets that passed the line, with the diameters that they had then
  /// Area that did not pass, in three parts. `clogged`: droplets that clogged before the line. `small`:
  /// droplets before the line that were too small to be followed. `not_known`: droplets that were still
  /// moving or failed. These areas and the area that passed add up to 1.
  double clogged = 0, small = 0, not_known = 0;
  /// Share of the area that passes the line, by the product-limit estimator of Kaplan and Meier with areas as
  /// weights. The droplets in `small` and `not_known` count as censored where they were last seen. The
  /// interval is from resampled ancestors. With fewer than ten ancestors, or if fewer than five lose area or
  /// fewer than five pass area, it is that of a binomial share in which each ancestor with a known fate is
  /// one trial. Share and interval are NaN if no ancestor has a known fate, or if no droplet was followed to
  /// the line, unless all droplets have ended before it.
  double passing = 0;
  fit::Interval interval{};
};

/// The families of a group.
struct Families {
  int num_ancestors = 0;
  double num_daughters = 0;  ///< mean number of daughters of all generations per ancestor
  std::vector<FamilyLine> lines;
  Diameters clogged;  ///< droplets that clogged
};

/// Statistics of families at lines of 10, 20, 50, 100, ... sigma, up to the longest distance of a droplet,
/// and at the given `more_lines`, except lines upstream of all releases. @throws std::invalid_argument unless
/// 0 < confidence < 1
Families families_of(std::span<const ReleasedFamily> families, double confidence,
                     std::span<const double> more_lines = {});

}  // namespace clog::results
