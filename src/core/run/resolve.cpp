#include "clog/core/run/resolve.hpp"

#include <fmt/core.h>

#include <limits>

#include "clog/core/model/model.hpp"
#include "clog/core/parameters/schema.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/world/lattice.hpp"
#include "core/parameters/refusal.hpp"

namespace clog {
namespace {

void check_break_up(const RunParameters& run) {
  const double neck = run.dp.break_up_neck;
  if (neck == 0) return;
  const bool repels = run.dp.self_contact == SelfContact::on;
  require(!repels || neck > run.dp.self_contact_range, "break-up-neck", neck,
          [&] {
            return fmt::format(
                "no neck is thinner than self-contact-range={}, which keeps its sides apart) use more, or 0 "
                "for no "
                "break-up",
                shortest(run.dp.self_contact_range));
          },
          {"self-contact-range"});
  const char* gap_key = scene_of(run).gap_key;
  if (!gap_key) return;
  const ParameterValue gap = parameter(gap_key).get(run);
  const double width = std::get<double>(gap);
  require(neck < width, "break-up-neck", neck,
          [&] {
            return fmt::format("all that pass {}={} have a neck as thin as that) use less", gap_key,
                               shortest(width));
          },
          {gap_key});
}

/// Refuses parameters that cannot be scaled to the units of a daughter.
void check_daughters(const RunParameters& run) {
  if (run.model != Model::dp || run.dp.break_up == BreakUp::end) return;
  const auto refuse = [](const char* key, const std::string& why, const std::string& remedy) {
    throw Refusal({.key = "break-up", .named = {key}}, name(BreakUp::daughters), why, remedy);
  };
  if (run.dp.break_up_neck == 0)
    refuse("break-up-neck", "no droplet breaks up without break-up-neck",
           "give break-up-neck; clogfit units prints it for droplets between plates");
  if (run.drag.near_wall > 0)
    refuse("near-wall-drag", "the drag of smaller droplets near walls is not known", "give near-wall-drag=0");
  if (run.dp.wall_tension.value_or(1) != 1 || run.dp.receding_angle != run.dp.advancing_angle)
    refuse("wall-tension", "the break-up of droplets on walls that they wet is not modelled",
           "remove wall-tension, receding-angle and advancing-angle");
  if (scene_of(run).finding != Finding::clogging_length)
    refuse("obstacle-layout", "daughters need obstacles of a periodic array", "give random, lattice or file");
  if (run.obstacles.side_walls == SideWalls::on)
    refuse("side-walls", "daughters need an array that repeats across the flow", "give side-walls=off");
}

}  // namespace

RunParameters resolve(RunParameters run) {
  check_each(run);
  use_pitch(run.obstacles);
  const Scene& scene = scene_of(run);
  const DropletModel& model = model_of(run);
  const double sharpest_bend = scene.sharpest_bend(run);
  const bool has_obstacles = scene.finding == Finding::clogging_length;
  model.choose_points(run, has_obstacles ? sharpest_bend : std::numeric_limits<double>::infinity());
  scene.check(run);
  model.resolve(run, sharpest_bend);
  scene.resolve(run);
  check_break_up(run);
  check_daughters(run);
  return run;
}

}  // namespace clog
