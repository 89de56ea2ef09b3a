/// clogrun: follows one droplet.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/cli/python_command.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clogrun_commands.hpp"
#include "file_command.hpp"
#include "laboratory_option.hpp"

namespace {

using namespace clog;
using namespace clog::programs;

constexpr const char* clogrun_usage = R"(clogrun follows one droplet and records its motion.

  clogrun array --output run.h5 line-tension=0.3 obstacle-gap=0.35 seeds=7
  clogrun array --output run.h5 obstacles=mine.csv box=60 --polygon-interval 1
  clogrun channel --output run.h5 orifice=0.7 line-tension=1.08 near-wall-drag=0.07 terminal-speed=0.032
  clogrun array --output run.h5 line-tension=0.3 max-time=3000 --polygon-interval 5 --frames film
  clogrun replay sweep.h5 12 --output run.h5 --polygon-interval 1     replays a run of a sweep
  clogrun replay sweep.h5 12 --droplet 01 --output run.h5             the same for one of its daughters
  clogrun sag line-tension=0.1,0.3,1          prints how far the droplet sinks on a flat wall

clogrun array with the keys and the seed of a row of a sweep repeats the run of this row, bit for bit.
)";

bool is_film(const std::filesystem::path& name) {
  return name.extension() == ".mp4" || name.extension() == ".gif";
}

/// Declares the options and parses them. Returns whether there is anything else to do.
bool parse_options(cli::CommandLine& line, int argc, char** argv) {
  line.word("system", "array, channel (two wedges), sag (flat wall) or replay");
  if (argc > 1 && std::string_view(argv[1]) == "replay")
    line.word("file", "replay: file of clogsweep").word("task", "replay: the row's number, column `task`");
  else
    line.option("file", "replay: file of clogsweep")
        .option("task", "replay: the row's number, column `task`");
  line.flag(
          "to-rest",
          "replay: continue until the droplet rests; otherwise the run ends as soon as it is proved that the "
          "droplet will come to rest")
      .option("droplet",
              "replay: path of a daughter, as in the table of droplets; the file's lengths and times are in "
              "units of this\ndaughter; its diameter and birth are attributes of the file")
      .option("output", "HDF5 file to create")
      .option("lab",
              "file that describes the laboratory, see clogfit units; determines terminal-speed and "
              "line-tension or\nwall-stiffness unless these keys are set; clogrun then prints distance and "
              "time in mm and s, too")
      .option("seed", "short for seeds=N")
      .option("sample-interval", "time between samples [t0]", "1")
      .option("polygon-interval", "also write the polygon, at this interval [t0]")
      .option("frames",
              "also make a film of the polygons; give the film's name, which may end in .mp4 or .gif")
      .option("most-frames",
              "largest number of frames of the film (600); the film of a longer run skips frames, or shows "
              "only the end if the droplet would move too far between frames")
      .flag("dry-run", "print the config and an upper bound of the run's duration, run nothing")
      .option("write-obstacles", "array, replay: write the obstacles as a CSV file");
  line.add_commands({"array", "channel", "sag", "replay"});
  line.settings().set("seeds", "1");
  if (!parse_file_command(line, argc, argv)) return false;
  if (line.has("seed") && line.has("seeds"))
    throw Error("--seed and --seeds contradict each other; give one of them");
  if (line.has("seed")) line.settings().set("seeds", line.get("seed"));
  use_laboratory(line);
  return true;
}

/// Files that an option may write. For a film without a suffix, there are two possible files.
std::vector<std::filesystem::path> files_of(const cli::CommandLine& line, const std::string& option) {
  if (!line.has(option)) return {};
  const std::filesystem::path name = line.get(option);
  if (option != "frames" || is_film(name)) return {name};
  return {name.string() + ".mp4", name.string() + ".gif"};
}

