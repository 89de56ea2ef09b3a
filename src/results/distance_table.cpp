#include "clog/results/distance_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "clog/console/csv.hpp"
#include "clog/console/decimal_commas.hpp"
#include "clog/console/printable.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/excerpt.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/fit/log_rank.hpp"
#include "clog/results/usual_parameters.hpp"
#include "clog/sweep/keys.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::results {
namespace {

constexpr const char* example = "its first line names columns, such as 'distance [mm],clogged,wall'";
constexpr double metres_per_mm = 1e-3;

/// The name of a label as a column of a sweep.
std::string column_name(std::string label) {
  std::ranges::replace(label, '-', '_');
  return label;
}

bool has_label(const std::vector<std::string>& labels, const std::string& name) {
  return std::ranges::find(labels, column_name(name), column_name) != labels.end();
}

/// Places of the columns, and other contents of the first line.
struct Head {
  int distance = -1, clogged = -1;
  double factor = 1;  ///< factor from the column's unit to the table's unit
  std::size_t num_columns = 0;
  /// A column whose values separate groups.
  struct Label {
    std::size_t column;
    std::optional<double> factor;  ///< from the unit of a laboratory's column to mm or degrees
  };
  std::vector<Label> labels;
};

void set_once(int& place, std::size_t column, const char* name) {
  if (std::exchange(place, static_cast<int>(column)) >= 0)
    throw Error(fmt::format("there are two columns named {}; delete one", name));
}

/// Reads a column of distances. @throws Error if its unit is not a length
void take_distance(Head& head, std::size_t column, const std::string& unit, DistanceTable& table) {
  set_once(head.distance, column, "distance");
  table.unit = unit == "sigma" ? unit : "mm";
  const std::optional<double> metres = console::metres_of(unit);
  if (table.unit != unit && !metres)
    throw Error(fmt::format("distance has {}; write distance [mm], um, cm, m or sigma (droplet diameters)",
                            unit.empty() ? "no unit" : "the unit '" + excerpt(unit) + "'"));
  if (metres) head.factor = *metres / metres_per_mm;
}

/// @throws Error if the column says where each droplet was first seen
void refuse_entry(const std::string& cell, const std::string& name, const std::string& unit) {
  const bool is_length = unit == "sigma" || (!unit.empty() && console::metres_of(unit));
  static const std::set<std::string> places = {"start", "begin", "from", "entrance", "entered", "x0"};
  if (name == "entry" || (is_length && places.contains(name)))
    throw Error(fmt::format(
        "column '{}' says where droplets were first seen, and groups cannot depend on that; delete the "
        "column "
        "and subtract its values from the distances, which does not change the length of an exponential law, "
        "or give a common value by --from-distance",
        console::printable(cell)));
}

/// The name of a cell of the first line as a column of results.
/// @param around_unit  what may begin the unit
std::string result_name(const std::string& cell, const char* around_unit) {
  const std::string without_unit = console::trimmed(cell.substr(0, cell.find_first_of(around_unit)));
  std::string name = column_name(console::in_lower_case(without_unit));
  std::ranges::replace(name, ' ', '_');
  return name;
}

/// @throws Error if the column has the name of a result, which the printed table would contain twice
/// @param taken  names of results
void refuse_result(const std::string& cell, const std::vector<std::string>& taken) {
  const std::string name = result_name(cell, "[(/");
  const auto end = name.rfind('_');
  const bool has_unit = end != std::string::npos && console::metres_of(name.substr(end + 1));
  const bool is_confidence =
      name.ends_with('%') && name.find_first_not_of("0123456789.,_") == name.size() - 1 && name.size() > 1;
  const auto is_taken = [&](const std::string& one) { return std::ranges::find(taken, one) != taken.end(); };
  if (is_confidence || is_taken(name) || (has_unit && is_taken(name.substr(0, end))))
    throw Error(fmt::format("column '{}' has the name of a result; rename it", console::printable(cell)));
}

/// @throws Error if the column would separate droplets by their outcomes, so that lengths mean nothing
void refuse_outcome(const std::string& cell) {
  const std::string name = result_name(cell, "[(");
  static const std::set<std::string> words = {"censored", "event", "outcome"};
  const bool is_result = std::ranges::any_of(sweep::columns(), [&](const sweep::Column& column) {
    return column.role == sweep::ColumnRole::result && column.name == name;
  });
  if (is_result || words.contains(name))
    throw Error(fmt::format(
        "column '{}' belongs to the outcome of a droplet, on which groups cannot depend; delete it",
        console::printable(cell)));
}

/// The factor to the unit of a laboratory's column, mm or degrees; nullopt for any other column.
/// @throws Error if the unit of a laboratory's column is not known
std::optional<double> laboratory_factor(const std::string& cell, const std::string& name,
                                        const std::string& unit) {
  if (name != "diameter" && name != "angle") return {};
  const bool is_length = name == "diameter";
  std::optional<double> factor = is_length ? console::metres_of(unit) : console::degrees_of(unit);
  if (is_length && factor) factor = *factor / metres_per_mm;
  if (!is_length && unit.empty()) factor = 1;
  if (!factor)
    throw Error(fmt::format("column '{}' has {}; write {}, or rename a column that is not {}",
                            console::printable(excerpt(cell)),
                            unit.empty() ? "no unit" : "the unit '" + console::printable(excerpt(unit)) + "'",
                            is_length ? "diameter [mm], um, cm or m" : "angle [deg] or rad",
                            is_length ? "the droplets' diameter" : "the tilt of the plates"));
  return factor;
}

/// @throws Error if a comment states units, as in files of circles: the numbers of this table have others
void refuse_units(const std::string& comment) {
  const console::UnitsComment stated = console::units_in(comment);
  if (stated.unit || stated.droplet)
    throw Error(
        "units in a comment do not apply to a table of distances; delete this line, write the unit in the "
        "header, as in 'distance [um]', and give the droplet's diameter in a column 'diameter [um]' or by "
        "--lab");
}

Head head_of(std::vector<std::string> cells, DistanceTable& table, const std::vector<std::string>& taken) {
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
  Head head;
  head.num_columns = cells.size();
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto [name, unit] = console::column_head(cells[i]);
    const bool is_in_brackets = cells[i].find_first_of("[(") != std::string::npos;
    if (name == "distance" &&
        (is_in_brackets || unit.empty() || unit == "sigma" || console::metres_of(unit))) {
      take_distance(head, i, unit, table);
    } else if (console::in_lower_case(cells[i]) == "clogged") {
      set_once(head.clogged, i, "clogged");
    } else if (!cells[i].empty()) {  // pandas writes its index without a name
      others.push_back(i);
    }
  }
  if (head.distance < 0 || head.clogged < 0)
    throw Error(fmt::format(
        "has no column {}; {}", head.distance < 0 ? "distance" : "clogged",
        head.clogged < 0 && std::ranges::any_of(others, [&](std::size_t i) { return cells[i] == "censored"; })
            ? "clogged is the opposite of censored: give a column clogged with 1 where censored is 0"
            : example));
  for (const std::size_t i : others) {
    const auto [name, unit] = console::column_head(cells[i]);
    refuse_entry(cells[i], name, unit);
    const std::optional<double> factor = laboratory_factor(cells[i], name, unit);
    head.labels.push_back({i, factor});
    const std::string& label = table.labels.emplace_back(factor ? name : console::printable(cells[i]));
    if (std::ranges::count(table.labels, label) > 1)
      throw Error(fmt::format("there are two columns named {}; delete one", label));
    refuse_result(cells[i], taken);
    refuse_outcome(cells[i]);
  }
  return head;
}

