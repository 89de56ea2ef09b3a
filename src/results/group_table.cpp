#include "clog/results/group_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>

#include "clog/console/printable.hpp"
#include "clog/console/rounded.hpp"
#include "clog/console/table.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/parameters/schema.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/results/usual_parameters.hpp"
#include "clog/sweep/keys.hpp"
#include "result_columns.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

/// The parts `key = value` of a laboratory's description.
std::vector<std::string> parts_of(const std::optional<LaboratoryText>& laboratory) {
  std::istringstream text(laboratory ? laboratory->text() : "");
  std::vector<std::string> parts;
  for (std::string part; std::getline(text >> std::ws, part, ';');) parts.push_back(console::printable(part));
  return parts;
}

/// The entries of a group's laboratory that not all groups have; all entries if all groups have the same
/// laboratory.
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

/// The value, to twelve digits if it is a number, as values are compared that follow from others.
Value without_round_off(const Value& value) {
  const auto* number = std::get_if<double>(&value);
  return number ? Value(twelve_digits(*number)) : value;
}

/// A parameter's value as text. User-supplied circles are named by their file, if it is known.
/// @param digits  of a number
std::string rounded_text(const Group& group, const std::vector<Group>& groups, const sweep::Column& column,
                         int digits = few_digits) {
  const sweep::RunRow& row = group.first_row;
  if (column.name == "laboratory")
    if (std::string label = laboratory_label(group, groups); !label.empty()) return label;
  const std::optional<OwnCircles>& own = row.parameters.obstacles.own;
  if (column.name == "obstacles" && own && !own->source().empty())
    return console::printable(std::filesystem::path(own->source()).filename().string());
  return short_text(without_round_off(column.get(row)), digits);
}

/// Marks an automatic value.
const char* star_of(const sweep::Column& column, const sweep::RunRow& row) {
  return is_automatic(column, row) ? "*" : "";
}

/// Explains the letters in the last column.
std::string legend(const std::vector<Group>& groups) {
  std::vector<Doubt> all;
  for (const Group& group : groups) all.insert(all.end(), group.doubts.begin(), group.doubts.end());
  return legend_of(all);
}

/// Explains the stars of parameters that follow from others.
/// @param named  parameters that are columns or words above the table
std::string note_of_automatic(const std::vector<Group>& groups, const std::vector<bool>& named) {
  for (std::size_t i = 0; i < named.size(); ++i)
    for (const Group& group : groups)
      if (named[i] && is_automatic(*group_columns()[i], group.first_row))
        return "*: the automatic value, which follows from other parameters\n";
  return "";
}

/// Explains columns whose heads are not enough.
std::string column_notes(const std::vector<Group>& groups) {
  if (!has_clogging_length(groups.front().first_row)) return "";
  std::string text;
  if (are_mechanisms_shown(groups))
    text += fmt::format(
        "w/s/h/o: clogs that are wrapped, squeezed, hybrid, other (for instance at rest on one obstacle{})\n",
        std::ranges::any_of(groups, is_dwell_possible) ? "; or droplets that moved on" : "");
  if (have_some_broken(groups))
    text +=
        "lambda_b: mean distance before break-up. Broken droplets are censored in lambda, clogged ones in "
        "lambda_b\n";
  if (std::ranges::any_of(groups, [](const Group& group) { return group.num_passed > 0; }))
    text +=
        "passed: droplets that reached the exit. They count as not clogged on their way, so lambda may "
        "exceed the device's length\n";
  if (std::ranges::all_of(groups, [](const Group& group) { return is_device(group.first_row.parameters); }))
    text +=
        "lambda_met: from the first obstacle that a droplet met; droplets that met none count only in the "
        "speeds\n";
  return text;
}

/// The longest time that is shorter than the given time and has one significant digit.
double shorter_dwell(double rest) {
  const double unit = std::pow(10, std::floor(std::log10(rest)));
  const double digit = std::ceil(rest / unit) - 1;
  return digit < 1 ? 0.9 * unit : digit * unit;
}

