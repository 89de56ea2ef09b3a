#include <iostream>
#include <string>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/printable.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/results/salvage.hpp"
#include "clog/results/selection.hpp"
#include "clog/store/run_table.hpp"
#include "clogsweep_commands.hpp"
#include "file_command.hpp"

namespace clog::programs {

int clogsweep_select(int argc, const char* const* argv) {
  cli::CommandLine line("clogsweep select",
                        R"(clogsweep select copies the rows that fulfil all conditions to a new sweep file.

  clogsweep select sweep.h5 'line_tension>=0.5' --output stiff.h5
  clogsweep select sweep.h5 preset=robust,elastic 'seed<=10' --output some.h5

A condition is a column, one of = != < <= > >=, and a value; = and != take a list. The new file is a sweep of these
runs. For a fit, select rows by parameters: rows selected by their results are a biased sample.
)");
  line.word("file", "sweep file").option("output", "HDF5 file to make").words("where", "condition");
  if (!parse_file_command(line, argc, argv)) return console::exit_success;
  const std::string path = line.require("file");
  const std::vector<std::string> conditions = line.require_all("where");
  const std::string output = line.require("output");
  store::refuse_existing(output);
  const store::SweepFile selected = results::select(path, conditions, origin_of_table(line));
  results::write(selected, {}, output);
  std::cout << console::printable(output) << ": "
            << count_text(static_cast<std::int64_t>(selected.rows.size()), "row") << '\n';
  return console::exit_success;
}

}  // namespace clog::programs
