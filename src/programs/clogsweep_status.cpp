#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <thread>

#include "clog/console/exit_codes.hpp"
#include "clog/console/signals.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/laboratory/lab_file.hpp"
#include "clog/results/events.hpp"
#include "clog/results/status.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/store/journal.hpp"
#include "clog/store/output_path.hpp"
#include "clog/store/run_table.hpp"
#include "clogsweep_commands.hpp"
#include "file_command.hpp"
#include "laboratory_of_results.hpp"

namespace clog::programs {

using results::SharedParameters;
using results::Status;

namespace {

constexpr const char* status_usage =
    R"(clogsweep status prints the progress of a sweep, while it runs or afterwards.

  clogsweep status sweep.h5
  clogsweep status sweep.h5 --watch
  clogsweep status sweep.h5 --follow --format json

Clogging lengths count runs in progress as not clogged so far, at their present distance: finished runs alone would
give too short lengths, because runs that clog early finish first.
)";

constexpr const char* clear_screen = "\x1b[H\x1b[2J";

/// Waits in short steps. Returns whether a signal arrived.
bool wait(std::chrono::milliseconds time) {
  constexpr std::chrono::milliseconds step{100};
  for (; time.count() > 0 && !console::stop_signalled(); time -= step) std::this_thread::sleep_for(step);
  return console::stop_signalled();
}

/// Prints a line for each event until the sweep ends. Pauses after each read, so that reading takes at most a
/// tenth of the time.
int follow(const std::string& path) {
  constexpr int rest = 10;
  constexpr std::chrono::milliseconds shortest{200};
  results::Events events(path);
  std::string stamp;
  for (bool is_first = true;; is_first = false) {
    const bool is_alive = store::Journal::is_open(
        store::journal_path(path));  // queried before reading, so that no event is missed
    const auto begin = std::chrono::steady_clock::now();
    const std::string now = store::OutputPath::resolve(path).stamp();
    if (now != stamp || is_first || !is_alive) {
      const store::SweepFile file = is_first ? results::read_with_caution(path) : store::read_sweep(path);
      for (const std::string& line : events.look(file)) std::cout << line;
      std::cout << std::flush;
      stamp = now;
    }
    if (!is_alive) {
      std::cout << events.end() << std::flush;
      return console::exit_success;
    }
    const auto time =
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - begin);
    if (wait(std::max(shortest, rest * time))) return console::exit_success;
  }
}

/// Gives the groups the scales of their laboratories, unless the file does not contain these laboratories.
void add_scales(const cli::CommandLine& line, std::vector<results::Group>& groups) {
  const bool are_stored = std::ranges::all_of(groups, [](const results::Group& group) {
    const std::optional<LaboratoryText>& own = group.first_row.parameters.laboratory;
    return !own || !own->text().empty();
  });
  if (are_stored && !groups.empty()) set_scales(line, groups);
}

/// The law that scaled a measured speed to the droplets; empty if the speed was not scaled.
std::string law_of_speed(const Status& status) {
  if (status.groups.empty()) return "";
  const RunParameters& run = status.groups.front().first_row.parameters;
  if (!run.laboratory || run.laboratory->text().empty()) return "";
  const auto lab = laboratory::parse_laboratory(run.laboratory->text(), "the laboratory of some rows");
  constexpr double rounding = 1e-3;  // the sweep's terminal speed has four digits
  const bool has_its_speed =
      std::abs(run.drag.terminal_speed / lab.experiment.reduced_terminal_speed() - 1) < rounding;
  return lab.measured && has_its_speed ? laboratory::law_of_speed(lab) + '\n' : "";
}

}  // namespace

int clogsweep_status(int argc, const char* const* argv) {
  cli::CommandLine line("clogsweep status", status_usage);
  line.word("file", "sweep file")
      .flag("watch", "print again every two seconds, until the sweep ends")
      .flag("follow",
            "with --format json: print a line for every start, end and new attempt of a task, and for every "
            "round, until the sweep ends")
      .option("format", "text or json", "text")
      .option("confidence", "confidence level of the intervals", "0.95")
      .flag("all-parameters", "also list parameters that have their defaults in all runs");
  if (!parse_file_command(line, argc, argv)) return console::exit_success;
  const std::string format = line.get_word("format", {"text", "json"});
  const double confidence = line.get_share("confidence");
  const SharedParameters shared =
      line.has("all-parameters") ? SharedParameters::all : SharedParameters::unusual;
  console::catch_stop_signals();
  const std::string path = line.require("file");
  if (line.has("follow") && line.has("watch"))
    throw Error("--follow and --watch exclude each other; give one");
  if (line.has("follow") && format != "json") throw Error("--follow prints lines of JSON; add --format json");
  if (line.has("follow")) return follow(path);
  // is_open() refuses a file of another kind with a message of one line. A missing table is reported when the
  // table is read.
  if (std::filesystem::exists(path)) store::Journal::is_open(store::journal_path(path));
  for (bool is_first = true;; is_first = false) {
    Status status = results::status_of(
        path, is_first ? results::read_with_caution(path) : store::read_sweep(path), confidence);
    add_scales(line, status.groups);
    if (line.has("watch") && format == "text" && isatty(STDOUT_FILENO)) std::cout << clear_screen;
    std::cout << (format == "json"
                      ? results::to_json(status)
                      : results::to_text(path, status, confidence, shared) + law_of_speed(status))
              << std::flush;
    if (!line.has("watch") || !status.is_alive) return console::exit_success;
    if (wait(std::chrono::seconds(2))) return console::exit_success;
  }
}

}  // namespace clog::programs
