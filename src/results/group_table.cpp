#include "clog/results/group_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <variant>

#include "clog/console/build_info.hpp"
#include "clog/console/json_text.hpp"
#include "clog/console/printable.hpp"
#include "clog/console/rounded.hpp"
#include "clog/console/table.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/parameters/schema.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/results/usual_parameters.hpp"
#include "clog/sweep/schema_json.hpp"
#include "clog/sweep/settings.hpp"
#include "clog/sweep/value_list.hpp"
#include "laboratory_columns.hpp"
#include "result_columns.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

nlohmann::ordered_json passages_json(const std::vector<Passage>& passages) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Passage& one : passages)
    list.push_back({{"x", one.x},
                    {"passed", one.num_passed},
                    {"stopped", one.num_stopped},
                    {"lower", one.share.lower},
                    {"upper", one.share.upper}});
  return list;
}

/// The parts `key = value` of a laboratory's description.
std::vector<std::string> parts_of(const std::optional<LaboratoryText>& laboratory) {
  std::istringstream text(laboratory ? laboratory->text() : "");
  std::vector<std::string> parts;
  for (std::string part; std::getline(text >> std::ws, part, ';');) parts.push_back(console::printable(part));
  return parts;
}

/// What distinguishes each group's laboratory from those of the others; of a single one all its parts.
std::string laboratory_label(const Group& group, const std::vector<Group>& groups) {
  std::vector<std::string> own = parts_of(group.first_row.parameters.laboratory);
  const auto is_everywhere = [&](const std::string& part) {
    return std::ranges::all_of(groups, [&](const Group& other) {
      const std::vector<std::string> parts = parts_of(other.first_row.parameters.laboratory);
      return std::ranges::find(parts, part) != parts.end();
    });
  };
  std::vector<std::string> label = own;
  std::erase_if(label, is_everywhere);
  return joined(label.empty() ? own : label, "; ");
}

/// A parameter's value; user-supplied circles have the name of their file, if it is known.
std::string rounded_text(const Group& group, const std::vector<Group>& groups, const Field& field) {
  const sweep::RunRow& row = group.first_row;
  if (field.first == std::string_view("laboratory"))
    if (std::string label = laboratory_label(group, groups); !label.empty()) return label;
  const std::optional<OwnCircles>& own = row.parameters.obstacles.own;
  if (field.first == std::string_view("obstacles") && own && !own->source().empty())
    return console::printable(std::filesystem::path(own->source()).filename().string());
  return short_text(field.second);
}

nlohmann::ordered_json scale_json(const LaboratoryScale& scale) {
  return {{"length_mm", json_of(Value(scale.length))},
          {"time_s", json_of(Value(scale.time))},
          {"speed_mm_per_s", json_of(Value(scale.speed))},
          {"tension_mN_per_m_of_gamma_1", json_of(Value(scale.tension))}};
}

std::string letters(const std::vector<Doubt>& doubts) {
  std::string all;
  for (const Doubt doubt : doubts) all += text_of(doubt).letter;
  return all;
}

/// Explains the letters that occur in the last column.
std::string legend(const std::vector<Group>& groups) {
  std::string text;
  for (const DoubtText& doubt : doubt_texts)
    if (std::any_of(groups.begin(), groups.end(), [&](const Group& group) {
          return letters(group.doubts).find(doubt.letter) != std::string::npos;
        }))
      text += fmt::format("{}{}: {}\n", text.empty() ? "\n" : "", doubt.letter, doubt.sentence);
  return text;
}

std::vector<ResultColumn> result_columns(const std::vector<Group>& groups, double confidence) {
  const bool has_laboratory = have_laboratory(groups);
  std::vector<ResultColumn> columns = columns_of_findings(groups, confidence, has_laboratory);
  if (has_laboratory)
    for (ResultColumn& column : laboratory_columns(groups)) columns.push_back(std::move(column));
  if (std::any_of(groups.begin(), groups.end(), [](const Group& group) { return !group.doubts.empty(); }))
    columns.push_back({"note", [](const Group& group) { return letters(group.doubts); }});
  return columns;
}

