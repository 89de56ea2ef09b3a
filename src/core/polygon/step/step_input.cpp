#include "step_input.hpp"

namespace clog {

kernel::KickTerms kick_terms(const RunParameters& run, double far_rate) {
  const bool on_area = run.dp.gravity == Gravity::area;
  const bool varies = run.drag.near_wall > 0 && far_rate > 0;
  return {.elastic = run.dp.perimeter_spring != PerimeterSpring::along,
          .on_area = on_area,
          .varying_rate = varies,
          .coupled = on_area || (run.drag.relative != 1 && far_rate > 0),
          .implicit_pressure = false,
          .rate = varies ? 0 : far_rate * run.drag.relative,
          .relative_rate = (on_area ? run.drag.relative : run.drag.relative - 1) * far_rate,
          .area_rate = on_area ? far_rate : 0};
}

kernel::Contact contact_as_kick(const RunParameters& run, const DpForces& forces, double impulse) {
  return {.stiffness = impulse * forces.contact_stiffness(),
          .span = run.dp.wall_contact == WallContact::edge ? 1.0 : 0.0,
          .self_range = forces.self_contacts().range()};
}

kernel::InterfaceKick interface_kick(const InterfaceTerms& interface, double impulse) {
  return {.line_tension = impulse * (interface.line_tension - interface.spring * interface.spring_length),
          .spring = impulse * interface.spring,
          .spreading = impulse * interface.spreading,
          .half_pressure = 0.5 * impulse * interface.pressure,
          .vertex_weight = impulse * interface.vertex_weight};
}

kernel::AreaForce area_force(const kernel::Sums& sums, const Eigen::Array2d& kick) {
  return {.area = sums.area,
          .centre_x = sums.moment_x / sums.area,
          .centre_y = sums.moment_y / sums.area,
          .x = kick[0],
          .y = kick[1]};
}

std::vector<kernel::WedgePlace> wedges_in(const LocalFrame& frame, const std::vector<Wedge>& wedges) {
  std::vector<kernel::WedgePlace> places;
  places.reserve(wedges.size());
  for (const Wedge& wedge : wedges) places.push_back(kernel::place_in(frame, wedge));
  return places;
}

}  // namespace clog
