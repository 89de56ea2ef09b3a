#include "clog/core/run/dwell_record.hpp"

#include <algorithm>
#include <cmath>

namespace clog {

const Dwell* Dwells::first_longer(double time) const {
  const auto found =
      std::find_if(longest.rbegin(), longest.rend(), [=](const Dwell& dwell) { return dwell.length > time; });
  return found == longest.rend() ? nullptr : &*found;
}

void Dwells::keep(const Dwell& dwell) {
  if (dwell.length <= known_from || dwell.length <= longest.front().length) return;
  if (!std::isnan(longest.back().length)) known_from = longest.back().length;
  std::shift_right(longest.begin(), longest.end(), 1);
  longest.front() = dwell;
}

DwellRecord::DwellRecord(double dwell_length, double terminal_speed) : dwell_length_(dwell_length) {
  found_.known_from = shortest * dwell_length / terminal_speed;
  found_.last_distance = found_.last_begin = 0;
}

void DwellRecord::add(double time, double displacement) {
  if (displacement <= found_.last_distance + dwell_length_) return;
  found_.keep(present(time));
  found_.last_distance = displacement;
  found_.last_begin = time;
}

Dwells DwellRecord::found(double time, bool has_clogged) const {
  Dwells all = found_;
  if (!has_clogged) all.keep(present(time));
  return all;
}

Dwell DwellRecord::present(double time) const {
  return {.length = time - found_.last_begin, .distance = found_.last_distance, .begin = found_.last_begin};
}

}  // namespace clog