/// Explains columns that their heads do not.
std::string column_notes(const std::vector<Group>& groups) {
  std::string text;
  if (are_mechanisms_shown(groups))
    text += fmt::format(
        "w/s/h/o: clogs that are wrapped, squeezed, hybrid, other (for instance at rest on one obstacle{})\n",
        std::ranges::any_of(groups, is_dwell_possible) ? "; or droplets that moved on" : "");
  if (have_some_broken(groups))
    text +=
        "lambda_b: mean distance before break-up. Broken droplets are censored in lambda, clogged ones in "
        "lambda_b\n";
  if (has_clogging_length(groups.front().first_row) &&
      std::ranges::any_of(groups, [](const Group& group) { return group.num_passed > 0; }))
    text +=
        "passed: droplets that reached the exit. They count as not clogged on their way, so lambda may "
        "exceed "
        "the device's length\n";
  if (std::ranges::all_of(groups, [](const Group& group) { return is_device(group.first_row.parameters); }))
    text +=
        "lambda_met: from the first obstacle that a droplet met; those that met none are in no other "
        "column\n";
  return text;
}

/// The longest time of one digit that is shorter than this one.
double shorter_dwell(double rest) {
  const double unit = std::pow(10, std::floor(std::log10(rest)));
  const double digit = std::ceil(rest / unit) - 1;
  return digit < 1 ? 0.9 * unit : digit * unit;
}

/// Names the droplets at rest that count as moving, and what would count them as clogged.
std::string note_of_rest(const std::vector<Group>& groups) {
  int num_resting = 0;
  double shortest_rest = std::numeric_limits<double>::infinity(), known_from = 0;
  for (const Group& group : groups) {
    num_resting += group.num_resting;
    shortest_rest = std::min(shortest_rest, group.shortest_rest);
    known_from = std::max(known_from, group.dwells_known_from);
  }
  if (num_resting == 0 || !has_clogging_length(groups.front().first_row)) return "";
  std::string text = fmt::format("   {} ended by max-time with the droplet at rest for {} t0 or longer",
                                 sweep::counted(num_resting, "run"), console::plain(shortest_rest));
  if (const double dwell = shorter_dwell(shortest_rest); dwell >= known_from)
    text +=
        fmt::format(": --dwell={} counts {} as clogged", shortest(dwell), num_resting == 1 ? "it" : "them");
  return text + '\n';
}

/// Names the runs that are missing from the table, or from some of its columns.
std::string left_out(const std::vector<Group>& groups) {
  int num_failed = 0, num_damaged = 0, num_interrupted = 0, num_left_out = 0, num_repeated = 0;
  for (const Group& group : groups) {
    num_failed += group.num_failed;
    num_damaged += group.num_damaged;
    num_interrupted += group.num_interrupted;
    num_left_out += group.num_left_out;
    num_repeated += group.num_repeated;
  }
  std::string text;
  if (num_left_out > 0)
    text += fmt::format(
        "   {} ended before --from-distance, left out of runs, clogs and lambda; <v_g> is still of all "
        "runs\n",
        sweep::counted(num_left_out, "run"));
  if (num_interrupted > 0)
    text += fmt::format(
        "   {} {} unfinished: lambda holds for the distances reached so far, and the clogs so far are the "
        "early ones\n",
        sweep::counted(num_interrupted, "run"), num_interrupted == 1 ? "is" : "are");
  if (num_repeated > 0)
    text += fmt::format("   {} repeat droplets of longer runs and do not count (--pool)\n",
                        sweep::counted(num_repeated, "run"));
  if (num_failed > 0) text += fmt::format("   {} failed; the column `message` says why\n", num_failed);
  if (num_damaged > 0) text += fmt::format("   {} damaged; clogsweep verify tells which\n", num_damaged);
  return text;
}

/// @param with_laboratory  if any of the groups has one
std::vector<Field> all_fields(const Group& group, bool with_laboratory) {
  std::vector<Field> fields = parameter_fields(group.first_row);
  for (Field& field : result_fields(group)) fields.push_back(std::move(field));
  if (with_laboratory)
    for (Field& field : laboratory_fields(group)) fields.push_back(std::move(field));
  return fields;
}

std::vector<bool> varying_fields(const std::vector<Group>& groups) {
  const std::vector<Field> first = parameter_fields(groups.front().first_row);
  std::vector<bool> varies(first.size(), false);
  for (const Group& group : groups) {
    const std::vector<Field> fields = parameter_fields(group.first_row);
    for (std::size_t i = 0; i < fields.size(); ++i) varies[i] = varies[i] || fields[i] != first[i];
  }
  return varies;
}

