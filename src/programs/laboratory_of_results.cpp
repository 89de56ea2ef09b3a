#include "laboratory_of_results.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/laboratory/lab_file.hpp"
#include "clog/laboratory/scales.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::programs {
namespace {

/// The laboratory of --lab, for the results of this row.
laboratory::Laboratory laboratory_for(const cli::CommandLine& line, const sweep::RunRow* row) {
  return laboratory::read_laboratory(line.get("lab"), row && row->parameters.laboratory
                                                          ? "omit --lab: the sweep stores its laboratories"
                                                          : laboratory::give_one_droplet);
}

void say_replaced(const cli::CommandLine& line) {
  console::say(fmt::format("clogfit: {} replaces the laboratory stored with the rows", line.get("lab")));
}

/// The smallest and the largest of these speeds [mm/s]; only one number if all are equal.
std::string speeds_text(const std::vector<double>& speeds) {
  const auto [least, most] = std::ranges::minmax(speeds);
  const std::string first = fmt::format("{:.4g}", least), last = fmt::format("{:.4g}", most);
  return first == last ? first : first + " to " + last;
}

/// Prints one line if runs have another terminal speed than the laboratory's droplet. Speeds and times in
/// laboratory units then follow from the terminal speed of the runs.
void say_other_speed(const cli::CommandLine& line, const std::vector<results::Group>& groups) {
  constexpr double rounding = 1e-3;
  std::vector<double> of_runs, of_droplets;
  for (const results::Group& group : groups) {
    const double of_run = results::terminal_speed_in_laboratory(group);
    if (!group.laboratory || !(std::abs(of_run / group.laboratory->speed - 1) > rounding)) continue;
    of_runs.push_back(of_run);
    of_droplets.push_back(group.laboratory->speed);
  }
  if (of_runs.empty()) return;
  console::say(
      fmt::format("{}: speeds and times in mm/s and s are those of runs with a terminal speed of {} mm/s; "
                  "that of the laboratory's description is {} mm/s",
                  line.program(), speeds_text(of_runs), speeds_text(of_droplets)));
}

/// The line tension that the runs of a laboratory have.
double given_line_tension(const laboratory::Scales& scales) {
  const std::string text = laboratory::line_tension_text(scales);
  return text.empty() ? std::numeric_limits<double>::quiet_NaN() : sweep::to_number(text);
}

results::LaboratoryScale scale_of(const laboratory::Laboratory& lab) {
  constexpr double milli = 1e-3;
  const laboratory::Scales scales = laboratory::scales_of(lab);
  return {.length = scales.length / milli,
          .time = scales.time,
          .speed = scales.speed / milli,
          .tension = scales.tension / milli,
          .line_tension = given_line_tension(scales),
          .own_tension = twelve_digits(lab.experiment.interfacial_tension / milli),
          .tilt = twelve_digits(lab.experiment.tilt / (std::numbers::pi / 180))};
}

}  // namespace

results::ScalesByLaboratory scales_of_rows(const cli::CommandLine& line,
                                           const std::vector<sweep::RunRow>& rows) {
  if (line.has("lab")) return {{"", scale_of(laboratory_for(line, rows.empty() ? nullptr : &rows.front()))}};
  results::ScalesByLaboratory scales;
  for (const sweep::RunRow& row : rows) {
    const std::optional<LaboratoryText>& own = row.parameters.laboratory;
    if (!own || own->text().empty()) return {};
    if (!scales.contains(own->check_sum()))
      scales[own->check_sum()] =
          scale_of(laboratory::parse_laboratory(own->text(), "the laboratory of some rows"));
  }
  return scales;
}

std::optional<double> sigma_in_mm(const cli::CommandLine& line, const std::vector<sweep::RunRow>& rows) {
  if (line.has("lab")) {
    const laboratory::Laboratory lab = laboratory_for(line, rows.empty() ? nullptr : &rows.front());
    if (std::ranges::any_of(rows, [&](const sweep::RunRow& row) {
          return row.parameters.laboratory && row.parameters.laboratory->text() != lab.text;
        }))
      say_replaced(line);
    return scale_of(lab).length;
  }
  if (rows.empty() || !rows.front().parameters.laboratory) return std::nullopt;
  const LaboratoryText& first = *rows.front().parameters.laboratory;
  const bool is_shared = std::ranges::all_of(rows, [&](const sweep::RunRow& row) {
    return row.parameters.laboratory && row.parameters.laboratory->check_sum() == first.check_sum();
  });
  if (!is_shared || first.text().empty()) return std::nullopt;
  return scale_of(laboratory::parse_laboratory(first.text(), "the laboratory of some rows")).length;
}

void set_scales(const cli::CommandLine& line, std::vector<results::Group>& groups) {
  std::optional<laboratory::Laboratory> of_all;
  if (line.has("lab")) of_all = laboratory_for(line, &groups.front().first_row);
  bool replaces = false;
  for (results::Group& group : groups) {
    const std::optional<LaboratoryText>& own = group.first_row.parameters.laboratory;
    if (of_all) {
      group.laboratory = scale_of(*of_all);
      replaces |= own && own->text() != of_all->text;
    } else if (own) {
      if (own->text().empty())
        throw Error("the file does not contain the laboratory " + own->check_sum() +
                    " of some of its rows (another program changed the file); give this laboratory by --lab");
      group.laboratory = scale_of(laboratory::parse_laboratory(own->text(), "the laboratory of some rows"));
    }
  }
  if (replaces) say_replaced(line);
  say_other_speed(line, groups);
}

}  // namespace clog::programs
