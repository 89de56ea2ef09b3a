#include "clog/core/run/resolve.hpp"

#include <limits>

#include "clog/core/model/model.hpp"
#include "clog/core/parameters/schema.hpp"
#include "clog/core/scene/scene.hpp"

namespace clog {

RunParameters resolve(RunParameters run) {
  check_each(run);
  const Scene& scene = scene_of(run);
  const DropletModel& model = model_of(run);
  const bool has_obstacles = scene.finding == Finding::clogging_length;
  constexpr double none = std::numeric_limits<double>::infinity();
  model.choose_points(run, has_obstacles ? scene.sharpest_bend(run) : none);
  scene.check(run);
  model.resolve(run, scene.sharpest_bend(run));
  scene.resolve(run);
  return run;
}

}  // namespace clog
