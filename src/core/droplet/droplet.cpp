#include "clog/core/droplet/droplet.hpp"

namespace clog {

void Droplet::save(ByteWriter& bytes) const {
  state_.save(bytes);
  bytes.put(work_);
  bytes.put(num_integrated_steps_);
}

void Droplet::restore(ByteReader& bytes) {
  state_.restore(bytes);
  bytes.get(work_);
  bytes.get(num_integrated_steps_);
  rebuild_lists();
}

}  // namespace clog
