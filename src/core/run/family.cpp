#include "clog/core/run/family.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <new>
#include <stdexcept>
#include <utility>

#include "clog/core/droplet/droplet.hpp"
#include "clog/core/droplet/shape.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/polygon/cut.hpp"
#include "clog/core/polygon/forces/automatic_values.hpp"
#include "clog/core/polygon/neck.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/portable_math.hpp"

namespace clog {
namespace {

/// Change this whenever the content of a family's snapshot changes.
constexpr std::uint64_t family_kind = 0x636c6f6766000001;

/// The end that has the same name as the status.
MemberEnd end_of(RunStatus status) { return meant_by<MemberEnd>(name(status)).value_or(MemberEnd::failed); }

void put(ByteWriter& bytes, const Member& member) {
  bytes.put(std::vector<char>(member.path.begin(), member.path.end()));
  bytes.put(member.diameter);
  bytes.put(member.birth);
  bytes.put(member.end);
  bytes.put(member.status);
  bytes.put(member.mechanism);
}

void get(ByteReader& bytes, Member& member) {
  std::vector<char> path;
  bytes.get(path);
  member.path.assign(path.begin(), path.end());
  bytes.get(member.diameter);
  bytes.get(member.birth);
  bytes.get(member.end);
  bytes.get(member.status);
  bytes.get(member.mechanism);
}

}  // namespace

void save(const std::vector<Member>& members, ByteWriter& bytes) {
  bytes.put(members.size());
  for (const Member& member : members) put(bytes, member);
}

std::vector<Member> restore_members(ByteReader& bytes) {
  std::size_t number = 0;
  bytes.get(number);
  std::vector<Member> members;
  for (; number > 0; --number) get(bytes, members.emplace_back());
  return members;
}

namespace {

/// The frame with its origin multiplied by `factor`, for a change of units. @param period  in the new units
LocalFrame scaled(const LocalFrame& frame, double factor, const Period& period) {
  LocalFrame scaled = frame;
  scaled.period = {period.along(), period.across()};
  scaled.origin *= factor;
  scaled.shift({0, 0});
  return scaled;
}

}  // namespace

RunParameters daughter_parameters(const RunParameters& ancestor, double diameter, double time_left,
                                  int num_vertices) {
  RunParameters run = ancestor;
  run.dp.vertices = num_vertices;
  // The row of a replayed run contains the stiffness of its springs, but not the ratio from which the
  // stiffness follows.
  if (run.dp.perimeter_spring == PerimeterSpring::rest && run.dp.line_tension > 0)
    run.dp.perimeter_stiffness_ratio = *run.dp.perimeter_stiffness / run.dp.line_tension;
  run.dp.line_tension = std::min(run.dp.line_tension / (diameter * diameter), nearly_rigid_tension);
  run.dp.area_stiffness.reset();
  run.dp.perimeter_stiffness.reset();
  run.wall_stiffness.reset();
  run.time_step.reset();
  for (double* length :
       {&*run.dp.contact_range, &run.dp.self_contact_range, &run.dp.yield_traction, &run.dp.break_up_neck,
        &run.obstacles.gap, &run.obstacles.diameter, &run.obstacles.pitch, &run.obstacles.box,
        &run.obstacles.length, &run.obstacles.entrance, &run.obstacles.entrance_from,
        &run.obstacles.entrance_to, &run.obstacles.exit, &run.drag.near_wall_cutoff})
    *length /= diameter;
  if (run.obstacles.density.per_area) *run.obstacles.density.per_area *= diameter * diameter;
  run.drag.terminal_speed *= portable::pow(diameter, run.drag.speed_exponent - 0.5);
  run.max_time = time_left / std::sqrt(diameter);
  model_of(run).resolve(run, scene_of(ancestor).sharpest_bend(ancestor) / diameter);
  return run;
}

ObstacleArray obstacles_in_units_of(const ObstacleArray& obstacles, double diameter) {
  Period period = obstacles.period();
  for (double* length : {&period.box, &period.length, &period.beside}) *length /= diameter;
  std::vector<Obstacle> circles(obstacles.obstacles().begin(), obstacles.obstacles().end());
  for (Obstacle& circle : circles)
    for (double* length : {&circle.x, &circle.y, &circle.radius}) *length /= diameter;
  return {period, std::move(circles)};
}

void FamilyRun::Birth::save(ByteWriter& bytes) const {
  put(bytes, member);
  state.save(bytes);
  bytes.put(num_vertices);
  bytes.put(passing_distance);
}

void FamilyRun::Birth::restore(ByteReader& bytes) {
  get(bytes, member);
  state.restore(bytes);
  bytes.get(num_vertices);
  bytes.get(passing_distance);
  const bool is_placed = member.diameter > 0 && member.diameter <= 1 && member.birth.time >= 0 &&
                         std::isfinite(member.birth.time) && member.path.size() <= longest_path;
  const bool is_followed = member.status != MemberEnd::small;
  const bool has_shape = state.size() == num_vertices && state.velocity.size() == state.position.size() &&
                         num_vertices >= fewest_vertices_of_a_daughter &&
                         (state.position.abs() < burst_perimeter).all() && state.velocity.isFinite().all() &&
                         (state.frame.period > 0).all() && (state.frame.origin >= 0).all() &&
                         (state.frame.origin < state.frame.period).all();
  if (!is_placed || (is_followed && !has_shape)) throw Error("a daughter of the snapshot is out of range");
}

FamilyRun::FamilyRun(const RunParameters& run, const std::shared_ptr<const ObstacleArray>& obstacles)
    : FamilyRun(run, obstacles, DropletRun(run, obstacles)) {}

FamilyRun::FamilyRun(RunParameters run, std::shared_ptr<const ObstacleArray> obstacles, DropletRun ancestor)
    : run_(std::move(run)), obstacles_(std::move(obstacles)), ancestor_(std::move(ancestor)) {}

bool FamilyRun::advance(int num_checks) {
  if (!daughter_) {
    if (!ancestor_.advance(num_checks)) return false;
    if (!has_daughters()) return true;
    end_present();
  } else {
    bool has_ended = false;
    const bool is_sound = succeeds([&] {
      has_ended = daughter_->advance(num_checks);
      if (has_ended) end_present();
    });
    if (is_sound && !has_ended) return false;
  }
  return !begin_next();
}

/// Whether some work for the present daughter succeeds. An exception ends the daughter, but not its family.
/// If memory runs out, the whole family fails; it may be run again.
template <class Work>
bool FamilyRun::succeeds(const Work& work) {
  try {
    work();
    return true;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    present_.status = MemberEnd::failed;
    present_.mechanism = ClogMechanism::none;
    present_.end = daughter_ ? place_of_failure(daughter_->result()) : present_.birth;
    members_.push_back(present_);
    return false;
  }
}

/// Converts the present member's displacement and time to displacement and time of the family.
FamilyPoint FamilyRun::point_of(const Eigen::Array2d& displacement, double time) const {
  const double d = present_.diameter;
  return {.distance = present_.birth.distance + d * displacement[0],
          .lateral = present_.birth.lateral + d * displacement[1],
          .time = present_.birth.time + std::sqrt(d) * time};
}

/// The place where a member was last intact; its lateral displacement is unknown.
FamilyPoint FamilyRun::place_of_failure(const RunResult& result) const {
  return point_of({result.sound_distance, std::numeric_limits<double>::quiet_NaN()}, result.time);
}

void FamilyRun::end_present() {
  const RunResult result = present().result();
  present_.status = end_of(result.status);
  present_.end = present_.status == MemberEnd::failed
                     ? place_of_failure(result)
                     : point_of({result.distance, result.lateral}, result.time);
  present_.mechanism = result.hold.mechanism;
  if (result.status == RunStatus::broken) cut_present();
  members_.push_back(present_);
}

void FamilyRun::cut_present() {
  const DropletRun& mother = present();
  const DropletState& state = mother.droplet().state();
  const PolygonShape shape = polygon_shape(state.position);
  const double edge = shape.perimeter / static_cast<double>(state.size());
  const Neck neck = thinnest_neck(state.position, mother.parameters().dp.break_up_neck);
  std::vector<Birth> births;
  for (const MovingPolygon& part : cut({state.position, state.velocity}, neck)) {
    const PolygonShape part_shape = polygon_shape(part.position);
    Birth& birth = births.emplace_back();
    birth.member.path = present_.path + (births.size() == 1 ? '0' : '1');
    birth.member.diameter = present_.diameter * std::sqrt(part_shape.area / shape.area);
    birth.member.birth = point_of(mother.displacement_of(area_centroid(part.position)), mother.time());
    if (birth.member.diameter < run_.dp.smallest_daughter || birth.member.path.size() == longest_path) {
      birth.member.end = birth.member.birth;
      birth.member.status = MemberEnd::small;
      continue;
    }
    birth.num_vertices =
        std::max(fewest_vertices_of_a_daughter, static_cast<int>(std::ceil(part_shape.perimeter / edge)));
    const MovingPolygon spread = with_vertices(part, birth.num_vertices);
    const double growth = present_.diameter / birth.member.diameter;  // factor for all lengths
    Period period = obstacles_->period();
    for (double* length : {&period.box, &period.length, &period.beside}) *length /= birth.member.diameter;
    birth.state.position = growth * spread.position;
    birth.state.velocity = std::sqrt(growth) * spread.velocity;
    birth.state.frame = scaled(state.frame, growth, period);
    while (birth.state.recentre().any()) {
    }
    birth.passing_distance =
        (ancestor_.passing_distance() - birth.member.birth.distance) / birth.member.diameter;
  }
  std::ranges::move(births, std::back_inserter(births_));
}

std::optional<DropletRun> FamilyRun::at_birth(const std::string& path) && {
  only_ = path;
  while (present_.path != path)
    if (advance(1)) return std::nullopt;
  return daughter_ ? std::move(*daughter_) : std::move(ancestor_);
}

std::optional<Member> FamilyRun::member(const std::string& path) && {
  only_ = path;
  const auto is_found = [&] { return !members_.empty() && members_.back().path == path; };
  while (!is_found() && !advance(1)) continue;
  return is_found() ? std::optional(members_.back()) : std::nullopt;
}

/// Whether the member is requested, or a requested member descends from it.
bool FamilyRun::is_followed(const std::string& path) const { return !only_ || only_->starts_with(path); }

/// Starts the next daughter. Returns whether there is one.
bool FamilyRun::begin_next() {
  daughter_.reset();
  present_birth_.reset();
  while (!births_.empty()) {
    Birth birth = std::move(births_.front());
    births_.pop_front();
    present_ = birth.member;
    if (!is_followed(present_.path)) continue;
    if (present_.status == MemberEnd::small) {
      members_.push_back(present_);
      continue;
    }
    if (!succeeds([&] { begin(birth, {}); })) continue;
    present_birth_ = std::move(birth);
    return true;
  }
  return false;
}

void FamilyRun::begin(const Birth& birth, std::span<const std::byte> snapshot) {
  const double diameter = birth.member.diameter;
  const RunParameters run =
      daughter_parameters(run_, diameter, run_.max_time - birth.member.birth.time, birth.num_vertices);
  auto obstacles = std::make_shared<ObstacleArray>(obstacles_in_units_of(*obstacles_, diameter));
  daughter_ = snapshot.empty()
                  ? std::make_unique<DropletRun>(run, std::move(obstacles), birth.state)
                  : std::make_unique<DropletRun>(DropletRun::resume(run, std::move(obstacles), snapshot));
  daughter_->set_passing_distance(birth.passing_distance);
}

std::vector<std::byte> FamilyRun::snapshot() const {
  if (!daughter_) return ancestor_.snapshot();
  ByteWriter bytes;
  bytes.put(family_kind);
  bytes.put(ancestor_.state_at_break_up());
  clog::save(members_, bytes);
  bytes.put(births_.size());
  for (const Birth& birth : births_) birth.save(bytes);
  present_birth_->save(bytes);
  bytes.put(daughter_->snapshot());
  return bytes.take();
}

FamilyRun FamilyRun::resume(const RunParameters& run, const std::shared_ptr<const ObstacleArray>& obstacles,
                            std::span<const std::byte> snapshot) {
  try {
    ByteReader bytes(snapshot);
    std::uint64_t kind = 0;
    bytes.get(kind);
    if (kind != family_kind) return {run, obstacles, DropletRun::resume(run, obstacles, snapshot)};
    std::vector<std::byte> at_break_up;
    bytes.get(at_break_up);
    FamilyRun resumed(run, obstacles, DropletRun::broken(run, obstacles, at_break_up));
    resumed.members_ = restore_members(bytes);
    std::size_t number = 0;
    bytes.get(number);
    for (; number > 0; --number) resumed.births_.emplace_back().restore(bytes);
    Birth birth;
    birth.restore(bytes);
    std::vector<std::byte> of_daughter;
    bytes.get(of_daughter);
    if (!bytes.at_end()) throw Error("the snapshot is of another run");
    resumed.present_ = birth.member;
    resumed.begin(birth, of_daughter);
    resumed.present_birth_ = std::move(birth);
    return resumed;
  } catch (const std::out_of_range&) {
    throw Error("the snapshot is torn");
  }
}

}  // namespace clog
