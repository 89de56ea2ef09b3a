#include "group_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <variant>

#include "clog/sweep/value_list.hpp"

namespace clog {
namespace {

using sweep::RunRow;
/// A number, a count or a word; NaN (not applicable) is an empty word, so that values can be compared.
using Value = std::variant<std::string, double, std::int64_t>;
using Field = std::pair<const char*, Value>;

Value value_of(double number) { return std::isnan(number) ? Value(std::string()) : Value(number); }
Value value_of(std::int64_t count) { return count; }
Value value_of(int count) { return std::int64_t{count}; }
template <std::size_t N>
Value value_of(const sweep::FixedText<N>& text) {
  return std::string(text.view());
}

/// What makes a group, most telling first.
std::vector<Field> parameter_fields(const RunRow& row) {
  return {{"model", value_of(row.model)},
          {"obstacle_filling", value_of(row.obstacle_filling)},
          {"obstacle_diameter", value_of(row.obstacle_diameter)},
          {"obstacle_diameter_spread", value_of(row.obstacle_diameter_spread)},
          {"obstacle_gap", value_of(row.obstacle_gap)},
          {"obstacle_density", value_of(row.obstacle_density)},
          {"lattice_angle", value_of(row.lattice_angle)},
          {"line_tension", value_of(row.line_tension)},
          {"wall_stiffness", value_of(row.wall_stiffness)},
          {"near_wall_drag", value_of(row.near_wall_drag)},
          {"near_wall_exponent", value_of(row.near_wall_exponent)},
          {"relative_drag", value_of(row.relative_drag)},
          {"terminal_speed", value_of(row.terminal_speed)},
          {"vertices", value_of(row.vertices)},
          {"time_step", value_of(row.time_step)},
          {"max_time", value_of(row.max_time)},
          {"box", value_of(row.box)},
          {"area_stiffness", value_of(row.area_stiffness)},
          {"preset", value_of(row.preset)},
          {"perimeter_spring", value_of(row.perimeter_spring)},
          {"perimeter_stiffness", value_of(row.perimeter_stiffness)},
          {"wall_contact", value_of(row.wall_contact)},
          {"wall_tension", value_of(row.wall_tension)},
          {"self_contact", value_of(row.self_contact)},
          {"gravity", value_of(row.gravity)},
          {"clog_energy", value_of(row.clog_energy)},
          {"clog_detection", value_of(row.clog_detection)}};
}

std::vector<Field> result_fields(const Group& group) {
  return {{"runs", value_of(group.clogging.num_runs)},
          {"clogs", value_of(group.clogging.num_clogs)},
          {"flowing", value_of(group.num_flowing)},
          {"interrupted", value_of(group.num_interrupted)},
          {"failed", value_of(group.num_failed)},
          {"total_distance", value_of(group.clogging.total_distance)},
          {"clogging_length", value_of(group.clogging.length)},
          {"clogging_length_lower", value_of(group.clogging.lower)},
          {"clogging_length_upper", value_of(group.clogging.upper)},
          {"mean_speed", value_of(group.speed.mean)},
          {"mean_speed_error", value_of(group.speed.standard_error)},
          {"mean_speed_runs", value_of(group.speed.num_runs)},
          {"lateral_slope", value_of(group.migration.slope)},
          {"lateral_slope_error", value_of(group.migration.standard_error)}};
}

std::string exact(const Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
  return sweep::shortest(std::get<double>(value));
}

std::string rounded(const Value& value) {
  if (const auto* word = std::get_if<std::string>(&value)) return word->empty() ? "-" : *word;
  if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", std::get<double>(value));
  return text;
}

/// Columns aligned to the right.
std::string aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i)
      text += std::string(widths[i] - line[i].size() + (i > 0 ? 2 : 0), ' ') + line[i];
    text += '\n';
  }
  return text;
}

bool is_lattice(const Group& group) { return group.parameters.obstacle_filling.view() == "lattice"; }

/// @param with_migration  in random arrays a droplet goes straight on the average: not worth two columns
std::vector<std::string> result_cells(const Group& group, bool with_migration) {
  const fit::CloggingLength& clogging = group.clogging;
  const bool bounded = clogging.num_clogs > 0;
  const auto number = [](double value) { return rounded(value_of(value)); };
  std::vector<std::string> cells = {std::to_string(clogging.num_runs),
                                    std::to_string(clogging.num_clogs),
                                    bounded ? number(clogging.length) : "> " + number(clogging.lower),
                                    bounded ? number(clogging.lower) + " .. " + number(clogging.upper) : "-",
                                    number(group.speed.mean),
                                    number(group.speed.standard_error)};
  if (with_migration)
    cells.insert(cells.end(), {number(group.migration.slope), number(group.migration.standard_error)});
  return cells;
}

std::vector<bool> varying_fields(const std::vector<Group>& groups) {
  const std::vector<Field> first = parameter_fields(groups.front().parameters);
  std::vector<bool> varies(first.size(), false);
  for (const Group& group : groups) {
    const std::vector<Field> fields = parameter_fields(group.parameters);
    for (std::size_t i = 0; i < fields.size(); ++i) varies[i] = varies[i] || fields[i] != first[i];
  }
  return varies;
}

