#include "clog/cli/program.hpp"

#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <iostream>
#include <new>

#include "clog/cli/build_info.hpp"
#include "clog/core/error.hpp"

namespace clog::cli {
namespace {

volatile std::sig_atomic_t stop_flag = 0;  // the one thing a signal handler may write to

void raise_stop_flag(int) { stop_flag = 1; }

/// ISO 8601.
std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

}  // namespace

int run_program(const std::string& program, const std::function<int()>& body) {
  try {
    const int exit_code = body();
    std::cout.flush();
    if (!std::cout || std::fflush(stdout) != 0) throw Error("cannot write the output; the disk may be full");
    return exit_code;
  } catch (const Error& error) {
    std::cerr << program << ": " << error.what() << std::endl;
    return exit_user_fault;
  } catch (const std::bad_alloc&) {
    std::cerr << program << ": out of memory; a smaller box or more memory per rank helps" << std::endl;
    return exit_user_fault;
  } catch (const std::exception& error) {
    std::cerr << program << ": internal fault: " << error.what() << "; please report it" << std::endl;
    return exit_internal_fault;
  }
}

bool answer_help_or_version(const CommandLine& line, const NamedTexts& libraries) {
  if (line.has("help")) {
    std::cout << line.help();
    return true;
  }
  if (!line.has("version")) return false;
  const BuildInfo build = build_info();
  std::cout << line.program() << ' ' << build.version << " (git " << build.git_hash
            << ")\ncompiler: " << build.compiler << ", " << build.build_type << '\n';
  for (const auto& [name, version] : libraries) std::cout << name << ": " << version << '\n';
  return true;
}

NamedTexts origin(const CommandLine& line) {
  const BuildInfo build = build_info();
  return {{"program", line.program()},
          {"version", build.version},
          {"git_hash", build.git_hash},
          {"compiler", build.compiler},
          {"config", line.settings().to_config(false)},
          {"command_line", line.text()},
          {"start_time", utc_now()}};
}

void catch_stop_signals() {
  std::signal(SIGINT, raise_stop_flag);
  std::signal(SIGTERM, raise_stop_flag);
  std::signal(SIGUSR1, raise_stop_flag);
}

bool stop_signalled() { return stop_flag != 0; }

}  // namespace clog::cli
