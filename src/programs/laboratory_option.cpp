#include "laboratory_option.hpp"

#include <fmt/core.h>

#include <cmath>
#include <string>

#include "clog/campaign/stored_sweep.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/laboratory/lab_file.hpp"
#include "clog/laboratory/scales.hpp"

namespace clog::programs {

void use_laboratory(cli::CommandLine& line) {
  if (line.has("lab")) laboratory::set_droplet(laboratory::read_laboratory(line.get("lab")), line.settings());
}

void refuse_other_droplets(const cli::CommandLine& line) {
  if (!line.has("lab")) return;
  constexpr double rounding = 0.005, micro = 1e-6;
  const double diameter = laboratory::read_laboratory(line.get("lab")).experiment.diameter;
  for (const auto& [file, circles] : line.settings().circle_files())
    if (circles.droplet() && std::abs(*circles.droplet() / diameter - 1) > rounding)
      throw Error(fmt::format("{} has a droplet of {:.4g} um, {} one of {:.4g} um; correct one of them",
                              line.get("lab"), diameter / micro, file, *circles.droplet() / micro));
}

std::optional<campaign::LaboratoryScale> laboratory_scale(const cli::CommandLine& line,
                                                          const store::SweepFile& sweep,
                                                          const std::string& path) {
  const std::string stored = campaign::attribute(sweep.provenance, "laboratory");
  if (!line.has("lab") && stored.empty()) return std::nullopt;
  const laboratory::Laboratory lab =
      line.has("lab") ? laboratory::read_laboratory(line.get("lab"))
                      : laboratory::parse_laboratory(stored, path + ", attribute laboratory,");
  if (line.has("lab") && !stored.empty() && lab.text != stored)
    console::say(
        fmt::format("clogfit: {} replaces the laboratory that is stored in {}", line.get("lab"), path));
  constexpr double milli = 1e-3;
  const laboratory::Scales scales = laboratory::scales_of(lab);
  return campaign::LaboratoryScale{.length = scales.length / milli,
                                   .time = scales.time,
                                   .speed = scales.speed / milli,
                                   .tension = scales.tension / milli};
}

}  // namespace clog::programs
