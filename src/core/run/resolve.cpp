#include "clog/core/run/resolve.hpp"

#include "clog/core/model/model.hpp"
#include "clog/core/parameters/schema.hpp"
#include "clog/core/scene/scene.hpp"

namespace clog {

RunParameters resolve(RunParameters run) {
  check_each(run);
  const Scene& scene = scene_of(run);
  scene.check(run);
  model_of(run).resolve(run, scene.sharpest_bend(run));
  scene.resolve(run);
  return run;
}

}  // namespace clog