std::optional<double> number_of(const std::string& text) {
  try {
    return sweep::to_number(text);
  } catch (const Error&) {
    return {};
  }
}

/// The cell with a decimal point in place of its comma, unless the comma may separate thousands.
std::string with_any_comma_as_point(std::string cell) {
  if (!console::may_have_thousands(cell)) std::ranges::replace(cell, ',', '.');
  return cell;
}

bool is_clogged(const std::string& cell) {
  const std::string word = console::in_lower_case(cell);
  static const std::set<std::string> yes = {"yes", "y", "true", "t"};
  static const std::set<std::string> no = {"no", "n", "false", "f"};
  const std::optional<double> number = number_of(with_any_comma_as_point(cell));
  if (yes.contains(word) || number == 1) return true;
  if (no.contains(word) || number == 0) return false;
  throw Error(
      fmt::format("clogged is '{}'; write 1 for a droplet that clogged and 0 for one that was last "
                  "seen moving there (censored)",
                  excerpt(cell)));
}

/// Numbers of a table whose cells may have decimal commas.
class Cells {
 public:
  double distance(const std::string& cell, char separator) {
    const std::optional<double> distance = number(cell, separator, "distance");
    if (!distance || !(*distance >= 0))
      throw Error(fmt::format("distance is '{}'; write a number of 0 or more", excerpt(cell)));
    return *distance;
  }
  /// The diameter [mm] or the angle [degrees]; unset for an empty cell. @param name  of the column
  Value of_laboratory(const std::string& cell, char separator, double factor, const std::string& name) {
    if (cell.empty()) return {};
    const std::optional<double> value = number(cell, separator, name);
    if (!value || (name == "diameter" && !(*value > 0)))
      throw Error(fmt::format("{} is '{}'; write a number{}, or leave the cell empty", name,
                              console::printable(excerpt(cell)), name == "diameter" ? " above 0" : ""));
    return factor == 1 ? *value : twelve_digits(factor * *value);
  }
  /// The number or the words of a label. @param name  of the column
  Value label(const std::string& cell, const std::string& name) {
    const std::optional<double> number = number_of(with_any_comma_as_point(cell));
    if (!number) return cell.empty() ? Value() : Value(console::printable(cell));
    with_point(cell, name);
    return *number;
  }
  void check(const std::string& path) const { commas_.check(path); }

