#include <unistd.h>

#include <chrono>
#include <iostream>
#include <string>
#include <thread>

#include "clog/campaign/status.hpp"
#include "clog/campaign/stored_sweep.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/signals.hpp"
#include "clog/core/tools/error.hpp"
#include "clogsweep_commands.hpp"
#include "file_command.hpp"

namespace clog::programs {

namespace po = boost::program_options;
using campaign::SharedParameters;
using campaign::Status;

namespace {

constexpr const char* clear_screen = "\x1b[H\x1b[2J";

}  // namespace

int clogsweep_status(int argc, const char* const* argv) {
  cli::CommandLine line =
      file_command("status", R"(clogsweep status says how far a sweep is, while it runs or afterwards.

  clogsweep status sweep.h5
  clogsweep status sweep.h5 --watch

Clogging lengths count runs in progress as not clogged so far, at the distance they have reached: finished runs alone
would give too short ones, since runs that clog early finish first.
)");
  line.add_options()("watch", "again every two seconds, until the sweep ends")(
      "format", po::value<std::string>()->default_value("text"), "text or json")(
      "confidence", po::value<std::string>()->default_value("0.95"), "of the intervals")(
      "all-parameters", "name in the text also what all runs have as by default");
  if (!parse_file_command(line, argc, argv)) return console::exit_success;
  const std::string format = line.get("format");
  if (format != "text" && format != "json")
    throw Error("invalid --format=" + format + " (is not one of text, json)");
  const double confidence = line.get_positive("confidence");
  if (confidence >= 1)
    throw Error("invalid --confidence=" + line.get("confidence") + " (must lie between 0 and 1)");
  const SharedParameters shared =
      line.has("all-parameters") ? SharedParameters::all : SharedParameters::unusual;
  console::catch_stop_signals();
  const std::string path = line.get("file");
  for (bool is_first = true;; is_first = false) {
    const Status status = campaign::status_of(
        path, is_first ? campaign::read_with_caution(path) : store::read_sweep(path), confidence);
    if (line.has("watch") && format == "text" && isatty(STDOUT_FILENO)) std::cout << clear_screen;
    std::cout << (format == "json" ? campaign::to_json(status, confidence)
                                   : campaign::to_text(path, status, confidence, shared))
              << std::flush;
    if (!line.has("watch") || !status.is_alive) return console::exit_success;
    for (int i = 0; i < 20; ++i) {
      if (console::stop_signalled()) return console::exit_success;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
}

}  // namespace clog::programs
