#include <fmt/core.h>

#include <algorithm>
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
#include "clog/results/distance_file.hpp"
#include "clog/sweep/keys.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::results {
namespace {

constexpr const char* example = "its first line names columns, such as 'distance [mm],clogged,wall'";
constexpr double metres_per_mm = 1e-3;

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

/// @throws Error if the column gives the place where each droplet was first seen
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

/// A cell of the first line, in the form of the name of a column of results.
/// @param around_unit  characters that may precede the unit
std::string result_name(const std::string& cell, const char* around_unit) {
  const std::string without_unit = console::trimmed(cell.substr(0, cell.find_first_of(around_unit)));
  std::string name = label_key(console::in_lower_case(without_unit));
  std::ranges::replace(name, ' ', '_');
  return name;
}

/// @throws Error if the column has the name of a result. Otherwise the printed table would contain this name
/// twice.
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

/// @throws Error if the column separates droplets by their outcomes, because the lengths of such groups have
/// no meaning
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

/// The factor from the unit of a laboratory's column to mm or degrees; nullopt for any other column. @throws
/// Error if the unit of the column is not known
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

/// @throws Error if a comment gives units, as in files of circles, because in a table of distances each
/// column gives its unit
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
    } else if (!cells[i].empty()) {  // pandas writes an index column without a name
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

/// Reads the numbers of a table that may have decimal commas.
class Cells {
 public:
  double distance(const std::string& cell, char separator) {
    const std::optional<double> distance = number(cell, separator, "distance");
    if (!distance || !(*distance >= 0))
      throw Error(fmt::format("distance is '{}'; write a number of 0 or more", excerpt(cell)));
    return *distance;
  }
  /// The diameter [mm] or the angle [degrees]; unset for an empty cell. @param name  name of the column
  Value of_laboratory(const std::string& cell, char separator, double factor, const std::string& name) {
    if (cell.empty()) return {};
    const std::optional<double> value = number(cell, separator, name);
    if (!value || (name == "diameter" && !(*value > 0)))
      throw Error(fmt::format("{} is '{}'; write a number{}, or leave the cell empty", name,
                              console::printable(excerpt(cell)), name == "diameter" ? " above 0" : ""));
    return factor == 1 ? *value : twelve_digits(factor * *value);
  }
  /// The number or the words of a label. @param name  name of the column
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

/// Prints the names of columns that make each droplet a separate group, such as a column that numbers the
/// droplets.
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
         std::ranges::any_of(sweep::keys(),
                             [&](const sweep::Key& key) { return label_key(key.name) == label_key(label); });
}

/// Prints the names of columns in which every value has only clogged droplets, or only moving droplets.
/// Excludes columns that may number the droplets, in which at least half of the droplets have a unique value.
/// Also excludes quantities that were set before the run.
void hint_at_outcomes(const DistanceTable& table) {
  for (std::size_t i = 0; i < table.labels.size(); ++i) {
    if (is_quantity(table.labels[i])) continue;
    std::map<Value, std::pair<int, int>> counts;  // numbers of moving and of clogged droplets
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
  for (auto& [labels, own] : runs) table.groups.push_back({labels, std::move(own), {}});
  hint_at_lone_droplets(table);
  hint_at_outcomes(table);
  return table;
}

}  // namespace clog::results