 private:
  console::DecimalCommas commas_;

  std::optional<double> number(const std::string& cell, char separator, const std::string& name) {
    const bool is_ambiguous = separator == ',' && console::may_have_thousands(cell);
    if (is_ambiguous) console::DecimalCommas::refuse(name + ": ", cell);
    return number_of(with_point(cell, name));
  }
  std::string with_point(const std::string& cell, const std::string& name) {
    try {
      return commas_.with_point(cell);
    } catch (const Error& error) {
      throw Error(name + ": " + error.what());
    }
  }
};

std::optional<double> number_in(const Value& value) {
  if (const auto* count = std::get_if<std::int64_t>(&value)) return static_cast<double>(*count);
  const auto* number = std::get_if<double>(&value);
  return number ? std::optional(*number) : std::nullopt;
}

/// Whether two labels are the same. A person may have rounded a number to three digits.
bool are_alike(const Value& one, const Value& other) {
  constexpr double rounding = 0.005;
  const std::optional<double> number = number_in(one), number_there = number_in(other);
  return number && number_there ? std::abs(*number - *number_there) <= rounding * std::abs(*number_there)
                                : one == other;
}

bool has_diameter_like(const DistanceTable& table, double sigma_mm) {
  return std::ranges::all_of(table.groups, [&](const DistanceGroup& group) {
    const std::optional<double> own = diameter_of(table, group, sigma_mm);
    return own && are_alike(Value(*own), Value(sigma_mm));
  });
}

/// Whether both have the same distances, in any order.
bool are_same(const std::vector<fit::Observation>& here, const std::vector<fit::Observation>& there) {
  const auto sorted = [](const std::vector<fit::Observation>& runs) {
    std::vector<std::pair<double, bool>> all;
    all.reserve(runs.size());
    for (const fit::Observation& run : runs) all.emplace_back(run.distance, run.clogged);
    std::ranges::sort(all);
    return all;
  };
  return sorted(here) == sorted(there);
}

/// How the groups of two tables match.
struct Match {
  std::vector<std::string> columns;  ///< labels of the first table, then those that only the second table has
  std::vector<std::pair<std::size_t, std::size_t>> common;  ///< places of a common label in the two tables
  std::vector<std::size_t> only_there;

