#include "clog/results/group_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
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
#include "clog/results/usual_parameters.hpp"
#include "clog/sweep/keys.hpp"
#include "group_notes.hpp"
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

/// The entries by which a group's laboratory differs from those of other groups. All entries if all groups
/// have the same laboratory.
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

/// The value; a number is rounded to twelve digits, as in comparisons of values that follow from other
/// values.
Value without_round_off(const Value& value) {
  const auto* number = std::get_if<double>(&value);
  return number ? Value(twelve_digits(*number)) : value;
}

/// A parameter's value as text. User-supplied circles are named by their file, if it is known.
/// @param digits  number of digits of a number
std::string rounded_text(const Group& group, const std::vector<Group>& groups, const sweep::Column& column,
                         int digits = few_digits) {
  const sweep::RunRow& row = group.first_row;
  if (column.holds_text())
    if (std::string label = laboratory_label(group, groups); !label.empty()) return label;
  const std::optional<OwnCircles>& own = row.parameters.obstacles.own;
  if (column.holds_file() && own && !own->source().empty())
    return console::printable(std::filesystem::path(own->source()).filename().string());
  return short_text(without_round_off(column.get(row)), digits);
}

/// Marks an automatic value.
const char* star_of(const sweep::Column& column, const sweep::RunRow& row) {
  return is_automatic(column, row) ? "*" : "";
}

std::vector<bool> varying_columns(const std::vector<Group>& groups) {
  std::vector<bool> varies;
  for (const sweep::Column* column : group_columns())
    varies.push_back(std::ranges::any_of(groups, [&](const Group& group) {
      return column->get(group.first_row) != column->get(groups.front().first_row);
    }));
  return varies;
}

/// Whether groups with equal `others` always have equal values.
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

/// Whether the row lacks a value because only the other model has this parameter.
bool lacks_as_model(const sweep::Column& column, const sweep::RunRow& row) {
  RunParameters of_other_model = row.parameters;
  of_other_model.model = row.parameters.model == Model::dp ? Model::sp : Model::dp;
  return !column.applies_to(row.parameters) && column.applies_to(of_other_model);
}

/// A group with the column's value, if only one model has this parameter and all groups of this model have
/// the same value; otherwise nullptr.
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

/// Columns that vary, except two kinds: automatic values that follow from the other columns, and columns that
/// vary only because one of the models does not have them.
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
  // Automatic values that depend on one another come first. Each of them comes after the values on which it
  // depends.
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

/// Parameters to be named above the table. They have one value in all groups, or in all groups of the only
/// model that has the parameter. The key of the map is the name of this model. Automatic values have a star.
/// @param named  parameters that are named above or in the table; the function adds those that it returns
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
    if (text.empty() || text == "none" || !(usual.empty() || value != usual[i])) continue;
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

/// The parameters in which the groups differ. If the droplets differ in size or tilt, size and tilt come
/// first, and parameters that follow from them are separate.
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
    else if (!column.holds_text())
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

/// The words, wrapped into lines that fit a terminal. A space precedes each word.
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

/// Shortens a long list: keeps only the last line, and the lines at which the counts change.
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
  return fmt::format("\n{}{}\n{}",
                     have_families(groups) ? "released droplets that came past x before they broke up"
                                           : "droplets that came past x",
                     are_all_shown ? "" : " (lines with the counts of the line before are left out)",
                     console::aligned(lines));
}

std::string or_dash(double number) { return std::isnan(number) ? "-" : fmt::format("{:.2f}", number); }

std::string or_dash(const fit::Interval& interval) {
  if (std::isnan(interval.lower)) return "-";
  return fmt::format("{:.2f} .. {:.2f}", interval.lower, interval.upper);
}

/// The droplet's diameter in the laboratory; NaN if it is unknown [mm].
double length_of(const Group& group) {
  return group.laboratory ? group.laboratory->length : std::numeric_limits<double>::quiet_NaN();
}

/// With break-up=daughters, a table of the droplets that passed some lines, and of the fate of the ancestors'
/// area.
std::string table_of_families(const std::vector<Group>& groups, const std::vector<ResultColumn>& parameters,
                              double confidence) {
  const bool has_lengths =
      std::ranges::any_of(groups, [](const Group& group) { return length_of(group) > 0; });
  const std::string level = fmt::format("{:g} %", 100 * confidence);
  std::vector<std::vector<std::string>> lines = {heads(parameters)};
  std::vector<std::string>& head = lines[0];
  head.emplace_back("x/sigma");
  if (has_lengths) head.emplace_back("x/mm");
  head.insert(head.end(), {"droplets", level, "mean d"});
  if (has_lengths) head.emplace_back("mean d/mm");
  head.insert(head.end(), {"passed", "clogged", "small", "not known", "passing", level});
  for (const Group& group : groups)
    for (const FamilyLine& line : group.families.lines) {
      std::vector<std::string>& words = lines.emplace_back(cells(group, parameters));
      words.push_back(fmt::format("{:g}", line.distance));
      if (has_lengths)
        words.push_back(length_of(group) > 0 ? fmt::format("{:.6g}", line.distance * length_of(group)) : "-");
      // The number is a lower bound, because droplets with an unknown fate may still pass.
      words.push_back((line.not_known >= 0.005 ? "> " : "") + or_dash(line.passed.number));
      words.push_back(or_dash(line.passed.number_interval));
      words.push_back(or_dash(line.passed.mean));
      if (has_lengths) words.push_back(or_dash(line.passed.mean * length_of(group)));
      for (const double area : {line.passed.area, line.clogged, line.small, line.not_known, line.passing})
        words.push_back(or_dash(area));
      words.push_back(or_dash(line.interval));
    }
  if (lines.size() > 1)
    return fmt::format(
        "\ndroplets per ancestor that passed x, their mean diameter, and shares of the ancestors' "
        "area\n{}",
        console::aligned(lines));
  return have_families(groups) ? "\nno droplet came 10 sigma from its release, where the first line for "
                                 "daughters is; --lines x1,x2,... counts at nearer lines\n"
                               : "";
}

/// A definition of a clog, if resting droplets also count as clogged; otherwise empty.
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
         table_of_families(groups, parameters.first(), confidence) + notes_below(groups, named);
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