/// Fields that vary, except those whose automatic values follow from the others.
std::vector<bool> shown_fields(const std::vector<Group>& groups, const std::vector<bool>& varies) {
  const std::vector<Field> first = parameter_fields(groups.front().parameters);
  const bool soft_disk = groups.front().parameters.model.view() == "sp";
  std::set<std::string_view> automatic = {"time_step", "area_stiffness", "perimeter_stiffness"};
  if (!soft_disk) automatic.insert("wall_stiffness");
  std::vector<bool> shown(first.size(), false);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const std::string_view name = first[i].first;
    shown[i] = (varies[i] && !automatic.contains(name)) || name == "obstacle_gap" ||
               name == (soft_disk ? "wall_stiffness" : "line_tension");
  }
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (!varies[i] || shown[i]) continue;
    std::map<std::vector<Value>, Value> follows;
    for (const Group& group : groups) {
      const std::vector<Field> fields = parameter_fields(group.parameters);
      std::vector<Value> from;
      for (std::size_t j = 0; j < fields.size(); ++j)
        if (shown[j]) from.push_back(fields[j].second);
      const auto [known, is_new] = follows.try_emplace(from, fields[i].second);
      if (!is_new && known->second != fields[i].second) shown[i] = true;
    }
  }
  return shown;
}

}  // namespace

std::vector<Group> group_runs(std::span<const RunRow> rows, double confidence) {
  std::map<std::vector<Field>, std::vector<const RunRow*>> members;
  for (const RunRow& row : rows) {
    std::vector<Field> fields = parameter_fields(row);
    members[std::move(fields)].push_back(&row);
  }
  std::vector<Group> groups;
  for (const auto& [fields, runs] : members) {
    Group group;
    group.parameters = *runs.front();
    std::vector<fit::Observation> observations;
    std::vector<double> speeds;
    std::vector<fit::Displacement> displacements;
    for (const RunRow* run : runs) {
      group.num_failed += run->status.view() == "failed";
      if (run->status.view() == "failed") continue;
      group.num_flowing += run->status.view() == "flowing";
      group.num_interrupted += run->status.view() == "interrupted" || run->status.view() == "running";
      observations.push_back({run->distance, run->status.view() == "clogged"});
      speeds.push_back(run->mean_speed / run->terminal_speed);
      displacements.push_back({run->distance, run->lateral_displacement});
    }
    group.clogging = fit::fit_clogging_length(observations, confidence);
    group.speed = fit::fit_mean_speed(speeds);
    group.migration = fit::fit_migration(displacements);
    groups.push_back(group);
  }
  return groups;
}

std::string to_text(const std::vector<Group>& groups, double confidence) {
  const std::vector<Field> first = parameter_fields(groups.front().parameters);
  const std::vector<bool> varies = varying_fields(groups);
  const std::vector<bool> shown = shown_fields(groups, varies);
  const auto is_shown = [&](std::size_t i) { return shown[i]; };

  std::string text = "all runs:";
  std::vector<std::vector<std::string>> lines(1);
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (is_shown(i))
      lines[0].push_back(first[i].first);
    else if (!varies[i] && !exact(first[i].second).empty() && exact(first[i].second) != "none")
      text += std::string(" ") + first[i].first + "=" + rounded(first[i].second);
  }
  char interval[16];
  std::snprintf(interval, sizeof interval, "%g %%", 100 * confidence);
  for (const std::string& title : {std::string("runs"), std::string("clogs"), std::string("lambda/sigma"),
                                   std::string(interval), std::string("<v_g>/v_t"), std::string("+-")})
    lines[0].push_back(title);
  const bool with_migration = std::any_of(groups.begin(), groups.end(), is_lattice);
  if (with_migration) lines[0].insert(lines[0].end(), {"lateral/r", "+-"});
  int num_failed = 0;
  int num_interrupted = 0;
  for (const Group& group : groups) {
    std::vector<std::string>& line = lines.emplace_back();
    const std::vector<Field> fields = parameter_fields(group.parameters);
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (is_shown(i)) line.push_back(rounded(fields[i].second));
    for (std::string& cell : result_cells(group, with_migration)) line.push_back(std::move(cell));
    num_failed += group.num_failed;
    num_interrupted += group.num_interrupted;
  }
  text += "\n\n" + aligned(lines);
  if (num_interrupted > 0)
    text += "\nnote: " + std::to_string(num_interrupted) +
            " runs are under way or interrupted: they count as not clogged so far\n";
  if (num_failed > 0)
    text += "\nnote: " + std::to_string(num_failed) +
            " failed runs are left out; their column `message` says why\n";
  return text;
}

std::string to_csv(const std::vector<Group>& groups) {
  std::ostringstream out;
  for (const Group& group : groups) {
    std::vector<Field> fields = parameter_fields(group.parameters);
    for (Field& field : result_fields(group)) fields.push_back(std::move(field));
    if (&group == &groups.front())
      for (std::size_t i = 0; i < fields.size(); ++i) out << (i > 0 ? "," : "") << fields[i].first;
    out << '\n';
    for (std::size_t i = 0; i < fields.size(); ++i) out << (i > 0 ? "," : "") << exact(fields[i].second);
  }
  out << '\n';
  return out.str();
}

std::string to_json(const std::vector<Group>& groups, double confidence) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Group& group : groups) {
    nlohmann::ordered_json entry;
    std::vector<Field> fields = parameter_fields(group.parameters);
    for (Field& field : result_fields(group)) fields.push_back(std::move(field));
    for (const auto& [name, value] : fields) {
      if (const auto* count = std::get_if<std::int64_t>(&value))
        entry[name] = *count;
      else if (const auto* number = std::get_if<double>(&value))
        entry[name] =
            std::isfinite(*number) ? nlohmann::ordered_json(*number) : nlohmann::ordered_json(nullptr);
      else
        entry[name] = std::get<std::string>(value).empty()
                          ? nlohmann::ordered_json(nullptr)
                          : nlohmann::ordered_json(std::get<std::string>(value));
    }
    list.push_back(entry);
  }
  const nlohmann::ordered_json document = {{"confidence", confidence}, {"groups", list}};
  return document.dump(2) + "\n";
}

}  // namespace clog