  bool have_common_labels(const DistanceGroup& here, const DistanceGroup& there) const {
    return std::ranges::all_of(common, [&](const auto& pair) {
      return are_alike(here.labels[pair.first], there.labels[pair.second]);
    });
  }
};

Match match_of(const DistanceTable& here, const DistanceTable& there) {
  Match match{.columns = here.labels, .common = {}, .only_there = {}};
  for (std::size_t i = 0; i < there.labels.size(); ++i) {
    const auto same = std::ranges::find(here.labels, column_name(there.labels[i]), column_name);
    if (same != here.labels.end()) {
      match.common.emplace_back(same - here.labels.begin(), i);
    } else {
      match.only_there.push_back(i);
      match.columns.push_back(there.labels[i]);
    }
  }
  return match;
}

/// @param matched  places of the groups that match a group of the other table
void append_unmatched(Comparisons& comparisons, const DistanceTable& table,
                      const DistanceTable& compared_with, const std::set<std::size_t>& matched) {
  std::vector<std::vector<Value>> unmatched;
  for (std::size_t i = 0; i < table.groups.size(); ++i)
    if (!matched.contains(i)) unmatched.push_back(table.groups[i].labels);
  append_left_out(comparisons, table.source, compared_with.source, table.labels, unmatched,
                  table.groups.size());
}

DistanceTable grouped(DistanceTable table,
                      std::map<std::vector<Value>, std::vector<fit::Observation>>&& runs) {
  for (auto& [labels, own] : runs) table.groups.push_back({labels, std::move(own), {}});
  return table;
}

/// Says which columns make each droplet a group of its own, such as a column that numbers the droplets.
void hint_at_lone_droplets(const DistanceTable& table) {
  constexpr std::size_t fewest_groups = 3;
  if (table.groups.size() < fewest_groups) return;
  for (const DistanceGroup& group : table.groups)
    if (group.runs.size() > 1) return;
  std::vector<std::string> unique;
  for (std::size_t i = 0; i < table.labels.size(); ++i) {
    std::set<Value> values;
    for (const DistanceGroup& group : table.groups) values.insert(group.labels[i]);
    if (values.size() == table.groups.size()) unique.push_back(table.labels[i]);
  }
  console::say(fmt::format(
      "clogfit: {}: each droplet is a group of its own; delete columns such as {} to join droplets",
      table.source, joined(unique.empty() ? table.labels : unique)));
}

/// Whether the label is a quantity that was set before the run: a key, or a column of the laboratory.
bool is_quantity(const std::string& label) {
  return label == "diameter" || label == "angle" ||
         std::ranges::any_of(sweep::keys(), [&](const sweep::Key& key) {
           return column_name(key.name) == column_name(label);
         });
}

/// Names columns each of whose values has only clogged, or only moving droplets. If half of the droplets or
/// more have a value of their own, the column may number the droplets, and is not named. Nor are quantities
/// that were set before the run.
void hint_at_outcomes(const DistanceTable& table) {
  for (std::size_t i = 0; i < table.labels.size(); ++i) {
    if (is_quantity(table.labels[i])) continue;
    std::map<Value, std::pair<int, int>> counts;  // of moving and clogged droplets
    for (const DistanceGroup& group : table.groups)
      for (const fit::Observation& run : group.runs)
        ++(run.clogged ? counts[group.labels[i]].second : counts[group.labels[i]].first);
    bool is_any_moving = false, is_any_clogged = false, is_any_mixed = false;
    int num_alone = 0, num_together = 0;
    for (const auto& [value, number] : counts) {
      const auto& [num_moving, num_clogged] = number;
      const int num_droplets = num_moving + num_clogged;
      (num_droplets > 1 ? num_together : num_alone) += num_droplets;
      is_any_mixed |= num_moving > 0 && num_clogged > 0;
      is_any_moving |= num_moving > 0;
      is_any_clogged |= num_clogged > 0;
    }
    if (is_any_moving && is_any_clogged && !is_any_mixed && num_alone < num_together)
      console::say(fmt::format(
          "clogfit: {}: each value of '{}' has only clogged or only moving droplets; if the column restates "
          "the outcome, delete it",
          table.source, table.labels[i]));
  }
}

}  // namespace

