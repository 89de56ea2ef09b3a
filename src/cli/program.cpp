#include "clog/cli/program.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <string_view>

#include "clog/console/build_info.hpp"
#include "clog/console/clock.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/signals.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/memory.hpp"

namespace clog::cli {

using namespace console;

namespace {

/// Memory that the libraries need before any work starts. With 8 MB some libraries crashed.
constexpr std::size_t least_memory = 32'000'000;

}  // namespace

int run_program(const std::string& program, const std::function<int()>& body) {
  try {
    require_memory("start", least_memory);
    const int exit_code = body();
    flush_output();
    return exit_code;
  } catch (const Error& error) {
    say(program + ": " + error.what());
    return exit_user_fault;
  } catch (const Stopped& stop) {
    say(program + ": " + stop.what());
    return exit_incomplete;
  } catch (const std::ios_base::failure&) {  // printing to std::cout has failed
    if (is_reader_gone()) return exit_reader_gone;
    say(program + ": cannot write the output; the disk may be full");
    return exit_user_fault;
  } catch (const std::filesystem::filesystem_error& error) {
    say(fmt::format("{}: cannot use {} ({}); check the name and the permissions", program,
                    error.path1().string(), error.code().message()));
    return exit_user_fault;
  } catch (const std::bad_alloc&) {
    say(program + ": out of memory; a smaller box or more memory per rank helps");
    return exit_user_fault;
  } catch (const std::exception& error) {
    say(fmt::format("{}: internal fault: {}; please report it", program, error.what()));
    return exit_internal_fault;
  }
}

std::optional<int> run_command(const std::string& program, std::span<const Command> commands, int argc,
                               const char* const* argv) {
  const auto named = std::ranges::find_if(commands, [&](const Command& command) {
    return argc > 1 && std::string_view(argv[1]) == command.name;
  });
  if (named == commands.end()) return std::nullopt;
  return run_program(program + ' ' + named->name, [&] { return named->call(argc, argv); });
}

std::vector<std::string> names_of(std::span<const Command> commands) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.emplace_back(command.name);
  return names;
}

bool parse_command(CommandLine& line, int argc, const char* const* argv, const NamedTexts& libraries) {
  line.parse(argc, argv);
  if (line.has("help")) {
    std::cout << line.help();
    return false;
  }
  if (!line.has("version")) return true;
  const BuildInfo build = build_info();
  fmt::print(std::cout, "{} {} (git {})\ncompiler: {}, {}\n", line.program(), build.version,
             build.git_describe, build.compiler, build.build_type);
  for (const auto& [name, version] : libraries) fmt::print(std::cout, "{}: {}\n", name, version);
  return false;
}

NamedTexts origin(const CommandLine& line) {
  const BuildInfo build = build_info();
  return {{"program", line.program()},          {"version", build.version},
          {"git_describe", build.git_describe}, {"git_hash", build.git_hash},
          {"compiler", build.compiler},         {"config", line.settings().to_config()},
          {"command_line", line.text()},        {"start_time", utc_now()}};
}

}  // namespace clog::cli
