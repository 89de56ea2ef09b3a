#include <fmt/core.h>

#include <iostream>
#include <string>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/printable.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/results/merger.hpp"
#include "clog/results/salvage.hpp"
#include "clog/store/run_table.hpp"
#include "clogsweep_commands.hpp"
#include "file_command.hpp"

namespace clog::programs {
namespace {

constexpr const char* merge_usage = R"(clogsweep merge makes one sweep file of several.

  clogsweep merge a.h5 b.h5 c.h5 --output all.h5

A run that is in several files is copied once. Two rows of the same run with different results are an error. The new
file lists its source files with their sessions, versions and hosts. You can resume and extend the new file like any
other sweep.
)";

void print_merged(const std::string& output, const std::vector<std::string>& paths,
                  const results::MergedSweep& merged) {
  std::cout << console::printable(output) << ": "
            << count_text(static_cast<std::int64_t>(merged.table.rows.size()), "row") << " of "
            << count_text(static_cast<std::int64_t>(paths.size()), "file");
  if (merged.num_shared > 0)
    std::cout << ", " << count_text(merged.num_shared, "run") << " in more than one of them";
  if (merged.num_differing > 0)
    std::cout
        << " (" << merged.num_differing
        << " with results that differ by instruction set: the results of the file named first were kept)";
  if (merged.num_faulty > 0)
    std::cout << "; " << count_text(merged.num_faulty, "row") << " left out as physically impossible";
  if (!merged.snapshots.empty())
    std::cout << ", " << count_text(static_cast<std::int64_t>(merged.snapshots.size()), "snapshot");
  std::cout << '\n';
}

}  // namespace

int clogsweep_merge(int argc, const char* const* argv) {
  cli::CommandLine line("clogsweep merge", merge_usage);
  line.words("file", "sweep files").option("output", "HDF5 file to make");
  if (!parse_file_command(line, argc, argv)) return console::exit_success;
  const std::vector<std::string> paths = line.require_all("file", 2);
  const std::string output = line.require("output");
  store::refuse_existing(output);
  const results::MergedSweep merged = results::merge(paths, origin_of_table(line));
  results::write(merged.table, merged.snapshots, output);
  print_merged(output, paths, merged);
  if (const auto& keys = merged.differing_numerics; !keys.empty())
    console::say(
        fmt::format("clogsweep merge: no parameter set is in two of the files, because they differ in {}; "
                    "clogfit does not join their runs",
                    joined(keys)));
  return console::exit_success;
}

}  // namespace clog::programs
