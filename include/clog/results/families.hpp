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

/// The droplets of some families, counted by relative diameter; per ancestor.
struct Diameters {
  double number = 0;                ///< droplets per ancestor
  fit::Interval number_interval{};  ///< at a line, from resampled ancestors; NaN for fewer than ten of them,
                                    ///< if it is unknown, or if all have equal numbers
  double area = 0;                  ///< area of these droplets, divided by the area of the ancestors
  double mean = 0;                  ///< mean diameter of the droplets; NaN without any
  /// Numbers and areas by class. Class i contains the diameters from i * diameter_class to (i + 1) *
  /// diameter_class; the last class also contains the diameter 1.
  std::array<double, num_diameter_classes> numbers{}, areas{};
};

/// A family, and where its ancestor was released.
struct ReleasedFamily {
  std::vector<Member> members;
  double release = 0;  ///< x in a device, otherwise 0 [sigma]
};

/// The fate at a line across the flow of the area of ancestors that were released before it. A droplet passes
/// the line when it is beyond the line for the first time, and no droplet from which it descends has passed
/// before.
struct FamilyLine {
  double distance;   ///< from the release, or x in a device [sigma]
  Diameters passed;  ///< droplets that passed the line, with the diameters that they had then
  /// Area that did not pass: of droplets that clogged before the line, of droplets before it that were too
  /// small to be followed, and of droplets that were still moving or failed. The four areas add up to 1.
  double clogged = 0, small = 0, not_known = 0;
  /// Share of the area that passes the line, by the product-limit estimator of Kaplan and Meier with areas as
  /// weights. The droplets in `small` and `not_known` count as censored where they were last seen. NaN if no
  /// droplet was followed to the line, and not all have ended before it. The interval is from resampled
  /// ancestors. With fewer than ten ancestors, or if all area passes or none, it is that of a binomial share,
  /// as if each ancestor whose fate is known passed whole or not at all. NaN if it is unknown.
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

/// Statistics of families at lines of 10, 20, 50, 100, ... sigma, as far as any droplet went, and at more
/// lines, except lines upstream of all releases. @throws std::invalid_argument unless 0 < confidence < 1
Families families_of(std::span<const ReleasedFamily> families, double confidence,
                     std::span<const double> more_lines = {});

}  // namespace clog::results