/// Prints the number of resting droplets that are treated as moving, and names the option that treats them as
/// clogged.
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
                                 count_text(num_resting, "run"), console::plain(shortest_rest));
  if (const double dwell = shorter_dwell(shortest_rest); dwell >= known_from)
    text +=
        fmt::format(": --dwell={} counts {} as clogged", shortest(dwell), num_resting == 1 ? "it" : "them");
  return text + '\n';
}

/// Names droplets that were not released on the entrance.
std::string note_of_displaced(const std::vector<Group>& groups) {
  std::vector<double> places;
  for (const Group& group : groups)
    places.insert(places.end(), group.displaced.begin(), group.displaced.end());
  if (places.empty()) return "";
  const auto [first, last] = std::ranges::minmax(places);
  return fmt::format(
      "   {} released in the nearest void, from x = {:.4g} to {:.4g}, because posts are at their place on "
      "the "
      "entrance; they count only at lines downstream of their release\n",
      places.size() == 1 ? "1 droplet was" : fmt::format("{} droplets were", places.size()), first, last);
}

/// Counts the runs that are missing from the table, or from some of its columns.
std::string left_out(const std::vector<Group>& groups) {
  const auto sum = [&](int Group::*number) {
    int all = 0;
    for (const Group& group : groups) all += group.*number;
    return all;
  };
  const int num_failed = sum(&Group::num_failed), num_damaged = sum(&Group::num_damaged),
            num_interrupted = sum(&Group::num_interrupted), num_left_out = sum(&Group::num_left_out),
            num_repeated = sum(&Group::num_repeated), num_excluded = sum(&Group::num_failed_somewhere);
  std::string text;
  if (num_left_out > 0)
    text += fmt::format(
        "   {} ended before --from-distance, left out of runs, clogs and lambda; <v_g> is still of all "
        "runs\n",
        count_text(num_left_out, "run"));
  if (num_interrupted > 0)
    text += fmt::format(
        "   {} {} unfinished: lambda holds for the distances reached so far, and the clogs so far are the "
        "early ones\n",
        count_text(num_interrupted, "run"), num_interrupted == 1 ? "is" : "are");
  if (num_repeated > 0)
    text += fmt::format("   {} repeat droplets of longer runs and do not count (--pool)\n",
                        count_text(num_repeated, "run"));
  if (num_failed > 0) {
    text += fmt::format("   {} failed; the column `message` says why", num_failed);
    if (has_clogging_length(groups.front().first_row))
      text += num_failed == num_excluded ? ", and left out because the distance is unknown"
              : num_excluded == 0
                  ? ", and counted as not clogged up to sound_distance"
                  : fmt::format(", counted as not clogged up to sound_distance, except {} without one",
                                num_excluded);
    text += '\n';
  }
  if (num_damaged > 0) text += fmt::format("   {} damaged; clogsweep verify tells which\n", num_damaged);
  return text;
}

std::vector<bool> varying_columns(const std::vector<Group>& groups) {
  std::vector<bool> varies;
  for (const sweep::Column* column : group_columns())
    varies.push_back(std::ranges::any_of(groups, [&](const Group& group) {
      return column->get(group.first_row) != column->get(groups.front().first_row);
    }));
  return varies;
}

/// Whether groups with equal other values always have equal values, too.
template <class Value, class Others>
bool is_determined_by(const std::vector<Group>& groups, const Value& value_of, const Others& others_of) {
  std::map<decltype(others_of(groups.front())), decltype(value_of(groups.front()))> known;
  return std::ranges::all_of(groups, [&](const Group& group) {
    return known.try_emplace(others_of(group), value_of(group)).first->second == value_of(group);
  });
}

/// Whether the values of the column follow from the values of the shown columns.
bool follows_from_shown(std::size_t place, const std::vector<bool>& shown, const std::vector<Group>& groups) {
  const auto shown_values = [&](const Group& group) {
    std::vector<Value> values;
    for (std::size_t i = 0; i < shown.size(); ++i)
      if (shown[i]) values.push_back(group_columns()[i]->get(group.first_row));
    return values;
  };
  return is_determined_by(
      groups, [&](const Group& group) { return group_columns()[place]->get(group.first_row); }, shown_values);
}