/// Fields that vary, except those whose automatic values follow from the others.
std::vector<bool> shown_fields(const std::vector<Group>& groups, const std::vector<bool>& varies) {
  const std::vector<Field> first = parameter_fields(groups.front().first_row);
  const RunParameters& run = groups.front().first_row.parameters;
  std::vector<bool> shown(first.size(), false);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto is_of = [&](const char* key) {
      return key && std::string_view(first[i].first) == parameter(key).column;
    };
    const bool is_there = !std::holds_alternative<std::monostate>(first[i].second);
    const bool is_automatic_everywhere = std::ranges::all_of(groups, [&](const Group& group) {
      return separating_value(*group_columns()[i], group.first_row) == Value();
    });
    shown[i] = (varies[i] && !is_automatic_everywhere && !group_columns()[i]->may_be_automatic(run)) ||
               (is_there && is_of(scene_of(run).gap_key)) || is_of(model_of(run).stiffness_key);
  }
  // A given automatic value that others follow from comes before these.
  std::vector<std::size_t> order(first.size());
  std::iota(order.begin(), order.end(), 0);
  const auto rank = [&](std::size_t i) {
    const std::string_view name = first[i].first;
    return name == "vertices" ? 0 : name == "time_step" ? 1 : 2;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  for (const std::size_t i : order) {
    if (!varies[i] || shown[i]) continue;
    std::map<std::vector<Value>, Value> follows;
    for (const Group& group : groups) {
      const std::vector<Field> fields = parameter_fields(group.first_row);
      std::vector<Value> from;
      for (std::size_t j = 0; j < fields.size(); ++j)
        if (shown[j]) from.push_back(fields[j].second);
      const auto [known, is_new] = follows.try_emplace(from, fields[i].second);
      if (!is_new && known->second != fields[i].second) shown[i] = true;
    }
  }
  return shown;
}

/// Units of a group's fields, where they have one, and of the entries of its lists.
nlohmann::ordered_json field_units(const std::vector<Group>& groups) {
  nlohmann::ordered_json all;
  for (const auto& [name, value] : all_fields(groups.front(), have_laboratory(groups)))
    if (const std::string_view unit = unit_of(name); !unit.empty()) all[name] = unit;
  all["survival"] = all["incidence"] = {{"distance", "sigma"}};
  all["censored_distances"] = "sigma";
  return all;
}

/// Whether each parameter is worth a word, if it does not differ.
std::vector<bool> named_if_shared(const sweep::RunRow& row, SharedParameters shared) {
  const std::vector<Field> fields = parameter_fields(row);
  const std::vector<Field> usual =
      shared == SharedParameters::unusual ? usual_parameters(row) : std::vector<Field>();
  std::vector<bool> named;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string text = sweep::text_of(fields[i].second);
    const std::string_view name = fields[i].first;
    const bool tells_all =
        name == "model" || (name == "preset" && text != sweep::find_key("preset").default_text);
    named.push_back(!text.empty() && text != "none" && (tells_all || usual.empty() || fields[i] != usual[i]));
  }
  return named;
}

/// The shared parameters that are worth a word.
std::vector<std::string> shared_words(const std::vector<Group>& groups, const std::vector<bool>& varies,
                                      const std::vector<bool>& shown, SharedParameters shared) {
  const sweep::RunRow& row = groups.front().first_row;
  const std::vector<Field> fields = parameter_fields(row);
  const std::vector<bool> is_named = named_if_shared(row, shared);
  std::vector<std::string> words;
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (!shown[i] && !varies[i] && is_named[i])
      words.push_back(fmt::format("{}={}", fields[i].first, rounded_text(groups.front(), groups, fields[i])));
  return words;
}

std::vector<std::string> parameter_names(const Group& group) {
  std::vector<std::string> names;
  for (const Field& field : parameter_fields(group.first_row)) names.emplace_back(field.first);
  return names;
}
std::vector<std::string> parameter_texts(const Group& group, const std::vector<Group>& groups) {
  std::vector<std::string> texts;
  for (const Field& field : parameter_fields(group.first_row))
    texts.push_back(rounded_text(group, groups, field));
  return texts;
}
void append_shown(const std::vector<std::string>& texts, const std::vector<bool>& shown,
                  std::vector<std::string>& line) {
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (shown[i]) line.push_back(texts[i]);
}

