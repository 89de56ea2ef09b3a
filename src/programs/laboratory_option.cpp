#include "laboratory_option.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/laboratory/lab_file.hpp"
#include "clog/laboratory/scales.hpp"

namespace clog::programs {
namespace {

results::LaboratoryScale scale_of(const laboratory::Laboratory& lab) {
  constexpr double milli = 1e-3;
  const laboratory::Scales scales = laboratory::scales_of(lab);
  return {.length = scales.length / milli,
          .time = scales.time,
          .speed = scales.speed / milli,
          .tension = scales.tension / milli};
}

}  // namespace

void use_laboratory(cli::CommandLine& line) {
  if (!line.has("lab")) return;
  const laboratory::Laboratory lab = laboratory::read_laboratory(line.get("lab"));
  line.settings().set("laboratory", lab.text);
  laboratory::set_droplet(lab, line.settings());
}

std::optional<double> sigma_in_mm(const cli::CommandLine& line, const std::vector<sweep::RunRow>& rows) {
  if (line.has("lab")) return scale_of(laboratory::read_laboratory(line.get("lab"))).length;
  if (rows.empty() || !rows.front().parameters.laboratory) return std::nullopt;
  const LaboratoryText& first = *rows.front().parameters.laboratory;
  const bool is_shared = std::ranges::all_of(rows, [&](const sweep::RunRow& row) {
    return row.parameters.laboratory && row.parameters.laboratory->check_sum() == first.check_sum();
  });
  if (!is_shared || first.text().empty()) return std::nullopt;
  return scale_of(laboratory::parse_laboratory(first.text(), "the laboratory of some rows")).length;
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

void set_scales(const cli::CommandLine& line, std::vector<results::Group>& groups) {
  std::optional<laboratory::Laboratory> of_all;
  if (line.has("lab")) of_all = laboratory::read_laboratory(line.get("lab"));
  bool replaces = false;
  for (results::Group& group : groups) {
    const std::optional<LaboratoryText>& own = group.first_row.parameters.laboratory;
    if (of_all) {
      group.laboratory = scale_of(*of_all);
      replaces |= own && own->text() != of_all->text;
    } else if (own) {
      if (own->text().empty())
        throw Error("the laboratory " + own->check_sum() +
                    " of some rows is not in the file (another program changed it); give it by --lab");
      group.laboratory = scale_of(laboratory::parse_laboratory(own->text(), "the laboratory of some rows"));
    }
  }
  if (replaces)
    console::say(fmt::format("clogfit: {} replaces the laboratory that rows have", line.get("lab")));
}

}  // namespace clog::programs
