#include <iostream>
#include <string>

#include "clog/console/exit_codes.hpp"
#include "clog/console/printable.hpp"
#include "clog/results/verification.hpp"
#include "clogsweep_commands.hpp"
#include "file_command.hpp"

namespace clog::programs {

int clogsweep_verify(int argc, const char* const* argv) {
  cli::CommandLine line("clogsweep verify",
                        R"(clogsweep verify reads every row of a sweep's file and reports any damage.

  clogsweep verify sweep.h5

It also checks the journal beside the file, which exists until the sweep is complete.

Exit code 0: every bit is as it was written, every row is physically possible, no run has two rows, and no record of the
journal is damaged. 1: there is damage; `clogsweep salvage` copies the undamaged rows. 2: the file or its journal cannot
be read.
)");
  line.word("file", "sweep file");
  if (!parse_file_command(line, argc, argv)) return console::exit_success;
  const results::Verification found = results::verify(line.require("file"));
  for (const std::string& finding : found.findings) std::cout << console::printable(finding) << '\n';
  return found.num_faults == 0 ? console::exit_success : console::exit_internal_fault;
}

}  // namespace clog::programs
