#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "clog/core/droplet/droplet.hpp"
#include "clog/core/droplet/equilibrium.hpp"
#include "clog/core/droplet/hold.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/run/contact_record.hpp"
#include "clog/core/run/displacement_record.hpp"
#include "clog/core/run/dwell_record.hpp"
#include "clog/core/run/passage.hpp"
#include "clog/core/run/steady_record.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

enum class RunStatus { running, clogged, broken, flowing, passed, interrupted, failed };
template <>
struct Words<RunStatus> {
  static constexpr Worded<RunStatus> all[] = {
      {RunStatus::running, "running"}, {RunStatus::clogged, "clogged"},
      {RunStatus::broken, "broken"},   {RunStatus::flowing, "flowing"},
      {RunStatus::passed, "passed"},   {RunStatus::interrupted, "interrupted"},
      {RunStatus::failed, "failed"}};
};

/// Why a run failed. Divergence and crossing depend only on the run's parameters and seed, so no retry can
/// succeed. A crash is an exception or the end of the process, and the machine may be its cause.
enum class FailedBy { none, divergence, crossing, crash };
template <>
struct Words<FailedBy> {
  static constexpr Worded<FailedBy> all[] = {{FailedBy::none, "none"},
                                             {FailedBy::divergence, "divergence"},
                                             {FailedBy::crossing, "crossing"},
                                             {FailedBy::crash, "crash"}};
};

/// How a clog was found.
enum class FoundBy { not_clogged, threshold, certified };
template <>
struct Words<FoundBy> {
  static constexpr Worded<FoundBy> all[] = {
      {FoundBy::certified, "certified"}, {FoundBy::threshold, "threshold"}, {FoundBy::not_clogged, "none"}};
};

/// E_k/E_t above which the integration has failed. A free fall without drag over a whole box stays below this
/// ratio.
inline constexpr double diverged_energy_ratio = 1e8;
/// Relative error of the area above which the integration has failed. Compressibility and line tension change
/// the area by much less than this.
inline constexpr double diverged_area_error = 0.5;

/// Distance by which a droplet on a flat wall sinks when its weight begins to act [sigma]; NaN in other
/// scenes.
struct Sag {
  double centre = std::numeric_limits<double>::quiet_NaN();  ///< distance by which the area's centroid sinks
  double top = std::numeric_limits<double>::quiet_NaN();     ///< delta_s
};

/// The thinnest neck of a droplet so far, and where the droplet was then [sigma]; NaN without a neck, or
/// without a search. After the first neck, the program searches only for thinner ones.
struct ThinnestNeck {
  double width = std::numeric_limits<double>::quiet_NaN();
  double distance = std::numeric_limits<double>::quiet_NaN();
};

/// The results of one run. If a clog is certified, values with the note "certified: at rest" are those of the
/// equilibrium. An empty `optional` is a value that is unknown, because an older version wrote the row.
struct RunResult {
  RunStatus status = RunStatus::running;
  std::optional<FoundBy> clogged_by = FoundBy::not_clogged;
  std::optional<Stability> stability = Stability::none;  ///< of a clogged droplet: stable or unknown
  std::optional<FailedBy> failed_by = FailedBy::none;
  double distance = 0;  ///< displacement along the flow since release, certified: at rest [sigma]
  /// `distance` at the last check that found the droplet intact [sigma]. With self-contact, intact means also
  /// that the droplet does not cross itself.
  double sound_distance = 0;
  double lateral = 0;   ///< displacement across the flow, certified: at rest [sigma]
  double time = 0;      ///< [t0]
  TravelSpeed speed;    ///< speed of the run so far
  SteadyTravel steady;  ///< travel until the end, or until the last dwell of a clogged run began
  Dwells dwells;
  Contacts contacts;
  double kinetic_energy_ratio = 0;  ///< E_k/E_t at the end
  double shape_parameter = 0;       ///< A at the end, certified: at rest
  Hold hold;                        ///< what holds a clogged droplet, certified: at rest
  Passage passage;                  ///< passage through a channel; NaN elsewhere
  Sag sag;                          ///< certified: at rest
  ThinnestNeck neck;
  /// Number of times that a vertex of the interface passed through another part of it and was pushed back.
  std::int64_t healed_crossings = 0;
  /// Where the centre of mass was released, in the coordinates of user-supplied circles; NaN elsewhere
  /// [sigma].
  Eigen::Array2d release{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  std::int64_t steps = 0;  ///< integrated steps; each sub-step counts as one
  std::string message;     ///< why the run failed
};

/// One droplet followed from its release until it clogs, breaks up, passes, or reaches max-time.
///
/// The droplet counts as clogged when E_k/E_t has been below clog-energy at two consecutive checks, after at
/// least ten relaxation times V_t/g (E_t: kinetic energy at terminal speed). The exception is a droplet that
/// balances, according to stability_of(): its run continues, and the stability is tested again when E_k/E_t
/// has changed tenfold. With clog-detection=certified, the droplet also counts as clogged as soon as
/// find_equilibrium() finds its place of rest. A droplet with a neck thinner than break-up-neck has broken
/// up, even if it is almost at rest; an equilibrium with such a thin neck does not count. If the interface
/// crosses itself although self-contact is on, the run fails. The course of a run depends on its parameters
/// alone. It depends neither on the calls of advance() nor on the method that detects clogs.
class DropletRun {
 public:
  /// Clogs and the end of the run are checked, and r(t) is recorded, once in this number of steps.
  static constexpr int steps_per_check = 64;
  /// A snapshot is taken once in this number of steps. With 256 vertices, these steps take about a quarter of
  /// a second.
  static constexpr std::int64_t steps_per_snapshot = std::int64_t{4096} * steps_per_check;

