#include "clogfit_compare.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/cli/python_command.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/results/comparison.hpp"
#include "clog/results/distance_file.hpp"
#include "clog/results/distance_table.hpp"
#include "clog/results/merger.hpp"
#include "file_command.hpp"
#include "laboratory_of_results.hpp"

namespace clog::programs {
namespace {

constexpr const char* compare_usage =
    R"(clogfit compare prints the ratios of the clogging lengths of sweeps.

  clogfit compare robust.h5 elastic.h5
  clogfit compare sweep.h5 --by friction
  clogfit compare robust.h5 elastic.h5 --picture ratio.png
  clogfit compare own.csv sweep.h5 --lab lab.cfg      measured distances (see clogfit lengths) and simulated ones
  clogfit compare own.csv --by 'surfactant [mM]'      groups of one table of measured distances

Each file's length is divided by the first file's. With --by KEY, the length at each value of KEY is divided by that at
the smallest value. Only runs with equal other parameters are compared. Two runs with the same seed form a pair, because
they met the same obstacles. If the two lengths are correlated, the interval of their ratio comes from the pairs, and is
narrower than for two independent lengths. The interval comes from the numbers of clogs if fewer than ten pairs differ,
if the correlation is uncertain, or if --by changes the array, so that equal seeds share no obstacles.

Droplets of several sizes or tilts (see clogfit units) are compared with droplets of the same size and tilt, and their
lengths are printed in mm.
)";

std::vector<results::Side> sides(const cli::CommandLine& line, const std::vector<std::string>& paths) {
  if (line.has("by")) return results::sides_of_column(line.get("by"), results::read_together(paths));
  if (paths.size() < 2)
    throw Error(
        "nothing to compare this file with; give a second file, or --by and a key that varies in this file");
  return results::sides_of_files(paths);
}

/// One run of each laboratory, and one run without a laboratory if there are such runs.
std::vector<sweep::RunRow> one_of_each_laboratory(const std::vector<results::Side>& sides) {
  std::map<std::string, sweep::RunRow> known;
  for (const results::Side& side : sides)
    for (const sweep::RunRow& row : side.rows) {
      const auto& own = row.parameters.laboratory;
      known.try_emplace(own ? own->check_sum() : "", row);
    }
  std::vector<sweep::RunRow> rows;
  rows.reserve(known.size());
  for (auto& [check_sum, row] : known) rows.push_back(std::move(row));
  return rows;
}

/// Compares sweeps, or the values of a parameter in a sweep.
results::Comparisons compare_sweeps(const cli::CommandLine& line, const std::vector<std::string>& paths,
                                    double confidence, std::optional<double> within) {
  const std::vector<results::Side> all = sides(line, paths);
  const std::vector<sweep::RunRow> rows = one_of_each_laboratory(all);
  results::Comparisons found = results::compare(all, confidence, within, scales_of_rows(line, rows));
  if (found.unit == "sigma") found.sigma_mm = sigma_in_mm(line, rows);
  return found;
}

/// Prints which columns of a measured table are not used, because the other table has no corresponding
/// column.
void say_unmatched_columns(const results::DistanceTable& table, const results::DistanceTable& other) {
  if (!table.is_measured) return;
  const std::vector<std::string> columns = results::unmatched_labels(table, other);
  if (!columns.empty())
    console::say(fmt::format(
        "clogfit compare: {}: columns without a match in {}: {} (groups are compared whatever their values)",
        table.source, other.source, joined(columns)));
}

/// Prints which groups are in no comparison.
void say_left_out(const results::Comparisons& comparisons) {
  for (const results::LeftOut& groups : comparisons.left_out)
    console::say(fmt::format("clogfit compare: {}: left out, {} of {} groups match no runs of {}, such as {}",
                             groups.side, groups.number, groups.number_of_all, groups.other, groups.example));
}

/// Compares files, at least one of which is a table of measured distances.
results::Comparisons compare_measured(const cli::CommandLine& line, const std::vector<std::string>& paths,
                                      double confidence) {
  for (const char* option : {"within", "picture"})
    if (line.has(option))
      throw Error(
          fmt::format("no place for --{} (measured distances have no seeds to pair); leave it out", option));
  if (line.has("by")) {
    if (paths.size() > 1)
      throw Error(
          "no place for --by (several files are compared with each other, not groups of one table); give one "
          "table");
    return results::compare_distances(
        results::tables_of_values(results::read_distances(paths[0], results::names_of_comparisons()),
                                  line.get("by")),
        confidence, std::nullopt);
  }
  if (paths.size() < 2)
    throw Error(
        "nothing to compare this table with; give --by COLUMN, or a second file (a sweep or a table)");
  std::vector<results::DistanceTable> tables(paths.size());
  std::vector<std::string> asked;
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (results::is_distance_table(paths[i])) {
      tables[i] = results::read_distances(paths[i], results::names_of_comparisons());
      asked.insert(asked.end(), tables[i].labels.begin(), tables[i].labels.end());
    }
  std::vector<sweep::RunRow> rows;
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (!results::is_distance_table(paths[i])) {
      const results::Side side = results::sides_of_files({paths[i]}).front();
      tables[i] = results::distances_of(side, scales_of_rows(line, side.rows), asked, confidence);
      rows.insert(rows.end(), side.rows.begin(), side.rows.end());
    }
  results::Comparisons found = results::compare_distances(tables, confidence, sigma_in_mm(line, rows));
  for (std::size_t i = 1; i < tables.size(); ++i) {
    say_unmatched_columns(tables[0], tables[i]);
    say_unmatched_columns(tables[i], tables[0]);
  }
  return found;
}

/// Draws the comparison in Python. Does not return.
void draw(const cli::CommandLine& line, const std::vector<std::string>& paths) {
  std::vector<std::string> arguments = {"compare", "--programs", cli::own_folder(), "--output",
                                        line.get("picture")};
  for (const char* option : {"by", "within", "confidence"})
    if (line.has(option)) arguments.insert(arguments.end(), {std::string("--") + option, line.get(option)});
  arguments.insert(arguments.end(), paths.begin(), paths.end());
  cli::become_python("clogfit compare", cli::find_python_module(), arguments);
}

}  // namespace

