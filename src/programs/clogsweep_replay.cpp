#include <fmt/ostream.h>

#include <iostream>
#include <string>

#include "clog/console/exit_codes.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/results/repetition.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clogsweep_commands.hpp"
#include "file_command.hpp"

namespace clog::programs {

namespace po = boost::program_options;

int clogsweep_replay(int argc, const char* const* argv) {
  cli::CommandLine line = file_command(
      "replay", R"(clogsweep replay runs one task of a sweep again and compares the results bit for bit.

  clogsweep replay sweep.h5 12

Exit code 0: the same bits. 1: other results. 2: the run cannot be replayed. The run uses the row's instruction set; one
that went on under another set than it began with cannot be repeated.
)");
  line.add_options()("task", po::value<std::string>(), "the row's number, column `task`");
  line.add_positional("task", 1);
  if (!parse_file_command(line, argc, argv)) return console::exit_success;
  if (!line.has("task")) throw Error("missing task; try clogsweep replay " + line.get("file") + " 0");
  const store::SweepFile file = results::read_with_caution(line.get("file"));
  const sweep::RunRow row = results::replayable_row(file, line.get("task"));
  const auto [again, differing] = results::repeat(row);
  fmt::print(std::cout, "task {}: {}, distance {:.17g}, {:.3g} s\n", line.get("task"), name(again.status),
             again.distance, again.wall_seconds);
  if (differing.empty()) {
    std::cout << "the same bits as the row's\n";
    return console::exit_success;
  }
  fmt::print(std::cout, "differs from the row in: {}\nthe row has {}, distance {:.17g}\n",
             joined(differing, " "), name(row.status), row.distance);
  return console::exit_internal_fault;
}

}  // namespace clog::programs
