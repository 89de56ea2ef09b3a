#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "clog/console/build_info.hpp"
#include "clog/console/json_text.hpp"
#include "clog/console/printable.hpp"
#include "clog/core/world/jamming.hpp"
#include "clog/results/group_table.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/results/usual_parameters.hpp"
#include "clog/sweep/schema_json.hpp"
#include "result_columns.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

using Json = nlohmann::ordered_json;

Json passages_json(const std::vector<Passage>& passages) {
  Json list = Json::array();
  for (const Passage& one : passages)
    list.push_back({{"x", one.x},
                    {"passed", one.num_passed},
                    {"stopped", one.num_stopped},
                    {"lower", one.share.lower},
                    {"upper", one.share.upper}});
  return list;
}

Json scale_json(const LaboratoryScale& scale) {
  return {{"length_mm", json_of(Value(scale.length))},
          {"time_s", json_of(Value(scale.time))},
          {"speed_mm_per_s", json_of(Value(scale.speed))},
          {"tension_mN_per_m_of_gamma_1", json_of(Value(scale.tension))}};
}

/// The fields of a group; groups with the same finding have the same fields. @param with_laboratory  see
/// have_laboratory()
std::vector<Field> all_fields(const Group& group, bool with_laboratory) {
  std::vector<Field> fields;
  const std::vector<Value> values = parameter_values(group.first_row);
  for (std::size_t i = 0; i < values.size(); ++i)
    fields.push_back({group_columns()[i]->name, values[i], group_columns()[i]->unit});
  for (Field& field : result_fields(group)) fields.push_back(std::move(field));
  if (with_laboratory && has_clogging_length(group.first_row))
    for (Field& field : laboratory_fields(group)) fields.push_back(std::move(field));
  return fields;
}

/// Units of a group's fields, if any, and of the entries of its lists.
Json field_units(const std::vector<Group>& groups) {
  Json all;
  for (const Group& group : groups)
    for (const Field& field : all_fields(group, have_laboratory(groups)))
      if (!field.unit.empty()) all[field.name] = field.unit;
  all["survival"] = all["incidence"] = {{"distance", "sigma"}};
  all["censored_distances"] = "sigma";
  if (have_families(groups))
    all["families"] = {{"diameter_class", "sigma"}, {"distance", "sigma"}, {"mean_diameter", "sigma"}};
  return all;
}

Json diameters_json(const Diameters& all) {
  return {{"number", all.number},
          {"area", all.area},
          {"mean_diameter", json_of(Value(all.mean))},
          {"numbers", all.numbers},
          {"areas", all.areas}};
}

/// Numbers and areas of droplets, divided by the number of ancestors.
Json families_json(const Families& families) {
  Json lines = Json::array();
  for (const FamilyLine& line : families.lines) {
    Json passed = diameters_json(line.passed);
    passed["number_lower"] = json_of(Value(line.passed.number_interval.lower));
    passed["number_upper"] = json_of(Value(line.passed.number_interval.upper));
    lines.push_back({{"distance", line.distance},
                     {"passed", std::move(passed)},
                     {"clogged", line.clogged},
                     {"small", line.small},
                     {"not_known", line.not_known},
                     {"passing", json_of(Value(line.passing))},
                     {"passing_lower", json_of(Value(line.interval.lower))},
                     {"passing_upper", json_of(Value(line.interval.upper))}});
  }
  return {{"ancestors", families.num_ancestors},
          {"daughters", families.num_daughters},
          {"diameter_class", diameter_class},
          {"clogged", diameters_json(families.clogged)},
          {"lines", lines}};
}

