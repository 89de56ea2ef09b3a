#include "channel_options.hpp"

namespace clog::programs {

void add_channel_options(cli::CommandLine& line) {
  const auto text = [] { return boost::program_options::value<std::string>(); };
  line.add_options()("orifice", text(), "channel: distance w between the wedges' tips [sigma] (0.7)")(
      "wedge-angle", text(), "channel: of the flanks against the flow, 0: parallel walls [degrees] (45)")(
      "tip-radius", text(), "channel: of the wedges' console::rounded tips [sigma] (0.03)");
}

ChannelParameters channel_from(const cli::CommandLine& line) {
  return {.orifice = line.get_number("orifice", ChannelParameters{}.orifice),
          .wedge_angle = line.get_number("wedge-angle", ChannelParameters{}.wedge_angle),
          .tip_radius = line.get_number("tip-radius", ChannelParameters{}.tip_radius)};
}

}  // namespace clog::programs