  /// Releases the droplet as its scene defines. @param run  resolved parameters, here and below
  explicit DropletRun(const RunParameters& run);
  /// Releases the droplet as its scene defines, but among the given walls.
  DropletRun(const RunParameters& run, const std::shared_ptr<const ObstacleArray>& obstacles);
  /// @param initial  the droplet at its release
  /// @param passing_distance  displacement along the flow after which the droplet has `passed` [sigma]
  DropletRun(RunParameters run, std::shared_ptr<const ObstacleArray> obstacles, DropletState initial,
             double passing_distance = std::numeric_limits<double>::infinity());

  /// A run restored from a snapshot() continues bit for bit like the original, because the original run also
  /// rebuilds its contact lists when it takes the snapshot.
  /// @param run, obstacles  as in the original run
  /// @throws Error if the bytes are not a snapshot of such a run
  static DropletRun resume(const RunParameters& run, std::shared_ptr<const ObstacleArray> obstacles,
                           std::span<const std::byte> snapshot);
  /// The last snapshot; empty before the first one.
  const std::vector<std::byte>& snapshot() const { return snapshot_; }
  /// The state of a run after its droplet broke up, from which broken() restores the run.
  std::vector<std::byte> state_at_break_up() const;
  /// A run after its droplet broke up. @throws Error if the bytes are not from state_at_break_up()
  static DropletRun broken(const RunParameters& run, std::shared_ptr<const ObstacleArray> obstacles,
                           std::span<const std::byte> state_at_break_up);

  /// Continues for at most `num_checks` intervals of `steps_per_check` steps. Returns whether the run is
  /// over.
  bool advance(int num_checks);

  /// The run's result so far; status `running` while it is not over.
  RunResult result() const;
  double time() const { return static_cast<double>(steps_done_) * run_.time_step.value(); }
  /// Displacement along the flow after which the droplet has `passed` [sigma].
  double passing_distance() const { return end_; }
  /// Sets passing_distance(), see the constructor.
  void set_passing_distance(double distance) { end_ = distance; }
  /// Displacement along and across the flow since release [sigma].
  Eigen::Array2d displacement() const { return displacement_of(droplet_->centre()); }
  /// Displacement of a point, given in the droplet's frame, from the place of release [sigma].
  Eigen::Array2d displacement_of(const Eigen::Array2d& local) const {
    return droplet_->state().frame.displacement(local, start_frame_, start_);
  }
  double kinetic_energy_ratio() const;
  /// The gravity term measures the height from the place of release.
  PotentialEnergy potential_energy() const;
  /// Starts to sum the energy lost to drag, see Droplet::work().
  void measure_dissipation() { droplet_->measure_dissipation(); }
  const Droplet& droplet() const { return *droplet_; }
  const ObstacleArray& obstacles() const { return *obstacles_; }
  const RunParameters& parameters() const { return run_; }

 private:
  RunParameters run_;
  std::shared_ptr<const ObstacleArray> obstacles_;
  std::unique_ptr<Droplet> droplet_;
  LocalFrame start_frame_;
  Eigen::Array2d start_;
  double end_;
  std::int64_t steps_done_ = 0;
  std::int64_t max_steps_;
  double first_quiet_time_;
  int quiet_checks_ = 0;
  // E_k/E_t when the stability of the droplet was tested last; NaN if the droplet has moved since then
  double balanced_at_ = std::numeric_limits<double>::quiet_NaN();
  RunStatus status_ = RunStatus::running;
  FoundBy clogged_by_ = FoundBy::not_clogged;
  Stability stability_ = Stability::none;
  FailedBy failed_by_ = FailedBy::none;
  double sound_distance_ = 0;
  double next_search_;                // E_k/E_t below which the run searches for an equilibrium
  bool was_crossed_ = false;          // whether the interface crossed itself at the last check for crossings
  std::unique_ptr<Droplet> at_rest_;  // the droplet at rest, if the clog is certified
  std::string message_;
  DisplacementRecord record_;
  SteadyRecord steady_;
  DwellRecord dwells_;
  ContactRecord contacts_;
  Passage passage_;  // through a channel
  ThinnestNeck neck_;
  std::vector<std::byte> snapshot_;

  void save(ByteWriter& bytes) const;
  static DropletRun restore(const RunParameters& run, std::shared_ptr<const ObstacleArray> obstacles,
                            std::span<const std::byte> saved);
  bool is_in_range() const;
  bool is_passage() const;
  bool has_fallen() const { return time() > first_quiet_time_; }
  void check();
  SteadyTravel steady(const Dwells& dwells) const;
  Sag sag(const Droplet& droplet) const;
  void rebuild_lists_and_take_snapshot();
  bool has_broken();
  bool has_crossed_itself() const;
  Eigen::Array2d last_displacement() const;
  bool has_stopped(double energy_ratio);
  bool finds_rest(double energy_ratio);
};

}  // namespace clog