/// All fields of a group, and its curves.
Json group_json(const Group& group, bool with_laboratory) {
  Json entry = json_of(all_fields(group, with_laboratory));
  // Programs that draw groups need the names of automatic parameters, because automatic values do not
  // separate curves.
  entry["automatic"] = Json::array();
  for (const sweep::Column* column : group_columns())
    if (separating_value(*column, group.first_row) == Value() && column->get(group.first_row) != Value())
      entry["automatic"].push_back(column->name);
  const ObstacleParameters& obstacles = group.first_row.parameters.obstacles;
  if (const auto share = share_of_saturated(obstacles); share && obstacles.layout == ObstacleLayout::random)
    entry["share_of_saturated"] = *share;
  if (group.laboratory) entry["laboratory_scale"] = scale_json(*group.laboratory);
  entry["survival"] = Json::array();
  for (const fit::SurvivalStep& step : group.survival)
    entry["survival"].push_back(step_json(step, "clogs", step.num_clogs));
  entry["incidence"] = Json::object();
  for (const Group::EndsBy& cause : group.causes)
    for (const fit::IncidenceStep& step : cause.incidence)
      entry["incidence"][cause.text->count].push_back(step_json(step, "ends", step.num_ends));
  if (is_device(group.first_row.parameters)) entry["passages"] = passages_json(group.passages);
  if (group.families.num_ancestors > 0) entry["families"] = families_json(group.families);
  entry["censored_distances"] = group.censored_distances;
  return entry;
}

Json mixture_json(const Mixture& mixture) {
  Json weights = Json::object(), survival = Json::array();
  for (const Mixture::Part& part : mixture.parts) weights[part.value] = part.share;
  for (const Mixture::Step& step : mixture.survival)
    survival.push_back({{"distance", step.distance},
                        {"probability", step.probability},
                        {"lower", step.interval.lower},
                        {"upper", step.interval.upper}});
  return {{"column", mixture.column},
          {"weights", weights},
          {"unit", mixture.unit},
          {"clogging_length", json_of(Value(mixture.length))},
          {"clogging_length_lower", json_of(Value(mixture.interval.lower))},
          {"clogging_length_upper", json_of(Value(mixture.interval.upper))},
          {"survival", survival},
          {"censored_distances", mixture.censored_distances}};
}

}  // namespace

bool have_one_scale(const std::vector<Group>& groups) {
  const std::optional<LaboratoryScale>& first = groups.front().laboratory;
  return first && std::ranges::all_of(groups, [&](const Group& group) {
           return group.laboratory && scale_json(*group.laboratory) == scale_json(*first);
         });
}

std::string to_csv(const std::vector<Group>& groups) {
  std::vector<std::vector<Field>> rows;
  rows.reserve(groups.size());
  for (const Group& group : groups) rows.push_back(all_fields(group, have_laboratory(groups)));
  return csv_table(rows);
}

Json groups_json(const std::vector<Group>& groups) {
  Json list = Json::array();
  for (const Group& group : groups) list.push_back(group_json(group, have_laboratory(groups)));
  return list;
}

std::string to_json(const std::vector<Group>& groups, double confidence, const store::Provenance& provenance,
                    const Mixture* mixture) {
  Json sentences;
  for (const DoubtText& doubt : doubt_texts) sentences[doubt.word] = doubt.sentence;
  Json columns = Json::array();
  for (const sweep::Column* column : group_columns()) columns.push_back(sweep::to_json(*column));
  Json origin = Json::object();
  for (const char* name : {"version", "git_describe", "git_hash", "start_time", "command_line", "config"})
    if (std::string text = attribute(provenance, name); !text.empty()) origin[name] = std::move(text);
  const console::BuildInfo build = console::build_info();
  Json document = {{"version", build.version},
                   {"git_describe", build.git_describe},
                   {"confidence", confidence},
                   {"doubts", sentences},
                   {"units", field_units(groups)},
                   {"columns", columns},
                   {"lists", listed_columns(provenance)},
                   {"sweep", origin},
                   {"groups", groups_json(groups)}};
  // If all groups have the same scale, the document contains it once. Otherwise each group has a separate
  // scale.
  for (const Group& group : groups)
    if (const std::optional<LaboratoryText>& own = group.first_row.parameters.laboratory)
      document["laboratories"][own->check_sum()] = console::printable(own->text());
  if (have_one_scale(groups)) document["laboratory"] = scale_json(*groups.front().laboratory);
  if (mixture) document["mixture"] = mixture_json(*mixture);
  return console::json_text(document);
}

}  // namespace clog::results
