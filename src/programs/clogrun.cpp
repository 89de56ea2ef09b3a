/// clogrun: one droplet, watched closely.

#include <string>

#include "channel_options.hpp"
#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/core/error.hpp"
#include "watched_run.hpp"

namespace {

using namespace clog;

constexpr const char* program = "clogrun";
constexpr const char* usage = R"(clogrun follows one droplet and writes what happens to it.

  clogrun array --output run.h5 line-tension=0.3 obstacle-gap=0.35 seeds=7
  clogrun array --output run.h5 --obstacles mine.csv box=60 --polygon-interval 1
  clogrun channel --output run.h5 --orifice 0.7 line-tension=1.08 near-wall-drag=0.07 terminal-speed=0.032
  clogrun sag line-tension=0.1,0.3,1          prints how far the droplet sinks onto a flat wall

In an array, the same keys and seed as a row of a sweep give that row's run, bit for bit.
)";

cli::CommandLine parse(int argc, char** argv) {
  namespace po = boost::program_options;
  cli::CommandLine line(program, usage, cli::CommandLine::SweepKeys::accepted);
  const auto text = [] { return po::value<std::string>(); };
  line.add_options()("system", text(), "array, channel (two wedges) or sag (flat wall)")(
      "output", text(), "HDF5 file to make")("seed", text(), "short for seeds=N")(
      "sample-interval", text()->default_value("1"), "time between samples [t0]")(
      "polygon-interval", text(), "also write the polygon this often [t0]")(
      "obstacles", text(), "array: CSV file x,y[,diameter] to use; the droplet starts near (box/2, box/2)")(
      "write-obstacles", text(), "array: write the obstacles as a CSV file")(
      "start", text(), "channel: h at release [sigma] (-10)")("end", text(),
                                                              "channel: h at the end [sigma] (3)");
  add_channel_options(line);
  line.add_positional("system", 1);
  line.settings().set("seeds", "1");
  line.parse(argc, argv);
  if (line.has("seed") && line.has("seeds"))
    throw Error("--seed and --seeds contradict each other; give one of them");
  if (line.has("seed")) line.settings().set("seeds", line.get("seed"));
  return line;
}

int body(int argc, char** argv) {
  cli::CommandLine line = parse(argc, argv);
  if (cli::answer_help_or_version(line, {{"HDF5", store::library_version()}})) return cli::exit_success;
  const std::string system = line.has("system") ? line.get("system") : "";
  if (system == "array") return clogrun_array(line);
  if (system == "channel") return clogrun_channel(line);
  if (system == "sag") return clogrun_sag(line);
  throw Error((system.empty() ? "missing system" : "unknown system '" + system + "'") +
              "; try clogrun array, clogrun channel or clogrun sag");
}

}  // namespace

int main(int argc, char** argv) {
  return clog::cli::run_program(program, [&] { return body(argc, argv); });
}
