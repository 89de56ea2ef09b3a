#include "laboratory_option.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clog/cli/obstacle_file.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/parameters/schema.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/laboratory/lab_file.hpp"
#include "clog/laboratory/scales.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::programs {
namespace {

/// The droplets of a laboratory file, one or several.
struct Droplets {
  std::vector<laboratory::Laboratory> all;
  /// Whether the droplets have several sizes, or circles were drawn for a droplet of another size.
  bool have_several_sizes = false;
  /// Files of circles that state a unit, but no droplet. Their names get the droplet's diameter, so that a
  /// printed config can be read without the laboratory.
  std::set<std::string> files_without_droplet = {};

  void note_size(double diameter) {
    constexpr double rounding = 0.005;
    have_several_sizes |= std::abs(diameter / all.front().experiment.diameter - 1) > rounding;
  }
};

std::vector<std::string> items_of(const std::string& list) {
  const std::vector<std::string_view> items = sweep::split_list(list);
  return {items.begin(), items.end()};
}

/// The names of the files in the list. If the circles of a file must be scaled, the droplet's diameter
/// follows its name.
std::string scaled_circles(const std::string& list, const laboratory::Laboratory& lab,
                           const Droplets& droplets) {
  constexpr double milli = 1e-3;
  std::vector<std::string> names = items_of(list);
  for (std::string& name : names)
    if ((droplets.have_several_sizes && name != "none") || droplets.files_without_droplet.contains(name))
      name += fmt::format("@{:.12g}mm", lab.experiment.diameter / milli);
  return joined(names, ",");
}

bool is_zero(std::string_view number) { return std::strtod(std::string(number).c_str(), nullptr) == 0; }

bool is_plain_number(std::string_view text) {
  return text.find_first_not_of("0123456789.eE+-") == std::string::npos;
}

/// Whether the geometry of the array depends on this key, and a value of the key is a number without unit
/// other than 0.
bool is_length_without_unit(const Parameter& parameter, ObstacleLayout layout, const std::string& text) {
  RunParameters run;
  run.obstacles.layout = layout;
  const std::string unit = parameter.unit, scope = parameter.scope->word;
  const bool is_of_file = scope == "file" || parameter.key == std::string_view("box");
  const bool counts = layout == ObstacleLayout::file
                          ? is_of_file
                          : parameter.shapes_array && parameter.role == ParameterRole::physics;
  return counts && parameter.applies_to(run) && (unit == "sigma" || unit == "1/sigma^2") &&
         std::ranges::any_of(sweep::numbers_in(text), [](std::string_view number) {
           return is_plain_number(number) && !is_zero(number);
         });
}

/// Refuses lengths of the array without a unit. Such numbers are in droplet diameters, so the array would
/// grow with the droplet, whereas lengths in millimetres give the same array for all droplets. Users who want
/// a growing array must write the unit sigma.
/// @param texts  the texts that the user gave
/// @throws Error
void refuse_lengths_without_unit(const cli::CommandLine& line, const laboratory::Texts& texts) {
  sweep::Settings settings = line.settings();
  if (const auto own = texts.find(sweep::circles_key); own != texts.end())
    settings.set(sweep::circles_key, own->second);
  const auto text_of = [&](const char* key) {
    const auto given = texts.find(key);
    return given == texts.end() ? settings.text(key) : given->second;
  };
  const std::string pitch = text_of("pitch");
  for (const std::string& layout : settings.values("obstacle-layout"))
    for (const Parameter& parameter : parameter_schema()) {
      const std::string text = text_of(parameter.key);
      const bool replaced_by_pitch = layout == "lattice" &&
                                     parameter.key == std::string_view("obstacle-gap") &&
                                     std::ranges::none_of(sweep::numbers_in(pitch), is_zero);
      if (!replaced_by_pitch && is_length_without_unit(parameter, *meant_by<ObstacleLayout>(layout), text))
        throw Error(fmt::format(
            "invalid {0}={1} (a number without a unit is in droplet diameters, but {2} has several droplets, "
            "or a droplet of another size than the circles are drawn for) write it as in {0}=0.5{3}, or with "
            "sigma if it is to grow with the droplet",
            parameter.key, text, line.get("lab"),
            parameter.unit == std::string_view("sigma") ? "mm" : "/mm^2"));
    }
}

/// Prints how the speeds of other droplets follow from the measured speed.
void say_law_of_speed(const cli::CommandLine& line, const Droplets& droplets) {
  const laboratory::Laboratory& first = droplets.all.front();
  const bool is_given =
      line.settings().is_given("terminal-speed") || line.texts_with_units().contains("terminal-speed");
  std::string law = laboratory::law_of_speed(first);
  if (droplets.all.size() > 1 && first.experiment.terminal_speed == 0)
    law = fmt::format("no speed, so all droplets have terminal-speed={}",
                      line.settings().text("terminal-speed"));
  if (!law.empty() && !is_given)
    console::say(fmt::format("{}: {}: {}", line.program(), line.get("lab"), law));
}

/// Prints a line if the laboratory's exponent cannot be that of daughters, because other runs of the same
/// list have no daughters.
void say_exponent_unused(const cli::CommandLine& line, const Droplets& droplets) {
  const std::vector<std::string>& ends = line.settings().values("break-up");
  const std::optional<laboratory::MeasuredSpeed>& law = droplets.all.front().measured;
  if (law && law->exponent > 0 && !line.settings().is_given("speed-exponent") && ends.size() > 1)
    console::say(
        fmt::format("{}: the speed-exponent of {} is not used for daughters, as break-up has several "
                    "values; use one value, or --points",
                    line.program(), line.get("lab")));
}

/// The texts of keys for one droplet: numbers in the model's units, and circles scaled to the droplet.
laboratory::Texts converted(const laboratory::Texts& given, const laboratory::Laboratory& lab,
                            const laboratory::Scales& scales, const Droplets& droplets) {
  laboratory::Texts texts;
  for (const auto& [key, text] : given)
    texts[key] = key == sweep::circles_key ? scaled_circles(text, lab, droplets)
                                           : laboratory::in_model_units(key, text, scales);
  return texts;
}

/// The values of break-up. @param own  texts of a point, which replace those of all points
std::vector<std::string> break_up_words(const laboratory::Texts& own, const sweep::Settings& settings) {
  const auto found = own.find("break-up");
  return found == own.end() ? settings.values("break-up") : items_of(found->second);
}

bool is_daughters(const std::string& break_up) { return break_up == "daughters"; }

/// Texts of the keys that no point sets. @param model  the model; empty if points set the model
laboratory::Texts texts_of(const laboratory::Laboratory& lab, const Droplets& droplets,
                           const laboratory::Texts& given, const sweep::Settings& settings,
                           const std::string& model) {
  const std::vector<std::string> ends = break_up_words(given, settings);
  const bool has_daughters = std::ranges::all_of(ends, is_daughters);
  laboratory::Texts texts = converted(given, lab, laboratory::scales_of(lab), droplets);
  texts.merge(laboratory::droplet_texts(lab, settings, model, has_daughters));
  return texts;
}

/// The points' texts of a key.
std::set<std::string> cells_of(const sweep::Points& points, const std::string& key) {
  std::set<std::string> cells;
  for (std::size_t i = 0; i < points.keys.size(); ++i)
    for (const std::vector<std::string>& row : points.rows)
      if (points.keys[i] == key && !row[i].empty()) cells.insert(row[i]);
  return cells;
}

/// Whether the key has a text other than those of the default and of the preset.
bool is_changed(const sweep::Settings& settings, const std::string& key) {
  std::string usual = sweep::find_key(key).default_text;
  for (const auto& [name, text] : sweep::preset_texts(settings.text("preset")))
    if (name == key) usual = text;
  return settings.is_given(key) && settings.text(key) != usual;
}

/// One line that names the given lengths, times and speeds without a unit, with their values in the
/// laboratory; empty if there are none. Users may have meant such numbers in millimetres.
std::string numbers_without_unit(const cli::CommandLine& line, const Droplets& droplets,
                                 const sweep::Points& points) {
  const laboratory::Scales scales = laboratory::scales_of(droplets.all.front());
  std::vector<std::string> named;
  for (const Parameter& parameter : parameter_schema()) {
    const std::string key = parameter.key, unit = parameter.unit;
    if (parameter.role != ParameterRole::physics || unit == "g rho sigma^2") continue;
    std::set<std::string> texts = cells_of(points, key);
    if (const auto given = line.texts_with_units().find(key); given != line.texts_with_units().end())
      texts.insert(given->second);
    else if (is_changed(line.settings(), key))
      texts.insert(line.settings().text(key));
    std::vector<double> numbers;
    for (const std::string& text : texts)
      for (const std::string_view number : sweep::numbers_in(text))
        if (is_plain_number(number) && !is_zero(number))
          numbers.push_back(std::strtod(std::string(number).c_str(), nullptr));
    if (numbers.empty()) continue;
    const auto [least, most] = std::ranges::minmax(numbers);
    const auto in_laboratory = [&](double value) {
      return laboratory::in_laboratory_units(key, value, scales);
    };
    if (in_laboratory(least).empty()) continue;
    named.push_back(least == most ? fmt::format("{}={} is {}", key, shortest(least), in_laboratory(least))
                                  : fmt::format("{}={} to {} is {} to {}", key, shortest(least),
                                                shortest(most), in_laboratory(least), in_laboratory(most)));
  }
  if (named.empty()) return "";
  return fmt::format("{}: numbers without a unit are in units of the model: {}{}", line.program(),
                     joined(named),
                     droplets.all.size() > 1 ? " with the first droplet of " + line.get("lab") : "");
}

/// A parameter set for each droplet, point and model; there may be no points.
sweep::Points points_of(const cli::CommandLine& line, const Droplets& droplets,
                        const laboratory::Texts& given, sweep::Points points) {
  if (points.rows.empty()) points.rows.emplace_back();
  std::vector<laboratory::Texts> sets;
  std::vector<int> lines;  // lines of the points to which the sets belong
  std::set<std::string> keys;
  for (const laboratory::Laboratory& lab : droplets.all) {
    const laboratory::Scales scales = laboratory::scales_of(lab);
    for (std::size_t place = 0; place < points.rows.size(); ++place) {
      const std::vector<std::string>& row = points.rows[place];
      laboratory::Texts own;
      for (std::size_t i = 0; i < row.size(); ++i)
        if (!row[i].empty()) own[points.keys[i]] = row[i];
      const laboratory::Texts own_set = converted(own, lab, scales, droplets);
      const std::vector<std::string> models =
          own.contains("model") ? items_of(own["model"]) : line.settings().values("model");
      own.insert(given.begin(), given.end());
      if (droplets.have_several_sizes) refuse_lengths_without_unit(line, own);
      for (const std::string& model : models) {
        laboratory::Texts& set = sets.emplace_back(own_set);
        if (!points.lines.empty()) lines.push_back(points.lines[place]);
        if (models.size() > 1) set["model"] = model;
        set.merge(texts_of(lab, droplets, own, line.settings(), model));
        for (const auto& [key, text] : set) keys.insert(key);
      }
    }
  }
  sweep::Points expanded{.keys = {keys.begin(), keys.end()}, .rows = {}, .file = {}, .lines = lines};
  for (const laboratory::Texts& set : sets) {
    std::vector<std::string>& row = expanded.rows.emplace_back();
    for (const std::string& key : keys) row.push_back(set.contains(key) ? set.at(key) : "");
  }
  return expanded;
}

/// Whether obstacle-diameter has a unit in every parameter set.
bool has_diameter_with_unit(const laboratory::Texts& given, const sweep::Points& points) {
  const auto key = std::ranges::find(points.keys, "obstacle-diameter");
  const bool is_given = given.contains("obstacle-diameter");
  if (key == points.keys.end()) return is_given;
  return std::ranges::all_of(points.rows, [&](const std::vector<std::string>& row) {
    const std::string& cell = row[static_cast<std::size_t>(key - points.keys.begin())];
    return cell.empty() ? is_given : !is_plain_number(cell);
  });
}

/// Notes the droplet for which circles were drawn. If the file names no unit, prints the one that is taken.
/// @throws Error if the file is in a unit, and the diameters of some circles are not
void note_circles(const cli::CommandLine& line, const std::string& name, bool has_diameter_with_unit,
                  Droplets& droplets) {
  constexpr double milli = 1e-3;
  const double first_diameter = droplets.all.front().experiment.diameter;
  const OwnCircles circles = cli::read_circles(name, first_diameter);
  if (const auto drawn_for = circles.droplet()) {
    droplets.note_size(*drawn_for);
    const bool is_from_laboratory = cli::read_circles(name, 2 * first_diameter).droplet() != drawn_for;
    if (is_from_laboratory) droplets.files_without_droplet.insert(name);
    if (!has_diameter_with_unit && std::ranges::count(circles.circles(), 0.0, &Obstacle::radius) > 0)
      throw Error(name +
                  " has circles without a diameter, and a unit; write obstacle-diameter with a unit, too, "
                  "as in obstacle-diameter=0.3mm");
  } else if (line.has("dry-run") && !line.has("quiet")) {
    console::say(
        fmt::format("{}: obstacles={} names no unit, so its lengths are in droplet diameters ({:.4g} mm)",
                    line.program(), name, first_diameter / milli));
  }
}

}  // namespace

