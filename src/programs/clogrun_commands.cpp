#include "clogrun_commands.hpp"

#include <fmt/core.h>

#include <optional>

#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/row_limits.hpp"

namespace clog::programs {

void refuse_options(const cli::CommandLine& line, const std::string& system,
                    std::initializer_list<const char*> options) {
  for (const char* option : options)
    if (line.has(option))
      throw Error(fmt::format("--{} has no meaning for clogrun {}; leave it out", option, system));
}

watch::WatchedRun::Intervals intervals(const cli::CommandLine& line, double time_step) {
  std::optional<double> polygons;
  if (line.has("polygon-interval")) polygons = line.get_positive("polygon-interval");
  return watch::WatchedRun::every(line.get_positive("sample-interval"), polygons, time_step);
}

void say_what_is_unproven(const sweep::Plan& plan) {
  if (const std::string words = sweep::unproven_parameters(plan); !words.empty()) console::say(words);
}

void choose_layout(cli::CommandLine& line, const std::string& layout) {
  const std::string key = "obstacle-layout";
  if (line.has(key) && line.get(key) != layout)
    throw Error(fmt::format("clogrun {} means {}={}, not {}; leave it out", line.get("system"), key, layout,
                            line.get(key)));
  line.settings().set(key, layout);
}

}  // namespace clog::programs
