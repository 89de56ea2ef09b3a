#include "file_command.hpp"

#include <string>

#include "clog/cli/program.hpp"
#include "clog/core/tools/error.hpp"

namespace clog::programs {

namespace po = boost::program_options;

cli::CommandLine file_command(const char* name, const char* usage) {
  cli::CommandLine line(std::string("clogsweep ") + name, usage, cli::CommandLine::SweepKeys::none);
  line.add_options()("file", po::value<std::string>(), "sweep file");
  line.add_positional("file", 1);
  return line;
}

bool parse_file_command(cli::CommandLine& line, int argc, const char* const* argv) {
  line.parse(argc - 1, argv + 1);
  if (cli::answer_help_or_version(line, {{"HDF5", store::library_version()}})) return false;
  if (!line.has("file")) throw Error("missing sweep file; try " + line.program() + " sweep.h5");
  return true;
}

store::Provenance origin_of_table(const cli::CommandLine& line) {
  store::Provenance all = cli::origin(line);
  all.emplace_back("hdf5_version", store::library_version());
  return all;
}

}  // namespace clog::programs