std::optional<double> diameter_of(const DistanceTable& table, const DistanceGroup& group,
                                  std::optional<double> sigma_mm) {
  const auto place = std::ranges::find(table.labels, "diameter");
  if (place == table.labels.end()) return sigma_mm;
  return number_in(group.labels[static_cast<std::size_t>(place - table.labels.begin())]);
}

std::vector<std::string> unmatched_labels(const DistanceTable& table, const DistanceTable& other) {
  std::vector<std::string> unmatched = table.labels;
  std::erase_if(unmatched, [&](const std::string& label) { return has_label(other.labels, label); });
  return unmatched;
}

bool is_distance_table(const std::string& path) {
  static const std::set<std::string> endings = {".csv", ".tsv", ".txt", ".dat"};
  return endings.contains(console::in_lower_case(std::filesystem::path(path).extension()));
}

DistanceTable read_distances(const std::string& path, const std::vector<std::string>& taken) {
  DistanceTable table{
      .source = console::printable(path), .unit = "", .labels = {}, .groups = {}, .is_measured = true};
  std::map<std::vector<Value>, std::vector<fit::Observation>> runs;
  std::optional<Head> head;
  Cells cells;
  console::read_table(
      path,
      [&](const console::TableLine& line) {
        if (!head) {
          head = head_of(line.cells, table, taken);
          return;
        }
        std::vector<std::string> texts = line.cells;
        while (texts.size() > head->num_columns && texts.back().empty()) texts.pop_back();
        if (texts.size() != head->num_columns)
          throw Error(fmt::format("has {}, but the first line names {}",
                                  count_text(std::ssize(texts), "cell"), head->num_columns));
        std::vector<Value> labels;
        labels.reserve(head->labels.size());
        for (std::size_t i = 0; i < head->labels.size(); ++i) {
          const auto& [column, factor] = head->labels[i];
          const std::string &cell = texts[column], &name = table.labels[i];
          labels.push_back(factor ? cells.of_laboratory(cell, line.separator, *factor, name)
                                  : cells.label(cell, name));
        }
        const double distance =
            cells.distance(texts[static_cast<std::size_t>(head->distance)], line.separator);
        runs[std::move(labels)].push_back(
            {head->factor * distance, is_clogged(texts[static_cast<std::size_t>(head->clogged)])});
      },
      refuse_units);
  cells.check(path);
  if (runs.empty()) throw Error(fmt::format("{} holds no distances; {}", path, example));
  table = grouped(std::move(table), std::move(runs));
  hint_at_lone_droplets(table);
  hint_at_outcomes(table);
  return table;
}

DistanceTable counted_from(double from, DistanceTable table) {
  int num_left_out = 0;
  for (DistanceGroup& group : table.groups) {
    num_left_out += static_cast<int>(
        std::erase_if(group.runs, [=](const fit::Observation& run) { return run.distance < from; }));
    for (fit::Observation& run : group.runs) run.distance -= from;
  }
  table.from = from;
  if (num_left_out > 0)
    console::say(fmt::format("clogfit lengths: {}: left out, {} that ended before --from-distance={} {}",
                             table.source, count_text(num_left_out, "droplet"), shortest(from), table.unit));
  return table;
}

