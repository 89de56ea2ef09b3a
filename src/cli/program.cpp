#include "clog/cli/program.hpp"

#include <csignal>
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

}  // namespace

int run_program(const std::string& program, const std::function<int()>& body) {
  try {
    return body();
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

std::string version_text(const std::string& program,
                         const std::vector<std::pair<std::string, std::string>>& libraries) {
  const BuildInfo build = build_info();
  std::string text = program + " " + build.version + " (git " + build.git_hash + ")\ncompiler: " + build.compiler + ", " +
                     build.build_type + "\n";
  for (const auto& [name, version] : libraries) text += name + ": " + version + "\n";
  return text;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

void catch_stop_signals() {
  std::signal(SIGINT, raise_stop_flag);
  std::signal(SIGTERM, raise_stop_flag);
}

bool stop_signalled() { return stop_flag != 0; }

}  // namespace clog::cli
