#include <iostream>
#include <string>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/printable.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/results/salvage.hpp"
#include "clog/results/selection.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/value_list.hpp"
#include "clogsweep_commands.hpp"
#include "file_command.hpp"

namespace clog::programs {

int clogsweep_select(int argc, const char* const* argv) {
  namespace po = boost::program_options;
  cli::CommandLine line =
      file_command("select", R"(clogsweep select takes the rows that hold to conditions into a new sweep file.

  clogsweep select sweep.h5 'line_tension>=0.5' --output stiff.h5
  clogsweep select sweep.h5 preset=robust,elastic 'seed<=10' --output some.h5

A condition is a column, one of = != < <= > >=, and a value; = and != take a list. Rows must meet all conditions. The
new file holds a sweep of just these runs. Select by parameters if you mean to fit: a selection by results is no fair
sample.
)");
  line.add_options()("output", po::value<std::string>(), "HDF5 file to make")(
      "where", po::value<std::vector<std::string>>(), "a condition; the same as a word without dashes");
  line.add_positional("where", -1);
  if (!parse_file_command(line, argc, argv)) return console::exit_success;
  const std::vector<std::string> conditions = line.get_all("where");
  if (conditions.empty())
    throw Error("missing condition; try clogsweep select sweep.h5 'line_tension>1' --output stiff.h5");
  const std::string output = line.require("output");
  store::refuse_existing(output);
  const store::SweepFile selected = results::select(line.get("file"), conditions, origin_of_table(line));
  results::write(selected, {}, output);
  std::cout << console::printable(output) << ": "
            << sweep::counted(static_cast<std::int64_t>(selected.rows.size()), "row") << '\n';
  return console::exit_success;
}

}  // namespace clog::programs