int clogfit_compare(int argc, const char* const* argv) {
  cli::CommandLine line("clogfit compare", compare_usage);
  line.words("file", "sweep files")
      .option("by", "key; its values are compared with each other")
      .option(
          "within",
          "clogs of a pair within this distance are at the same place (half the sum of obstacle diameter and "
          "gap) [sigma]")
      .option("format", "text, csv or json", "text")
      .option("picture", "draw a picture with this name, as .png and .pdf")
      .option(
          "lab",
          "file that describes the laboratory, see clogfit units; lengths of sweeps are then printed in mm, "
          "as measured lengths are")
      .option("confidence", "confidence level of the intervals", "0.95");
  if (!parse_file_command(line, argc, argv)) return console::exit_success;
  const std::vector<std::string> paths = line.require_all("file");
  const std::string format = line.get_word("format", {"text", "csv", "json"});
  const double confidence = line.get_share("confidence");
  const std::optional<double> within =
      line.has("within") ? std::optional(line.get_positive("within")) : std::nullopt;
  const bool are_measured = std::ranges::any_of(paths, results::is_distance_table);
  if (line.has("picture") && !are_measured) draw(line, paths);
  const results::Comparisons found = are_measured ? compare_measured(line, paths, confidence)
                                                  : compare_sweeps(line, paths, confidence, within);
  say_left_out(found);
  std::cout << (format == "csv"    ? results::to_csv(found)
                : format == "json" ? results::to_json(found)
                                   : results::to_text(found));
  return console::exit_success;
}

}  // namespace clog::programs
