#include "clog/cli/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>

#include "clog/cli/build_info.hpp"
#include "clog/cli/printable.hpp"
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

/// Has everybody left who could read the output?
bool is_reader_gone() {
  pollfd state{STDOUT_FILENO, POLLOUT, 0};
  return poll(&state, 1, 0) == 1 && (state.revents & (POLLERR | POLLHUP)) != 0;
}

}  // namespace

void prepare_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) < 0 && open("/dev/null", O_RDWR) != descriptor)
      std::_Exit(exit_user_fault);  // there may be nowhere to say why
  std::signal(SIGPIPE, SIG_IGN);
  std::cout.exceptions(std::ios_base::badbit);
  std::cerr.tie(nullptr);  // what is wrong is told, whether the output can be written or not
}

void say(const std::string& line) { std::cerr << printable(line) << std::endl; }

void flush_output() {
  std::cout.flush();
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw std::ios_base::failure("cannot print");
}

int run_program(const std::string& program, const std::function<int()>& body) {
  try {
    const int exit_code = body();
    flush_output();
    return exit_code;
  } catch (const Error& error) {
    say(program + ": " + error.what());
    return exit_user_fault;
  } catch (const Stopped& stop) {
    say(program + ": " + stop.what());
    return exit_incomplete;
  } catch (const std::ios_base::failure&) {  // of std::cout
    if (is_reader_gone()) return exit_reader_gone;
    say(program + ": cannot write the output; the disk may be full");
    return exit_user_fault;
  } catch (const std::filesystem::filesystem_error& error) {
    say(program + ": cannot use " + error.path1().string() + " (" + error.code().message() +
        "); check the name and the permissions");
    return exit_user_fault;
  } catch (const std::bad_alloc&) {
    say(program + ": out of memory; a smaller box or more memory per rank helps");
    return exit_user_fault;
  } catch (const std::exception& error) {
    say(program + ": internal fault: " + error.what() + "; please report it");
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
