#include "clog/single_run/recorded_run.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iostream>
#include <limits>
#include <utility>

#include "clog/console/exit_codes.hpp"
#include "clog/console/printable.hpp"
#include "clog/console/signals.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/single_run/progress.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::single_run {
namespace {

/// A film shows obstacles up to this distance from the droplet [sigma].
constexpr double surroundings = 5 * units::droplet_diameter;

/// Obstacles near the polygons, including periodic images, but without the tips of wedges.
std::vector<Obstacle> obstacles_along(const std::vector<store::PolygonFrame>& frames,
                                      const ObstacleArray& array) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  ObstacleArray::Window window{0, 0, inf, -inf, inf, -inf, surroundings};
  for (const store::PolygonFrame& frame : frames) {
    const std::size_t n = frame.position.size() / 2;
    for (std::size_t i = 0; i < n; ++i) {
      window.x_min = std::min(window.x_min, frame.position[i]);
      window.x_max = std::max(window.x_max, frame.position[i]);
      window.y_min = std::min(window.y_min, frame.position[n + i]);
      window.y_max = std::max(window.y_max, frame.position[n + i]);
    }
  }
  std::vector<Obstacle> obstacles;
  array.gather(window, obstacles);
  std::erase_if(obstacles, [](const Obstacle& obstacle) { return obstacle.radius == 0; });
  return obstacles;
}

/// Converts a time to a number of checks of the run, at least one.
std::int64_t in_checks(double interval, double time_step) {
  constexpr double never = 1e15;
  return std::llround(std::clamp(interval / (DropletRun::steps_per_check * time_step), 1.0, never));
}

bool is_in_channel(const DropletRun& run) {
  return run.parameters().obstacles.layout == ObstacleLayout::channel;
}

/// Appends the parameters of the channel to the attributes of a file.
void append_channel(const ChannelParameters& channel, store::Provenance& provenance) {
  for (const auto& [name, value] : {std::pair{"orifice", channel.orifice},
                                    {"wedge_angle", channel.wedge_angle},
                                    {"tip_radius", channel.tip_radius},
                                    {"start_h", channel.start},
                                    {"end_h", channel.end}})
    provenance.emplace_back(name, sweep::shortest(value));
}

}  // namespace

RecordedRun::Intervals RecordedRun::every(double samples, std::optional<double> polygons, double time_step) {
  return {.samples = in_checks(samples, time_step),
          .polygons = polygons ? in_checks(*polygons, time_step) : 0};
}

RecordedRun::RecordedRun(DropletRun run, Intervals intervals) : run_(std::move(run)), intervals_(intervals) {
  run_.measure_dissipation();
  add_common_columns();
  if (is_in_channel(run_)) add_columns_of_channel();
}

void RecordedRun::add_common_columns() {
  using Run = const DropletRun&;
  add_column("time", "[t0]", [](Run run) { return run.time(); });
  add_column("distance",
             "displacement of the centre of mass (of the area with gravity=area, else of the vertices) along "
             "the flow since release [sigma]",
             [](Run run) { return run.displacement()[0]; });
  add_column("lateral_displacement", "displacement across the flow [sigma]",
             [](Run run) { return run.displacement()[1]; });
  add_column("speed", "of the centre of mass along the flow [sqrt(sigma g)]",
             [](Run run) { return run.droplet().centre_velocity()[0]; });
  add_column("kinetic_energy_ratio", "E_k/E_t", [](Run run) { return run.kinetic_energy_ratio(); });
  add_column("area", "[sigma^2]", [](Run run) { return run.droplet().shape().area; });
  add_column("perimeter", "[sigma]", [](Run run) { return run.droplet().shape().perimeter; });
  add_column("shape_parameter", "A = perimeter^2/(4 pi area)",
             [](Run run) { return run.droplet().shape().shape_parameter(); });
  add_column("kinetic_energy", "E_k, of all vertices [g rho sigma^3], as all energies",
             [](Run run) { return run.droplet().kinetic_energy(); });
  add_column("dissipated_energy", "work done against the drag since release",
             [](Run run) { return run.droplet().work().dissipated; });
  add_column("spreading_work", "of the springs along the interface, which have no energy, since release",
             [](Run run) { return run.droplet().work().spreading; });
  add_column("gravity_energy", "-M g times the way along the flow since release",
             [](Run run) { return run.potential_energy().gravity; });
  add_column("line_tension_energy", "sum of tension times length of the edges",
             [](Run run) { return run.potential_energy().line_tension; });
  add_column("area_energy", "(k_a/2)(a - a0)^2", [](Run run) { return run.potential_energy().area; });
  add_column("spring_energy", "of the perimeter springs",
             [](Run run) { return run.potential_energy().spring; });
  add_column("wall_energy", "of the contact with walls", [](Run run) { return run.potential_energy().wall; });
  add_column("self_contact_energy", "of the interface's contact with itself",
             [](Run run) { return run.potential_energy().self_contact; });
  add_column("anchor_energy", "of the springs by which walls hold the interface",
             [](Run run) { return run.potential_energy().anchors; });
}