std::vector<DistanceTable> tables_of_values(const DistanceTable& table, const std::string& label) {
  const auto found = std::ranges::find(table.labels, column_name(label), column_name);
  if (found == table.labels.end())
    throw Error(
        fmt::format("invalid --by={} (no column of {}, besides distance and clogged); its columns are {}",
                    label, table.source, joined(table.labels)));
  const auto place = found - table.labels.begin();
  std::map<Value, DistanceTable> tables;
  for (DistanceGroup group : table.groups) {
    const Value value = group.labels[static_cast<std::size_t>(place)];
    DistanceTable& one = tables[value];
    if (one.groups.empty()) {
      one = {.source = named_value(*found, value),
             .unit = table.unit,
             .labels = table.labels,
             .groups = {},
             .is_measured = true};
      one.labels.erase(one.labels.begin() + place);
    }
    group.labels.erase(group.labels.begin() + place);
    one.groups.push_back(std::move(group));
  }
  if (tables.size() < 2)
    throw Error(fmt::format("invalid --by={} (all droplets have the same) give a column that varies", label));
  std::vector<DistanceTable> all;
  all.reserve(tables.size());
  for (auto& [value, one] : tables) all.push_back(std::move(one));
  return all;
}

DistanceTable distances_of(const Side& side, const ScalesByLaboratory& scales,
                           const std::vector<std::string>& asked, double confidence) {
  require_lengths(side);
  const bool is_in_mm =
      scales.size() > 1 || (!scales.empty() && (has_label(asked, "diameter") || has_label(asked, "angle")));
  DistanceTable table{.source = side.name, .unit = is_in_mm ? "mm" : "sigma", .labels = {}, .groups = {}};
  std::vector<const sweep::RunRow*> rows;
  for (const sweep::RunRow& row : side.rows)
    if (is_observed(row)) rows.push_back(&row);
  std::vector<const sweep::Column*> varying;
  for (const sweep::Column* column : group_columns())
    if (has_label(asked, column->name) || std::ranges::any_of(rows, [&](const sweep::RunRow* row) {
          return separating_value(*column, *row) != separating_value(*column, *rows.front());
        }))
      varying.push_back(column);
  if (is_in_mm)
    std::erase_if(varying, [&](const sweep::Column* column) {
      return !has_label(asked, column->name) && follows_from_droplet(*column, rows, scales);
    });
  for (const sweep::Column* column : varying) table.labels.push_back(column->name);
  if (is_in_mm) table.labels.insert(table.labels.end(), {"diameter", "angle"});
  const auto labels_of = [&](const sweep::RunRow& row) {
    std::vector<Value> labels;
    labels.reserve(varying.size());
    for (const sweep::Column* column : varying) labels.push_back(column->get(row));
    if (is_in_mm) {
      const LaboratoryScale& scale = scale_in(scales, row);
      labels.insert(labels.end(), {twelve_digits(scale.length), scale.tilt});
    }
    return labels;
  };
  std::map<std::vector<Value>, std::vector<fit::Observation>> runs;
  for (const sweep::RunRow* row : rows) {
    std::optional<fit::Observation> run = observation_of(*row);
    if (!run) continue;
    if (is_in_mm) run->distance *= scale_in(scales, *row).length;
    runs[labels_of(*row)].push_back(*run);
  }
  table = grouped(std::move(table), std::move(runs));
  std::map<std::vector<Value>, Flaws> flaws;
  for (const Group& group : group_runs(side.rows, confidence)) {
    Flaws& all = flaws[labels_of(group.first_row)];
    all.num_failed += group.num_failed;
    for (const Doubt doubt : group.doubts)
      if (std::ranges::find(all.doubts, doubt) == all.doubts.end()) all.doubts.push_back(doubt);
  }
  for (DistanceGroup& group : table.groups) group.flaws = flaws[group.labels];
  return table;
}

