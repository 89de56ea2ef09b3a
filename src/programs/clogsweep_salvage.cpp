#include <iostream>
#include <string>

#include "clog/cli/command_line.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/printable.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/results/salvage.hpp"
#include "clog/store/run_table.hpp"
#include "clogsweep_commands.hpp"
#include "file_command.hpp"

namespace clog::programs {
namespace {

constexpr const char* salvage_usage =
    R"(clogsweep salvage copies the undamaged rows of a damaged sweep file to a new one.

  clogsweep salvage sweep.h5 --output whole.h5

Rows and attributes that are damaged, or that clogsweep verify refuses, are not copied; a message lists them. Results
and snapshots that exist only in the journal beside the file are copied, too. The sweep's own command, with --output
whole.h5, then recomputes the missing runs and restores missing attributes.
)";

}  // namespace

int clogsweep_salvage(int argc, const char* const* argv) {
  cli::CommandLine line("clogsweep salvage", salvage_usage);
  line.word("file", "sweep file").option("output", "HDF5 file to create");
  if (!parse_file_command(line, argc, argv)) return console::exit_success;
  const std::string path = line.require("file"), output = line.require("output");
  store::refuse_existing(output);
  results::Salvage found = results::salvage(path);
  results::drop_what_verify_refuses(path, found);
  for (const std::string& damage : found.damage) std::cout << console::printable(damage) << '\n';
  results::write(found.table, found.snapshots, output);
  const auto num_rows = static_cast<std::int64_t>(found.table.rows.size());
  std::cout << console::printable(output) << ": " << count_text(num_rows, "undamaged row");
  if (found.num_from_journal > 0)
    std::cout << ", results of " << found.num_from_journal << " from the journal";
  if (!found.snapshots.empty())
    std::cout << ", " << count_text(static_cast<std::int64_t>(found.snapshots.size()), "snapshot");
  std::cout << '\n';
  return console::exit_success;
}

}  // namespace clog::programs
