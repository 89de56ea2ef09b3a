#include "clog/core/model/model.hpp"

#include <stdexcept>

namespace clog {

const DropletModel& model_of(const RunParameters& run) {
  switch (run.model) {
    case Model::dp:
      return deformable_polygon;
    case Model::sp:
      return soft_disk;
  }
  throw std::logic_error("a model without a droplet");
}

}  // namespace clog
