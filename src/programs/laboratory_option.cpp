#include "laboratory_option.hpp"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include "clog/cli/obstacle_file.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/laboratory/lab_file.hpp"
#include "clog/laboratory/scales.hpp"

namespace clog::programs {
namespace {

/// @param diameter  of the laboratory's droplet [m]
void refuse_other_droplet(const std::string& lab, double diameter, const std::string& circles) {
  constexpr double rounding = 0.005, micro = 1e-6;
  if (!std::filesystem::is_regular_file(circles)) return;  // none, or a check sum
  const std::optional<double> drawn = cli::droplet_of_circles(circles);
  if (drawn && std::abs(*drawn / diameter - 1) > rounding)
    throw Error(fmt::format("{} has a droplet of {:.4g} um, {} one of {:.4g} um; correct one of them", lab,
                            diameter / micro, circles, *drawn / micro));
}

}  // namespace

void use_laboratory(cli::CommandLine& line) {
  if (!line.has("lab")) return;
  const laboratory::Laboratory lab = laboratory::read_laboratory(line.get("lab"));
  for (const std::string& circles : line.settings().values("obstacles"))
    refuse_other_droplet(line.get("lab"), lab.experiment.diameter, circles);
  laboratory::set_droplet(lab, line.settings());
}

}  // namespace clog::programs