/// Whether the row lacks a value because the other model alone has this parameter.
bool lacks_as_model(const sweep::Column& column, const sweep::RunRow& row) {
  RunParameters of_other_model = row.parameters;
  of_other_model.model = row.parameters.model == Model::dp ? Model::sp : Model::dp;
  return !has_parameter(column, row.parameters) && has_parameter(column, of_other_model);
}

/// A group with the column's value if one model alone has this parameter, with the same value in all of its
/// groups; otherwise nullptr.
const Group* group_of_only_model(const sweep::Column& column, const std::vector<Group>& groups) {
  const Group* with_value = nullptr;
  bool do_some_lack = false;
  for (const Group& group : groups) {
    const bool lacks = lacks_as_model(column, group.first_row);
    do_some_lack = do_some_lack || lacks;
    if (lacks) continue;
    if (!with_value) with_value = &group;
    if (column.get(group.first_row) != column.get(with_value->first_row)) return nullptr;
  }
  return do_some_lack ? with_value : nullptr;
}

/// Columns that vary, except those whose automatic values follow from the others, and those that vary only
/// because one of the models lacks them.
std::vector<bool> shown_columns(const std::vector<Group>& groups, const std::vector<bool>& varies) {
  const sweep::RunRow& first = groups.front().first_row;
  const RunParameters& run = first.parameters;
  std::vector<bool> shown;
  for (const sweep::Column* column : group_columns()) {
    const auto is_of = [&](const char* key) { return key && column->name == parameter(key).column; };
    const bool is_automatic_everywhere = std::ranges::all_of(
        groups, [&](const Group& group) { return separating_value(*column, group.first_row) == Value(); });
    const bool is_stiffness = std::ranges::any_of(groups, [&](const Group& group) {
      return is_of(model_of(group.first_row.parameters).stiffness_key);
    });
    shown.push_back(
        (varies[shown.size()] && !is_automatic_everywhere && !group_of_only_model(*column, groups)) ||
        (column->get(first) != Value() && is_of(scene_of(run).gap_key)) || is_stiffness);
  }
  // Columns from which automatic values follow come first.
  std::vector<std::size_t> order(shown.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [](std::size_t i) {
    const Parameter* parameter = group_columns()[i]->parameter;
    const int place = parameter ? parameter->automatic_order : 0;
    return std::pair(place == 0, place);
  });
  for (const std::size_t i : order)
    shown[i] = shown[i] || (varies[i] && !group_of_only_model(*group_columns()[i], groups) &&
                            !follows_from_shown(i, shown, groups));
  return shown;
}

/// The parameters that need a mention and that all groups share, or all groups of the one model that has
/// them, by the name of this model. Automatic values have a star.
/// @param named  parameters that are named above or in the table; the function adds its own
std::map<std::string, std::vector<std::string>> shared_words(const std::vector<Group>& groups,
                                                             const std::vector<bool>& varies,
                                                             const std::vector<bool>& shown,
                                                             SharedParameters shared,
                                                             std::vector<bool>& named) {
  std::map<const Group*, std::vector<Value>> all_usual;
  std::map<std::string, std::vector<std::string>> words;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const sweep::Column& column = *group_columns()[i];
    const Group* group = varies[i] ? group_of_only_model(column, groups) : &groups.front();
    if (shown[i] || !group) continue;
    const sweep::RunRow& row = group->first_row;
    std::vector<Value>& usual = all_usual[group];
    if (usual.empty() && shared == SharedParameters::unusual) usual = usual_parameters(row);
    const Value value = column.get(row);
    const std::string text = sweep::text_of(value);
    const bool tells_all =
        column.name == "model" || (column.name == "preset" && text != sweep::find_key("preset").default_text);
    if (text.empty() || text == "none" || !(tells_all || usual.empty() || value != usual[i])) continue;
    words[varies[i] ? name(row.parameters.model) : ""].push_back(
        fmt::format("{}={}{}", column.name, rounded_text(*group, groups, column), star_of(column, row)));
    named[i] = true;
  }
  return words;
}