/// Words in lines that fit a terminal, each after a space.
std::string wrapped(const std::vector<std::string>& words) {
  constexpr std::size_t longest_line = 100;
  std::string text;
  std::size_t line_begin = 0;
  for (const std::string& word : words) {
    if (text.size() - line_begin + word.size() >= longest_line) {
      text += "\n ";
      line_begin = text.size();
    }
    text += ' ' + word;
  }
  return text;
}

/// One line across a device: where, how many droplets came past it and of how many, share and interval.
void append_passage(const Passage& passage, std::vector<std::string>& line) {
  const int num_known = passage.num_passed + passage.num_stopped;
  line.push_back(fmt::format("{:.4g}", passage.x));
  line.push_back(fmt::format("{}", passage.num_passed));
  line.push_back(fmt::format("{}", num_known));
  line.push_back(num_known == 0 ? "-"
                                : fmt::format("{:.2f}", static_cast<double>(passage.num_passed) / num_known));
  line.push_back(num_known == 0 ? "-"
                                : fmt::format("{:.2f} .. {:.2f}", passage.share.lower, passage.share.upper));
}

bool are_counts_equal(const Passage& one, const Passage& other) {
  return one.num_passed == other.num_passed && one.num_stopped == other.num_stopped;
}

/// Among many lines those at which the counts change, and the last.
std::vector<Passage> shown_passages(const std::vector<Passage>& all) {
  constexpr std::size_t most_lines = 8;
  if (all.size() <= most_lines) return all;
  std::vector<Passage> shown;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i == 0 || i + 1 == all.size() || !are_counts_equal(all[i], all[i - 1])) shown.push_back(all[i]);
  return shown;
}

/// Which shares of the droplets came past the lines of their devices.
std::string table_of_passages(const std::vector<Group>& groups, const std::vector<bool>& shown,
                              double confidence) {
  std::vector<std::vector<std::string>> lines(1);
  append_shown(parameter_names(groups.front()), shown, lines[0]);
  for (const char* name : {"x/sigma", "came past", "of", "share"}) lines[0].emplace_back(name);
  lines[0].push_back(fmt::format("{:g} %", 100 * confidence));
  bool are_all_shown = true;
  for (const Group& group : groups) {
    const std::vector<Passage> passages = shown_passages(group.passages);
    are_all_shown = are_all_shown && passages.size() == group.passages.size();
    for (const Passage& passage : passages) {
      std::vector<std::string>& line = lines.emplace_back();
      append_shown(parameter_texts(group, groups), shown, line);
      append_passage(passage, line);
    }
  }
  if (lines.size() == 1) return "";
  return fmt::format("\ndroplets that came past x{}\n{}",
                     are_all_shown ? "" : " (lines with the counts of the line before are left out)",
                     console::aligned(lines));
}

/// Defines a clog, if droplets that stood still count, too.
std::string definition_of_clogs(const std::vector<Group>& groups) {
  const double dwell = groups.front().dwell;
  if (std::isinf(dwell)) return "";
  const auto num_possible = std::ranges::count_if(groups, is_dwell_possible);
  if (num_possible == 0)
    return fmt::format("\nno run lasts longer than --dwell={}, so this is the fit without --dwell",
                       shortest(dwell));
  std::set<std::string> lengths;
  for (const Group& group : groups) lengths.insert(shortest(group.first_row.parameters.dwell_length));
  std::string text = fmt::format("\nclogged: has not moved by {} sigma for {} t0",
                                 lengths.size() > 1 ? "dwell_length" : *lengths.begin(), shortest(dwell));
  if (num_possible < std::ssize(groups))
    text += "; where max_time is not longer, this is the fit without --dwell";
  return text;
}

}  // namespace

