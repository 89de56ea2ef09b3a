#pragma once

namespace clog::console {

inline constexpr int exit_success = 0;
/// The program failed, or verify found damage, or replay computed different bits, or doctor found a problem.
inline constexpr int exit_internal_fault = 1;
inline constexpr int exit_user_fault = 2;
/// The program was stopped before the end; the same command resumes its work.
inline constexpr int exit_incomplete = 75;
/// The reader of the output closed it early. A shell reports the same code for a program that SIGPIPE ended.
inline constexpr int exit_reader_gone = 141;

}  // namespace clog::console
