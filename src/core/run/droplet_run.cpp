#include "clog/core/run/droplet_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "clog/core/droplet/equilibrium.hpp"
#include "clog/core/droplet/shape.hpp"
#include "clog/core/droplet/time_step.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"

namespace clog {
namespace {

/// A clog is possible only after this number of relaxation times, because a released droplet is at first as
/// slow as a clogged droplet.
constexpr double relaxation_times_before_a_clog = 10;

/// E_k/E_t below which the program searches for an equilibrium. The droplet must also be so slow that its
/// speed times the relaxation time is at most farthest_rest.
double first_search(const RunParameters& run) {
  constexpr double slow = 1e-4;
  // While walls with friction yield, a droplet may creep, get free and move on. No search predicts this
  // (docs/notes/2026-11-25-searches-with-friction.md).
  constexpr double slow_with_friction = 1e-10;
  const bool has_friction = run.dp.friction > 0 || run.dp.yield_traction > 0;
  const double coasting = farthest_rest / (relaxation_time(run) * run.drag.terminal_speed);  // divided by V_t
  return std::min(has_friction ? slow_with_friction : slow, coasting * coasting);
}
/// After a failed search, the next search waits until E_k/E_t has fallen by this factor.
constexpr double fall_between_searches = 0.1;
/// If E_k/E_t rises above this multiple of the limit for the first search, the next search again waits for
/// this limit.
constexpr double rise_of_a_moving_droplet = 10;

/// The stability of a droplet that has stopped in an unstable balance is tested again when E_k/E_t has
/// changed by this factor.
constexpr double change_between_looks = 10;

/// The run tests for crossings of the interface once in this number of steps. The tests take less than 1 % of
/// the run's time. They miss no crossing, because parts of the interface that have crossed stay crossed. The
/// sound distance is the distance at the last test without a crossing.
constexpr std::int64_t steps_per_crossing_check = std::int64_t{32} * DropletRun::steps_per_check;

/// Change this whenever the content of a snapshot changes.
constexpr std::uint64_t snapshot_kind = 0x636c6f6773000006;

/// Whether a snapshot's frame is possible. @param way  largest distance of any droplet of the run [sigma]
bool is_in_range(const LocalFrame& frame, const Period& period, double way) {
  return frame.period[0] == period.along() && frame.period[1] == period.across() &&
         (frame.origin >= 0).all() && (frame.origin < frame.period).all() &&
         (frame.image.cast<double>().abs() * frame.period <= way + frame.period).all();
}

/// Twice the distance that a droplet falls without obstacles [sigma].
double farthest_distance(const RunParameters& run) { return 2 * run.drag.terminal_speed * run.max_time; }

/// Checks the state in a snapshot before anything is computed with it.
void check_state(const DropletState& state, const RunParameters& run, const ObstacleArray& obstacles) {
  const Period& period = obstacles.period();
  if (state.size() != model_of(run).num_points(run) || state.velocity.size() != state.position.size() ||
      state.frame.period[0] != period.along() || state.frame.period[1] != period.across())
    throw Error("the snapshot is of another run");
  const bool is_placed = (state.position.abs() < burst_perimeter).all() &&
                         is_in_range(state.frame, period, farthest_distance(run));
  const double fastest = std::sqrt(diverged_energy_ratio * static_cast<double>(state.size()));
  const bool is_moving = (state.velocity.abs() < fastest * run.drag.terminal_speed).all();
  const auto num_wedges = static_cast<Eigen::Index>(obstacles.wedges().size());
  const bool is_held = std::ranges::all_of(state.anchors, [&](const WallAnchor& anchor) {
    const Eigen::Array3d places{anchor.x, anchor.y, anchor.slip}, wall{anchor.wall.x, anchor.wall.y, 0};
    return anchor.holder >= 0 && anchor.holder < state.size() && (places.abs() < burst_perimeter).all() &&
           (wall.abs() < burst_perimeter).all() && anchor.wall.radius >= 0 &&
           anchor.wall.radius < burst_perimeter && anchor.wall.wedge >= -1 && anchor.wall.wedge < num_wedges;
  });
  const bool is_crossed = std::ranges::all_of(state.crossings, [&](const SelfCrossing& one) {
    return std::min(one.vertex, one.edge) >= 0 && std::max(one.vertex, one.edge) < state.size();
  });
  if (!is_placed || !is_moving || !is_held || !is_crossed || state.num_healed < 0)
    throw Error("its droplet is out of range");
}

}  // namespace

DropletRun::DropletRun(const RunParameters& run)
    : DropletRun(run, std::make_shared<ObstacleArray>(scene_of(run).walls(run))) {}

DropletRun::DropletRun(const RunParameters& run, const std::shared_ptr<const ObstacleArray>& obstacles)
    : DropletRun(run, obstacles, scene_of(run).release(run, *obstacles)) {
  end_ = scene_of(run).passing_distance(run, start_frame_.global(start_));
}

DropletRun::DropletRun(RunParameters run, std::shared_ptr<const ObstacleArray> obstacles,
                       DropletState initial, double passing_distance)
    : run_(std::move(run)),
      obstacles_(std::move(obstacles)),
      droplet_(model_of(run_).make(run_, *obstacles_, std::move(initial))),
      start_frame_(droplet_->state().frame),
      start_(droplet_->centre()),
      end_(passing_distance),
      max_steps_(std::max<std::int64_t>(1, std::llround(run_.max_time / run_.time_step.value()))),
      first_quiet_time_(relaxation_times_before_a_clog * relaxation_time(run_)),
      next_search_(first_search(run_)),
      steady_(run_.drag.terminal_speed),
      dwells_(run_.dwell_length, run_.drag.terminal_speed),
      contacts_(model_of(run_).contact_reach(run_)) {}

PotentialEnergy DropletRun::potential_energy() const {
  PotentialEnergy energy = droplet_->potential_energy();
  // The droplet measures heights from its frame's origin, a run from the place of release.
  energy.gravity -= units::droplet_mass * units::gravity * displacement_of({0, 0})[0];
  return energy;
}

double DropletRun::kinetic_energy_ratio() const {
  const double terminal =
      0.5 * run_.dp.inertia * units::droplet_mass * run_.drag.terminal_speed * run_.drag.terminal_speed;
  return droplet_->kinetic_energy() / terminal;
}

bool DropletRun::advance(int num_checks) {
  for (int i = 0; i < num_checks && status_ == RunStatus::running; ++i) {
    const auto steps = static_cast<int>(std::min<std::int64_t>(steps_per_check, max_steps_ - steps_done_));
    droplet_->advance(steps);
    steps_done_ += steps;
    check();
    if (status_ == RunStatus::running && steps_done_ % steps_per_snapshot == 0)
      rebuild_lists_and_take_snapshot();
  }
  return status_ != RunStatus::running;
}

void DropletRun::rebuild_lists_and_take_snapshot() {
  droplet_->rebuild_lists();
  ByteWriter bytes;
  save(bytes);
  snapshot_ = bytes.take();
}

void DropletRun::save(ByteWriter& bytes) const {
  bytes.put(snapshot_kind);
  droplet_->save(bytes);
  start_frame_.save(bytes);
  bytes.put(start_);
  bytes.put(steps_done_);
  bytes.put(quiet_checks_);
  bytes.put(balanced_at_);
  bytes.put(next_search_);
  bytes.put(sound_distance_);
  bytes.put(was_crossed_);
  record_.save(bytes);
  steady_.save(bytes);
  dwells_.save(bytes);
  contacts_.save(bytes);
  if (is_passage()) passage_.save(bytes);
  bytes.put(neck_);
}

DropletRun DropletRun::restore(const RunParameters& run, std::shared_ptr<const ObstacleArray> obstacles,
                               std::span<const std::byte> saved) {
  try {
    ByteReader bytes(saved);
    std::uint64_t kind = 0;
    bytes.get(kind);
    if (kind != snapshot_kind) throw Error("the snapshot is of another version");
    ByteReader rest = bytes;
    DropletState state;
    state.restore(bytes);
    check_state(state, run, *obstacles);
    DropletRun restored(run, std::move(obstacles), std::move(state));
    restored.droplet_->restore(rest);
    restored.start_frame_.restore(rest);
    rest.get(restored.start_);
    restored.end_ = scene_of(run).passing_distance(run, restored.start_frame_.global(restored.start_));
    rest.get(restored.steps_done_);
    rest.get(restored.quiet_checks_);
    rest.get(restored.balanced_at_);
    rest.get(restored.next_search_);
    rest.get(restored.sound_distance_);
    rest.get(restored.was_crossed_);
    if (!restored.is_in_range()) throw Error("its progress is out of range");
    restored.record_.restore(rest, restored.time());
    restored.steady_.restore(rest);
    restored.dwells_.restore(rest);
    restored.contacts_.restore(rest);
    if (restored.is_passage()) restored.passage_.restore(rest);
    rest.get(restored.neck_);
    if (!rest.at_end()) throw Error("the snapshot is of another run");
    return restored;
  } catch (const std::out_of_range&) {
    throw Error("the snapshot is torn");
  }
}

DropletRun DropletRun::resume(const RunParameters& run, std::shared_ptr<const ObstacleArray> obstacles,
                              std::span<const std::byte> snapshot) {
  DropletRun resumed = restore(run, std::move(obstacles), snapshot);
  if (resumed.steps_done_ % steps_per_snapshot != 0) throw Error("its progress is out of range");
  resumed.snapshot_.assign(snapshot.begin(), snapshot.end());
  return resumed;
}

std::vector<std::byte> DropletRun::state_at_break_up() const {
  assert(status_ == RunStatus::broken);
  ByteWriter bytes;
  save(bytes);
  return bytes.take();
}

DropletRun DropletRun::broken(const RunParameters& run, std::shared_ptr<const ObstacleArray> obstacles,
                              std::span<const std::byte> state_at_break_up) {
  DropletRun broken = restore(run, std::move(obstacles), state_at_break_up);
  if (!(broken.neck_.width < run.dp.break_up_neck)) throw Error("the droplet has not broken up");
  broken.status_ = RunStatus::broken;
  return broken;
}

/// Checks the contents of a snapshot except the droplet itself.
bool DropletRun::is_in_range() const {
  return (start_.abs() < burst_perimeter).all() &&
         clog::is_in_range(start_frame_, obstacles_->period(), farthest_distance(run_)) && steps_done_ > 0 &&
         std::abs(sound_distance_) <= farthest_distance(run_) + obstacles_->period().along() &&
         steps_done_ <= max_steps_ && quiet_checks_ >= 0 && quiet_checks_ <= steps_done_ / steps_per_check &&
         !(balanced_at_ < 0 || balanced_at_ >= run_.clog_energy) && next_search_ > 0 &&
         std::isfinite(next_search_) && kinetic_energy_ratio() < diverged_energy_ratio;
}

void DropletRun::check() {
  const double energy_ratio = kinetic_energy_ratio();
  const PolygonShape shape = droplet_->shape();
  const bool has_diverged = !(energy_ratio < diverged_energy_ratio && shape.perimeter < burst_perimeter &&
                              std::abs(shape.area / units::rest_area - 1) < diverged_area_error);
  if (has_diverged) {  // true also if one of these three numbers is NaN
    message_ = fmt::format(
        "diverged at t={:.6g}: E_k/E_t={:.6g}, area={:.6g}, perimeter={:.6g}; try a smaller time-step or "
        "terminal-speed",
        time(), energy_ratio, shape.area, shape.perimeter);
    status_ = RunStatus::failed;
    failed_by_ = FailedBy::divergence;
    return;
  }
  const double sunk = displacement()[0];
  record_.add(time(), sunk);
  steady_.add(time(), sunk);
  dwells_.add(time(), sunk);
  contacts_.add(droplet_->state(), *obstacles_, displacement_of({0, 0}), sunk);
  if (is_passage())
    passage_.add(run_.channel.start + sunk, shape.shape_parameter(),
                 droplet_->centre_velocity()[0] / run_.drag.terminal_speed, has_fallen());
  if (has_broken()) {
    status_ = RunStatus::broken;
    return;
  }
  if (has_stopped(energy_ratio))
    clogged_by_ = FoundBy::threshold;
  else if (run_.clog_detection == ClogDetection::certified && finds_rest(energy_ratio))
    clogged_by_ = FoundBy::certified;
  if (clogged_by_ != FoundBy::not_clogged)
    status_ = RunStatus::clogged;
  else if (sunk >= end_)
    status_ = RunStatus::passed;
  else if (steps_done_ >= max_steps_)
    status_ = RunStatus::flowing;
  const bool has_ended = status_ != RunStatus::running;
  if (!has_ended && !was_crossed_ && steps_done_ % steps_per_crossing_check != 0) return;
  const bool is_crossed = has_crossed_itself();
  // Self-contact pushes back a vertex that has passed through an edge, but this takes a few steps.
  const bool stays_crossed = is_crossed && (was_crossed_ || has_ended);
  was_crossed_ = is_crossed;
  if (stays_crossed) {
    message_ = fmt::format(
        "the interface crossed itself by t={:.6g}; try a larger line-tension, a larger wall-stiffness or a "
        "smaller inertia",
        time());
    status_ = RunStatus::failed;
    failed_by_ = FailedBy::crossing;
    return;
  }
  if (!is_crossed) sound_distance_ = last_displacement()[0];
}

/// Without self-contact, nothing prevents crossings, and the run ignores them.
bool DropletRun::has_crossed_itself() const {
  const Droplet& last = at_rest_ ? *at_rest_ : *droplet_;
  return run_.dp.self_contact == SelfContact::on && num_self_crossings(last.state().position) > 0;
}

/// Displacement along and across the flow, certified: at rest [sigma].
Eigen::Array2d DropletRun::last_displacement() const {
  return at_rest_ ? displacement_of(at_rest_->centre()) : displacement();
}

bool DropletRun::is_passage() const { return scene_of(run_).finding == Finding::passage; }

bool DropletRun::has_broken() {
  if (run_.dp.break_up_neck == 0) return false;
  const double thinnest = std::fmin(neck_.width, no_neck);  // fmin() of a NaN and a number gives the number
  const double width = model_of(run_).neck(droplet_->state(), thinnest);
  if (width < thinnest) neck_ = {.width = width, .distance = displacement()[0]};
  return width < run_.dp.break_up_neck;
}

bool DropletRun::has_stopped(double energy_ratio) {
  const bool is_quiet = energy_ratio < run_.clog_energy && has_fallen();
  quiet_checks_ = is_quiet ? quiet_checks_ + 1 : 0;
  if (!is_quiet) balanced_at_ = std::numeric_limits<double>::quiet_NaN();
  const bool was_looked_at = energy_ratio <= change_between_looks * balanced_at_ &&
                             change_between_looks * energy_ratio >= balanced_at_;
  if (quiet_checks_ < 2 || was_looked_at) return false;
  stability_ = model_of(run_).stability(run_, *obstacles_, droplet_->state());
  balanced_at_ = energy_ratio;
  return stability_ != Stability::unstable;
}

bool DropletRun::finds_rest(double energy_ratio) {
  const double first = first_search(run_);
  if (energy_ratio > rise_of_a_moving_droplet * first) next_search_ = first;
  if (energy_ratio > next_search_ || time() < first_quiet_time_) return false;
  next_search_ = fall_between_searches * energy_ratio;
  const DropletModel& model = model_of(run_);
  std::optional<DropletState> rest = model.equilibrium(run_, *obstacles_, droplet_->state());
  if (!rest || model.neck(*rest, run_.dp.break_up_neck) < no_neck) return false;
  at_rest_ = model.make(run_, *obstacles_, std::move(*rest));
  stability_ = Stability::stable;
  return true;
}

SteadyTravel DropletRun::steady(const Dwells& dwells) const {
  if (status_ == RunStatus::clogged) return steady_.until(dwells.last_begin, dwells.last_distance);
  return steady_.until(time(), displacement()[0]);
}

Sag DropletRun::sag(const Droplet& droplet) const {
  // Before gravity acted, the droplet was a circle around its centre, so the centroid was at the place of
  // release.
  const DropletState& state = droplet.state();
  const Eigen::ArrayXd before = model_of(run_).free_shape(run_);
  const double top = displacement_of({state.x().minCoeff(), 0})[0] - before.head(state.size()).minCoeff();
  return {.centre = displacement_of(droplet.area_centre())[0], .top = top};
}

RunResult DropletRun::result() const {
  const Droplet& last = at_rest_ ? *at_rest_ : *droplet_;
  const Eigen::Array2d displaced = last_displacement();
  const Scene& scene = scene_of(run_);
  Hold hold;
  const Dwells dwells = dwells_.found(time(), status_ == RunStatus::clogged);
  if (status_ == RunStatus::clogged) hold = model_of(run_).hold(run_, *obstacles_, last.state());
  return {.status = status_,
          .clogged_by = clogged_by_,
          .stability = status_ == RunStatus::clogged ? stability_ : Stability::none,
          .failed_by = failed_by_,
          .distance = displaced[0],
          .sound_distance = sound_distance_,
          .lateral = displaced[1],
          .time = time(),
          .speed = record_.travel_speed(),
          .steady = steady(dwells),
          .dwells = dwells,
          .contacts = contacts_.found(),
          .kinetic_energy_ratio = kinetic_energy_ratio(),
          .shape_parameter = last.shape().shape_parameter(),
          .hold = hold,
          .passage = passage_,
          .sag = scene.finding == Finding::sag ? sag(last) : Sag(),
          .neck = neck_,
          .healed_crossings = droplet_->state().num_healed,
          .release = scene.place_in_file ? scene.place_in_file(run_, start_frame_.global(start_))
                                         : RunResult().release,
          .steps = droplet_->num_integrated_steps(),
          .message = message_};
}

}  // namespace clog