std::string to_text(const std::vector<Group>& groups, double confidence, SharedParameters shared) {
  const std::vector<bool> varies = varying_fields(groups);
  const std::vector<bool> shown = shown_fields(groups, varies);
  std::string text = "all runs:" + wrapped(shared_words(groups, varies, shown, shared));
  if (shared == SharedParameters::unusual) text += "\n(the rest as by default; --all-parameters names it)";
  text += definition_of_clogs(groups);
  const std::vector<ResultColumn> columns = result_columns(groups, confidence);
  std::vector<std::vector<std::string>> lines(1);
  append_shown(parameter_names(groups.front()), shown, lines[0]);
  for (const ResultColumn& column : columns) lines[0].push_back(column.name);
  for (const Group& group : groups) {
    std::vector<std::string>& line = lines.emplace_back();
    append_shown(parameter_texts(group, groups), shown, line);
    for (const ResultColumn& column : columns) line.push_back(column.cell(group));
  }
  return text + "\n\n" + console::aligned(lines) + table_of_passages(groups, shown, confidence) +
         legend(groups) + column_notes(groups) + note_of_rest(groups) + left_out(groups);
}

std::string to_csv(const std::vector<Group>& groups) {
  const bool with_laboratory = have_laboratory(groups);
  std::string table;
  for (const Group& group : groups) {
    std::vector<std::string> names, cells;
    for (const auto& [name, value] : all_fields(group, with_laboratory)) {
      names.emplace_back(name);
      cells.push_back(csv_cell(value));
    }
    if (table.empty()) table = joined(names, ",") + '\n';
    table += joined(cells, ",") + '\n';
  }
  return table;
}

std::string to_json(const std::vector<Group>& groups, double confidence,
                    const store::Provenance& provenance) {
  const bool with_laboratory = have_laboratory(groups);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Group& group : groups) {
    nlohmann::ordered_json entry;
    const std::vector<Field> fields = all_fields(group, with_laboratory);
    for (const auto& [name, value] : fields) entry[name] = json_of(value);
    // For who draws them: such values separate no curves and need no mention.
    entry["automatic"] = nlohmann::ordered_json::array();
    for (const sweep::Column* column : group_columns())
      if (separating_value(*column, group.first_row) == Value() && column->get(group.first_row) != Value())
        entry["automatic"].push_back(column->name);
    if (group.laboratory) entry["laboratory_scale"] = scale_json(*group.laboratory);
    entry["survival"] = nlohmann::ordered_json::array();
    for (const fit::SurvivalStep& step : group.survival) entry["survival"].push_back(json_of(step));
    entry["incidence"] = nlohmann::ordered_json::object();
    for (const Group::EndsBy& cause : group.causes)
      for (const fit::IncidenceStep& step : cause.incidence)
        entry["incidence"][cause.text->count].push_back({{"distance", step.distance},
                                                         {"at_risk", step.num_at_risk},
                                                         {"ends", step.num_ends},
                                                         {"probability", step.probability},
                                                         {"standard_error", step.standard_error},
                                                         {"lower", step.interval.lower},
                                                         {"upper", step.interval.upper}});
    if (is_device(group.first_row.parameters)) entry["passages"] = passages_json(group.passages);
    entry["censored_distances"] = group.censored_distances;
    list.push_back(std::move(entry));
  }
  nlohmann::ordered_json sentences;
  for (const DoubtText& doubt : doubt_texts) sentences[doubt.word] = doubt.sentence;
  nlohmann::ordered_json columns = nlohmann::ordered_json::array();
  for (const sweep::Column* column : group_columns()) columns.push_back(sweep::to_json(*column));
  nlohmann::ordered_json origin = nlohmann::ordered_json::object();
  for (const char* name : {"version", "git_describe", "git_hash", "start_time", "command_line", "config"})
    if (std::string text = attribute(provenance, name); !text.empty()) origin[name] = std::move(text);
  const console::BuildInfo build = console::build_info();
  nlohmann::ordered_json document = {{"version", build.version},
                                     {"git_describe", build.git_describe},
                                     {"confidence", confidence},
                                     {"doubts", sentences},
                                     {"units", field_units(groups)},
                                     {"columns", columns},
                                     {"lists", listed_columns(provenance)},
                                     {"sweep", origin},
                                     {"groups", list}};
  // One scale for all groups, or for each its own.
  for (const Group& group : groups)
    if (const std::optional<LaboratoryText>& own = group.first_row.parameters.laboratory)
      document["laboratories"][own->check_sum()] = console::printable(own->text());
  const std::optional<LaboratoryScale>& first = groups.front().laboratory;
  if (first && std::ranges::all_of(groups, [&](const Group& group) {
        return group.laboratory && scale_json(*group.laboratory) == scale_json(*first);
      }))
    document["laboratory"] = scale_json(*first);
  return console::json_text(document);
}

}  // namespace clog::results