/// Refuses options that name the same file. One file would replace the other, and the user would notice this
/// only after the run.
void refuse_same_files(const cli::CommandLine& line) {
  std::map<std::filesystem::path, std::string> options;
  for (const std::string option : {"output", "write-obstacles", "frames"})
    for (const std::filesystem::path& file : files_of(line, option)) {
      const auto [first, is_new] =
          options.emplace(std::filesystem::weakly_canonical(std::filesystem::absolute(file)), option);
      if (!is_new)
        throw Error(fmt::format("--{} and --{} name the same file, {}; give two names", first->second, option,
                                file.string()));
    }
}

/// Name of the film, for the Python module. @throws Error if the film cannot be written
std::filesystem::path film_name(const cli::CommandLine& line) {
  std::filesystem::path name = line.get("frames");
  if (!line.has("polygon-interval"))
    throw Error(
        "--frames has nothing to show without --polygon-interval; give the time between frames [t0], e.g. "
        "--polygon-interval 5");
  if (!name.has_filename())
    throw Error("invalid --frames=" + name.string() + " (names no file); try --frames film");
  if (name.has_parent_path() && !std::filesystem::is_directory(name.parent_path()))
    throw Error(fmt::format("cannot write {} (no folder {}); make it first", name.string(),
                            name.parent_path().string()));
  for (const std::filesystem::path& film : files_of(line, "frames")) store::refuse_unwritable(film);
  if (name.extension() == ".mp4" && !cli::is_installed("ffmpeg"))
    throw Error(fmt::format("cannot write {} (no ffmpeg); install it, or ask for {}", name.string(),
                            std::filesystem::path(name).replace_extension(".gif").string()));
  return name;
}

/// Options with which the Python module draws the film. @throws Error if the film cannot be written
std::vector<std::string> film_options(const cli::CommandLine& line) {
  std::vector<std::string> options = {"droplet", line.get("output"), "--output=" + film_name(line).string(),
                                      "--film"};
  if (line.has("most-frames"))
    options.push_back(fmt::format("--most-frames={:.0f}",
                                  std::clamp(std::round(line.get_positive("most-frames")), 1.0, 1e9)));
  return options;
}

/// The systems in which a run can be written to a file and filmed.
const std::map<std::string, int (*)(cli::CommandLine&)>& followed_systems() {
  static const std::map<std::string, int (*)(cli::CommandLine&)> systems = {
      {"array", clogrun_array}, {"channel", clogrun_channel}, {"replay", clogrun_replay}};
  return systems;
}

int run_system(cli::CommandLine& line, const std::string& system) {
  line.require("output");
  const auto run = followed_systems().at(system);
  if (!line.has("frames")) {
    refuse_options(line, system + " without --frames", {"most-frames"});
    return run(line);
  }
  const std::vector<std::string> options = film_options(line);
  const std::filesystem::path module = cli::find_python_module();
  const int exit_code = run(line);
  if (exit_code == console::exit_incomplete)
    console::say(fmt::format("clogrun: stopped before its end, so no film is drawn; {} draws what there is",
                             cli::python_command(module, options)));
  if (exit_code != console::exit_success || line.has("dry-run")) return exit_code;
  cli::become_python("clogrun", module, options);
}

int clogrun(int argc, char** argv) {
  cli::CommandLine line("clogrun", clogrun_usage, cli::CommandLine::SweepKeys::accepted);
  if (!parse_options(line, argc, argv)) return console::exit_success;
  refuse_same_files(line);
  const std::string system = line.has("system") ? line.get("system") : "";
  if (system != "replay") refuse_options(line, system, {"file", "task", "to-rest", "droplet"});
  if (system == "channel") choose_layout(line, "channel");
  if (system == "sag") choose_layout(line, "wall");
  if (followed_systems().contains(system))
    return with_typed_units(line, [&] { return run_system(line, system); });
  if (system == "sag") return with_typed_units(line, [&] { return clogrun_sag(line); });
  throw Error((system.empty() ? "missing system" : "unknown system '" + system + "'") +
              "; try clogrun array, clogrun channel, clogrun sag or clogrun replay");
}

}  // namespace

int main(int argc, char** argv) {
  console::prepare_streams();
  return cli::run_program("clogrun", [&] { return clogrun(argc, argv); });
}
