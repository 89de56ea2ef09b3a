#include "channel_options.hpp"

#include <algorithm>

#include "clog/sweep/value_list.hpp"
#include "single_run.hpp"

namespace clog {

void add_channel_options(cli::CommandLine& line) {
  const auto text = [] { return boost::program_options::value<std::string>(); };
  line.add_options()("orifice", text(), "channel: distance w between the wedges' tips [sigma] (0.7)")(
      "wedge-angle", text(), "channel: of the flanks against the flow, 0: parallel walls [degrees] (45)")(
      "tip-radius", text(), "channel: of the wedges' rounded tips [sigma] (0.03)");
}

ChannelParameters channel_from(const cli::CommandLine& line) {
  return {.orifice = line.get_number("orifice", ChannelParameters{}.orifice),
          .wedge_angle = line.get_number("wedge-angle", ChannelParameters{}.wedge_angle),
          .tip_radius = line.get_number("tip-radius", ChannelParameters{}.tip_radius)};
}

RunParameters channel_run(sweep::Settings settings, const ChannelParameters& channel) {
  // What `auto` must hold off are the tips.
  settings.set("obstacle-diameter", sweep::shortest(std::max(2 * channel.tip_radius, 1e-3)));
  return single_run(settings);
}

}  // namespace clog