std::vector<std::string> cells(const Group& group, const std::vector<ResultColumn>& columns) {
  std::vector<std::string> line;
  line.reserve(columns.size());
  for (const ResultColumn& column : columns) line.push_back(column.cell(group));
  return line;
}
std::vector<std::string> heads(const std::vector<ResultColumn>& columns) {
  std::vector<std::string> line;
  line.reserve(columns.size());
  for (const ResultColumn& column : columns) line.push_back(column.name);
  return line;
}

/// The parameters in which the groups differ. If the groups' droplets differ in size or tilt, size and tilt
/// come first; parameters that follow from these are separate.
struct ParameterColumns {
  std::vector<ResultColumn> droplets, others, following;

  std::vector<ResultColumn> first() const {
    std::vector<ResultColumn> both = droplets;
    both.insert(both.end(), others.begin(), others.end());
    return both;
  }
};

ParameterColumns parameter_columns(const std::vector<Group>& groups, const std::vector<bool>& shown) {
  ParameterColumns columns{.droplets = droplet_columns(groups), .others = {}, .following = {}};
  const auto droplet_of = [&](const Group& group) { return cells(group, columns.droplets); };
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (!shown[i]) continue;
    const sweep::Column& column = *group_columns()[i];
    const auto value_of = [&](const Group& group) { return without_round_off(column.get(group.first_row)); };
    const int digits = digits_in(groups, value_of);
    const auto cell = [&groups, &column, digits](const Group& group) {
      return rounded_text(group, groups, column, digits) + star_of(column, group.first_row);
    };
    if (columns.droplets.empty() || !is_determined_by(groups, cell, droplet_of))
      columns.others.push_back({column.name, cell});
    else if (column.name != "laboratory")
      columns.following.push_back({column.name, cell});
  }
  return columns;
}

/// All columns of the table.
std::vector<ResultColumn> columns_of(const std::vector<Group>& groups, double confidence,
                                     const ParameterColumns& parameters) {
  std::vector<ResultColumn> columns = parameters.first();
  const auto add = [&](const std::vector<ResultColumn>& more) {
    columns.insert(columns.end(), more.begin(), more.end());
  };
  const bool has_laboratory = have_laboratory(groups);
  const std::vector<ResultColumn> in_its_units =
      has_laboratory ? laboratory_columns(groups, confidence) : std::vector<ResultColumn>();
  const std::vector<ResultColumn> findings = columns_of_findings(groups, confidence, has_laboratory);
  if (parameters.droplets.empty()) {
    add(findings);
    add(in_its_units);
  } else {
    add(in_its_units);
    add(findings);
    add(parameters.following);
    std::erase_if(columns, [&](const ResultColumn& column) {
      return std::ranges::all_of(groups, [&](const Group& group) { return column.cell(group) == "-"; });
    });
  }
  if (std::ranges::any_of(groups, [](const Group& group) { return !group.doubts.empty(); }))
    add({{"note", [](const Group& group) { return letters_of(group.doubts); }}});
  return columns;
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

/// Appends the cells for one line across a device: x, the number of droplets that passed the line, the number
/// of droplets that passed or stopped before it, the fraction and its interval.
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

/// Shortens a long list to the lines at which the counts change, and the last line.
std::vector<Passage> shown_passages(const std::vector<Passage>& all) {
  constexpr std::size_t most_lines = 8;
  if (all.size() <= most_lines) return all;
  std::vector<Passage> shown;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i == 0 || i + 1 == all.size() || !are_counts_equal(all[i], all[i - 1])) shown.push_back(all[i]);
  return shown;
}

