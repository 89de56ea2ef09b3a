#pragma once

namespace clog::console {

inline constexpr int exit_success = 0;
/// The program failed, or verify found damage, replay found different bits, or doctor found a problem.
inline constexpr int exit_internal_fault = 1;
inline constexpr int exit_user_fault = 2;
/// Stopped before the end; repeating the command resumes.
inline constexpr int exit_incomplete = 75;
/// The reader of the output closed it early: the code that a shell reports after SIGPIPE.
inline constexpr int exit_reader_gone = 141;

}  // namespace clog::console