Comparisons compare_distances(const std::vector<DistanceTable>& tables, double confidence,
                              std::optional<double> sigma_mm) {
  const DistanceTable& there = tables.front();
  const std::optional<double> given_sigma = sigma_mm;
  const bool are_units_equal =
      std::ranges::all_of(tables, [&](const DistanceTable& table) { return table.unit == there.unit; });
  // Distances in droplet diameters do not say which of several droplets of a sweep is meant.
  const auto knows_diameters = [&](const DistanceTable& table) {
    return (sigma_mm || table.is_measured) &&
           std::ranges::all_of(table.groups, [&](const DistanceGroup& group) {
             return diameter_of(table, group, sigma_mm).has_value();
           });
  };
  for (const DistanceTable& table : tables) {
    const DistanceTable& in_mm = table.unit == "mm" ? table : there;
    if (table.unit == there.unit || knows_diameters(in_mm)) continue;
    throw Error(
        fmt::format("cannot compare {} with {} (one is in mm, the other in droplet diameters); {}",
                    table.source, there.source,
                    !in_mm.is_measured
                        ? "the sweep has several droplets: give distances in mm, and a column diameter [mm]"
                    : has_label(in_mm.labels, "diameter")
                        ? "fill the empty cells of the column diameter, or delete these rows"
                        : "give the droplet's diameter by --lab lab.cfg"));
  }
  if (sigma_mm && !std::ranges::all_of(tables, [&](const DistanceTable& table) {
        return has_diameter_like(table, *sigma_mm);
      }))
    sigma_mm.reset();  // the groups have several sizes
  Comparisons comparisons;
  comparisons.confidence = confidence;
  comparisons.unit = sigma_mm || !are_units_equal ? "sigma" : there.unit;
  comparisons.sigma_mm = sigma_mm;
  const auto runs_of = [&](const DistanceTable& table, const DistanceGroup& group) {
    std::vector<fit::Observation> runs = group.runs;
    if (table.unit != comparisons.unit)
      for (fit::Observation& run : runs) run.distance /= diameter_of(table, group, given_sigma).value();
    return runs;
  };
  int num_groups = 0;
  const auto numbered_flaws = [&](const DistanceTable& table) {
    std::vector<Flaws> all = flaws_of(table);
    std::map<std::string, int> known;
    for (Flaws& flaws : all) flaws.group = number_of(flaws, known, num_groups);
    return all;
  };
  const std::vector<Flaws> flaws_there = numbered_flaws(there);
  for (std::size_t i = 1; i < tables.size(); ++i) {
    const DistanceTable& here = tables[i];
    const Match match = match_of(here, there);
    const std::vector<Flaws> flaws_here = numbered_flaws(here);
    if (i == 1) comparisons.columns = match.columns;
    if (match.columns != comparisons.columns)
      throw Error(
          fmt::format("cannot compare {} (its groups differ in {}, those of {} in {}); compare two "
                      "files at a time",
                      here.source, joined(match.columns), tables[1].source, joined(comparisons.columns)));
    std::set<std::size_t> matched_here, matched_there;
    for (std::size_t place = 0; place < here.groups.size(); ++place)
      for (std::size_t other_place = 0; other_place < there.groups.size(); ++other_place) {
        const DistanceGroup &one = here.groups[place], &other = there.groups[other_place];
        if (!match.have_common_labels(one, other)) continue;
        matched_here.insert(place);
        matched_there.insert(other_place);
        Comparison comparison{.here = here.source, .there = there.source, .common = one.labels};
        comparison.flaws_here = flaws_here[place];
        comparison.flaws_there = flaws_there[other_place];
        for (const std::size_t label : match.only_there) comparison.common.push_back(other.labels[label]);
        const std::vector<fit::Observation> runs = runs_of(here, one), others = runs_of(there, other);
        comparison.length_here = fit::fit_clogging_length(runs, confidence);
        comparison.length_there = fit::fit_clogging_length(others, confidence);
        comparison.ratio = fit::fit_length_ratio(runs, others, {}, confidence);
        comparison.log_rank_p = fit::log_rank_p_value(runs, others);
        comparison.are_identical = runs.size() > 1 && are_same(runs, others);
        comparisons.all.push_back(std::move(comparison));
      }
    append_unmatched(comparisons, here, there, matched_here);
    append_unmatched(comparisons, there, here, matched_there);
  }
  if (comparisons.all.empty()) {
    std::vector<std::string> common = there.labels;
    std::erase_if(common, [&](const std::string& label) { return !has_label(tables[1].labels, label); });
    throw Error(
        fmt::format("cannot compare {} with {} (no group of one has the labels of a group of the other); "
                    "both need the same values of {}",
                    tables[1].source, there.source, joined(common)));
  }
  correct_tests(comparisons);
  return comparisons;
}

}  // namespace clog::results