/// The fractions of the droplets that passed the lines of their devices.
std::string table_of_passages(const std::vector<Group>& groups, const std::vector<ResultColumn>& parameters,
                              double confidence) {
  std::vector<std::vector<std::string>> lines = {heads(parameters)};
  for (const char* name : {"x/sigma", "came past", "of", "share"}) lines[0].emplace_back(name);
  lines[0].push_back(fmt::format("{:g} %", 100 * confidence));
  bool are_all_shown = true;
  for (const Group& group : groups) {
    const std::vector<Passage> passages = shown_passages(group.passages);
    are_all_shown = are_all_shown && passages.size() == group.passages.size();
    for (const Passage& passage : passages) {
      append_passage(passage, lines.emplace_back(cells(group, parameters)));
    }
  }
  if (lines.size() == 1) return "";
  return fmt::format("\ndroplets that came past x{}\n{}",
                     are_all_shown ? "" : " (lines with the counts of the line before are left out)",
                     console::aligned(lines));
}

/// What became of the ancestors' area at some lines, with break-up=daughters.
std::string table_of_families(const std::vector<Group>& groups, const std::vector<ResultColumn>& parameters,
                              double confidence) {
  std::vector<std::vector<std::string>> lines = {heads(parameters)};
  for (const char* name :
       {"x/sigma", "droplets", "mean d", "passed", "clogged", "small", "not known", "passing"})
    lines[0].emplace_back(name);
  lines[0].push_back(fmt::format("{:g} %", 100 * confidence));
  for (const Group& group : groups)
    for (const FamilyLine& line : group.families.lines) {
      std::vector<std::string>& words = lines.emplace_back(cells(group, parameters));
      words.push_back(fmt::format("{:g}", line.distance));
      words.push_back(fmt::format("{:.2f}", line.passed.number));
      words.push_back(std::isnan(line.passed.mean) ? "-" : fmt::format("{:.2f}", line.passed.mean));
      for (const double area : {line.passed.area, line.clogged, line.small, line.not_known, line.passing})
        words.push_back(fmt::format("{:.2f}", area));
      words.push_back(std::isnan(line.interval.lower)
                          ? "-"
                          : fmt::format("{:.2f} .. {:.2f}", line.interval.lower, line.interval.upper));
    }
  if (lines.size() == 1) return "";
  return fmt::format(
      "\ndroplets per ancestor that passed x, their mean diameter, and shares of the ancestors' "
      "area\n{}",
      console::aligned(lines));
}

/// Defines a clog, if resting droplets count as clogged, too; otherwise returns an empty text.
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

/// The table of groups with the same kind of results.
std::string text_of_kind(const std::vector<Group>& groups, double confidence, SharedParameters shared) {
  const std::vector<bool> varies = varying_columns(groups);
  const std::vector<bool> shown = shown_columns(groups, varies);
  std::vector<bool> named = shown;
  const auto words = shared_words(groups, varies, shown, shared, named);
  std::vector<std::string> lines_above;
  lines_above.reserve(words.size() + 1);
  for (const auto& [model, own] : words)
    lines_above.push_back((model.empty() ? "all runs:" : fmt::format("runs with model={}:", model)) +
                          wrapped(own));
  if (shared == SharedParameters::unusual)
    lines_above.emplace_back("(the rest as by default; --all-parameters names it)");
  std::string text = joined(lines_above, "\n");
  text += definition_of_clogs(groups);
  const ParameterColumns parameters = parameter_columns(groups, shown);
  const std::vector<ResultColumn> columns = columns_of(groups, confidence, parameters);
  std::vector<std::vector<std::string>> lines = {heads(columns)};
  for (const Group& group : groups) lines.push_back(cells(group, columns));
  return text + "\n\n" + console::aligned(lines) + table_of_passages(groups, parameters.first(), confidence) +
         table_of_families(groups, parameters.first(), confidence) + legend(groups) +
         note_of_automatic(groups, named) + column_notes(groups) + note_of_rest(groups) +
         note_of_displaced(groups) + left_out(groups);
}

}  // namespace

std::string to_text(const std::vector<Group>& groups, double confidence, SharedParameters shared) {
  std::map<Finding, std::vector<Group>> kinds;
  for (const Group& group : groups) kinds[finding_of(group)].push_back(group);
  std::string text;
  for (const auto& [finding, own] : kinds)
    text += (text.empty() ? "" : "\n") + text_of_kind(own, confidence, shared);
  return text;
}

}  // namespace clog::results