void RecordedRun::add_columns_of_channel() {
  add_column("h", "distance of the centre of mass from the orifice, positive downstream [sigma]",
             [start = run_.parameters().channel.start](const DropletRun& run) {
               return start + run.displacement()[0];
             });
  add_column("speed_ratio", "v_g/v_t", [](const DropletRun& run) {
    return run.droplet().centre_velocity()[0] / run.parameters().drag.terminal_speed;
  });
}

void RecordedRun::take_sample() {
  for (Column& column : columns_) column.data.values.push_back(column.measure(run_));
}

void RecordedRun::take_polygon() {
  const DropletState& state = run_.droplet().state();
  store::PolygonFrame frame{run_.time(), {}};
  for (const int axis : {0, 1})
    for (Eigen::Index i = 0; i < state.size(); ++i)
      frame.position.push_back(state.frame.global({state.x()[i], state.y()[i]})[axis]);
  polygons_.push_back(std::move(frame));
}

void RecordedRun::follow(const std::function<bool(const DropletRun&)>& is_over) {
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t processor_begin = std::clock();
  RunProgress progress;
  bool over = false;
  for (std::int64_t checks = 0;; ++checks) {
    if (checks % intervals_.samples == 0 || over) take_sample();
    if (intervals_.polygons > 0 && (checks % intervals_.polygons == 0 || over)) take_polygon();
    interrupted_ = !over && (console::stop_signalled() || (is_over && is_over(run_)));
    if (over || interrupted_) break;
    over = run_.advance(1);
    progress.tick(run_);
  }
  progress.finish();
  seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  processor_seconds_ = static_cast<double>(std::clock() - processor_begin) / CLOCKS_PER_SEC;
}

MostCost RecordedRun::measure_cost() {
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  while (elapsed() < 0.5 && !run_.advance(8)) continue;
  const double max_time = run_.parameters().max_time;
  const double steps = max_time / *run_.parameters().time_step;
  const auto rows = [&](std::int64_t interval) {
    return interval > 0 ? 1 + std::ceil(steps / static_cast<double>(DropletRun::steps_per_check * interval))
                        : 0;
  };
  const double polygons = rows(intervals_.polygons);
  return {
      .time = max_time,
      .steps = steps,
      .seconds = elapsed() / run_.time() * max_time,
      .samples = rows(intervals_.samples),
      .polygons = polygons,
      .polygon_bytes = polygons * static_cast<double>(2 * sizeof(double) * run_.droplet().state().size())};
}

RunResult RecordedRun::result() const {
  RunResult result = run_.result();
  if (interrupted_) result.status = RunStatus::interrupted;
  return result;
}

store::Trajectory RecordedRun::trajectory(sweep::RunRow row, store::Provenance origin) const {
  store::Trajectory trajectory;
  for (const Column& column : columns_) trajectory.columns.push_back(column.data);
  trajectory.polygons = polygons_;
  if (!polygons_.empty()) {
    trajectory.obstacles = obstacles_along(polygons_, run_.obstacles());
    trajectory.wedges = run_.obstacles().wedges();
  }
  row.task = 0;
  row.wall_seconds = seconds_;
  row.processor_seconds = processor_seconds_;
  sweep::record(result(), row);
  trajectory.row = row;
  trajectory.provenance = std::move(origin);
  trajectory.provenance.emplace_back("hdf5_version", store::library_version());
  if (is_in_channel(run_)) append_channel(run_.parameters().channel, trajectory.provenance);
  return trajectory;
}

int RecordedRun::report() const {
  const RunResult result = this->result();
  fmt::print(std::cout, "{} after r = {:.4f} sigma, t = {:.4g} t0, E_k/E_t = {:.2g}, A = {:.4f}\n",
             name(result.status), result.distance, result.time, result.kinetic_energy_ratio,
             result.shape_parameter);
  if (!result.message.empty()) std::cout << console::printable(result.message) << '\n';
  const double vertex_steps =
      static_cast<double>(result.steps) * static_cast<double>(run_.droplet().state().size());
  fmt::print(std::cout, "{}, {:.3f} s, {:.2f} ns per vertex-step\n", count_text(result.steps, "step"),
             seconds_, 1e9 * seconds_ / vertex_steps);
  return result.status == RunStatus::interrupted ? console::exit_incomplete
         : result.status == RunStatus::failed    ? console::exit_internal_fault
                                                 : console::exit_success;
}

}  // namespace clog::single_run
