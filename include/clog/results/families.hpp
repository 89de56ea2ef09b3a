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

/// The droplets of some families by their relative diameters, per ancestor.
struct Diameters {
  double number = 0;  ///< droplets per ancestor
  double area = 0;    ///< their area, divided by the ancestor's
  double mean = 0;    ///< mean diameter of the droplets; NaN without any
  /// Numbers and areas by class; class i holds the diameters from i to i + 1 times diameter_class, and the
  /// last class those of 1.
  std::array<double, num_diameter_classes> numbers{}, areas{};
};

/// What has become of the ancestors' area at a line across the flow. A droplet passes the line when it, or a
/// droplet from which it descends, is beyond the line for the first time.
struct FamilyLine {
  double distance;   ///< from the release [sigma]
  Diameters passed;  ///< droplets that passed the line, with the diameters that they had then
  /// Area that did not: of droplets that clogged before the line, of droplets before it that were too small
  /// to be followed, and of those that were still moving or failed. The four areas add up to 1.
  double clogged = 0, small = 0, not_known = 0;
  /// Share of the area that passes the line, by the product-limit estimator of Kaplan and Meier, with areas
  /// as weights: droplets of which it is not known count up to where they were last seen. The interval is
  /// from resampled ancestors; NaN if it is unknown.
  double passing = 0;
  fit::Interval interval{};
};

/// The families of a group.
struct Families {
  int num_ancestors = 0;
  double num_daughters = 0;  ///< mean number of daughters per ancestor, those that broke up again included
  std::vector<FamilyLine> lines;
  Diameters clogged;  ///< droplets that clogged
};

/// Statistics of the rows with a family, at lines of 10, 20, 50, 100, ... sigma as far as any droplet went.
/// @throws std::invalid_argument unless 0 < confidence < 1
Families families_of(std::span<const std::vector<Member>> families, double confidence);

}  // namespace clog::results
