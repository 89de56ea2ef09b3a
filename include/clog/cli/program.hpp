#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace clog::cli {

inline constexpr int exit_success = 0;
inline constexpr int exit_internal_fault = 1;
inline constexpr int exit_user_fault = 2;
/// Stopped before the end; the same command makes sense again.
inline constexpr int exit_incomplete = 75;

/// Runs a program's body; an Error becomes one line on the error stream and exit code 2.
int run_program(const std::string& program, const std::function<int()>& body);

/// Text of --version: version, git hash, compiler, and the given libraries.
std::string version_text(const std::string& program, const std::vector<std::pair<std::string, std::string>>& libraries);

/// Present time, UTC, ISO 8601.
std::string utc_now();

/// From now on SIGINT and SIGTERM only raise a flag.
void catch_stop_signals();
bool stop_signalled();

}  // namespace clog::cli
