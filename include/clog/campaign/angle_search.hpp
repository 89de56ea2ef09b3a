#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "clog/campaign/round_rule.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/sweep/points.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::campaign {

/// What the runs at one angle of a lattice say. A droplet leaves the rows if it ends farther than the
/// distance between two rows from the line that runs along them through its place of release. It follows them
/// if it ends nearer, although straight along the flow it would have crossed two rows.
struct TriedAngle {
  double angle = 0;  ///< [degrees]
  int num_following = 0;
  int num_leaving = 0;
  int num_short = 0;  ///< runs that ended too early to say

  bool follows() const { return num_following > 0 && num_leaving == 0; }
  bool leaves() const { return num_leaving > 0; }
};
/// Counts one run. @param along, across  displacement along the flow and across it [sigma]
/// @param spacing  distance between two rows [sigma]
void count_run(TriedAngle& angle, double along, double across, double spacing);

/// The critical angle lies between these: at the lower one all droplets follow the rows, at the upper one,
/// the smallest such, some leave them. NaN: not known.
struct AngleBracket {
  double lower = std::numeric_limits<double>::quiet_NaN();
  double upper = std::numeric_limits<double>::quiet_NaN();
};
/// @param angles  in increasing order
AngleBracket critical_bracket(std::span<const TriedAngle> angles);

/// A sweep over lattice-angle that finds the angle at which droplets stop following the rows: each round
/// divides the bracket in four, at the lattices nearest to these places that fit the box.
class AngleSearch final : public RoundRule {
 public:
  struct Options {
    double width = 0;                                         ///< of the bracket, at most [degrees]
    double budget = std::numeric_limits<double>::infinity();  ///< computing time of all runs [s]
  };
  /// @param settings  of the command: one value of every key other than lattice-angle and seeds; two angles
  /// are bounds, to which the first round adds three in between
  /// @throws Error that names the key or option
  AngleSearch(const sweep::Settings& settings, Options options);

  const sweep::Settings& first() const override { return first_; }
  std::optional<sweep::Points> next_round(std::span<const sweep::RunRow> rows) override;
  std::string text() const override;
  std::vector<std::string> rounds_in_words(double seconds_per_run) const override;
  std::string known(std::span<const sweep::RunRow> rows) const override;

 private:
  Options options_;
  sweep::Settings first_;
  ObstacleParameters obstacles_;  // with the box of the command, not that of a lattice
  RunParameters usual_;           // the first run
  std::string seeds_;
  double lowest_ = 0, highest_ = 0;  // angles of the first round
  std::string end_;                  // why there is no further round

  struct Look;
  Look look(std::span<const sweep::RunRow> rows) const;
  std::vector<std::string> angles_within(const AngleBracket& bracket, std::span<const double> tried) const;
  sweep::Points points_of(const std::vector<std::string>& angles) const;
};

}  // namespace clog::campaign