void use_laboratories(cli::CommandLine& line, sweep::Points& points) {
  if (!line.has("lab")) return;
  sweep::Settings& settings = line.settings();
  Droplets droplets{.all = laboratory::read_laboratories(line.get("lab"))};
  for (const laboratory::Laboratory& lab : droplets.all) droplets.note_size(lab.experiment.diameter);
  laboratory::Texts given = line.texts_with_units();
  std::set<std::string> circle_lists = cells_of(points, sweep::circles_key);
  if (const std::string circles = settings.text(sweep::circles_key); circles != "none") {
    given[sweep::circles_key] = circles;
    circle_lists.insert(circles);
  }
  const double first_diameter = droplets.all.front().experiment.diameter;
  for (const std::string& list : circle_lists)
    for (const std::string& name : items_of(list))
      if (name != "none") note_circles(line, name, has_diameter_with_unit(given, points), droplets);
  std::string without_unit;
  if (!line.has("quiet")) {
    say_law_of_speed(line, droplets);
    say_exponent_unused(line, droplets);
    if (const std::string words = laboratory::unusual_density(droplets.all.front()); !words.empty())
      console::say(fmt::format("{}: {}: {}", line.program(), line.get("lab"), words));
    without_unit = numbers_without_unit(line, droplets, points);
  }
  if (droplets.have_several_sizes && points.empty()) refuse_lengths_without_unit(line, given);
  const std::vector<std::string> models = settings.values("model");
  const bool have_points = droplets.all.size() > 1 || models.size() > 1 || !points.empty();
  const laboratory::Texts base =
      texts_of(droplets.all.front(), droplets, given, settings, have_points ? "" : models.front());
  if (have_points) points = points_of(line, droplets, given, std::move(points));
  for (const auto& [key, text] : base) settings.set(key, text);
  const sweep::CircleFiles before = settings.circle_files();
  for (const auto& [file, circles] : before) settings.detach(file);
  std::vector<std::string> files = settings.missing_files();
  for (const std::string& list : cells_of(points, sweep::circles_key))
    std::ranges::copy(items_of(list), std::back_inserter(files));
  for (const std::string& file : files)
    if (file != "none") settings.attach(file, cli::read_circles(file, first_diameter));
  if (!without_unit.empty()) console::say(without_unit);
}

void use_laboratory(cli::CommandLine& line) {
  if (line.has("lab")) laboratory::read_laboratory(line.get("lab"));
  sweep::Points none;
  use_laboratories(line, none);
}

Refusal in_typed_units(const cli::CommandLine& line, const Refusal& refusal) {
  if (!line.has("lab")) return refusal;
  std::string words;
  bool are_lengths = false;
  for (const Parameter& parameter : parameter_schema()) {
    const std::string key = parameter.key;
    if (key != refusal.about().key && !refusal.names(key)) continue;
    are_lengths |= std::string_view(parameter.unit) == "sigma";
    if (const auto typed = line.texts_with_units().find(key); typed != line.texts_with_units().end())
      words += fmt::format("; {} was given as {}", key, typed->second);
  }
  const std::vector<laboratory::Laboratory> all = laboratory::read_laboratories(line.get("lab"));
  const bool has_scale = std::string_view(refusal.what()).find("1 sigma is") != std::string_view::npos;
  if (are_lengths && all.size() == 1 && !has_scale)
    words +=
        fmt::format("; 1 sigma is {}", laboratory::in_usual_unit(all.front().experiment.diameter, "length"));
  return refusal.between("", words);
}

}  // namespace clog::programs
