#pragma once

namespace clog::console {

inline constexpr int exit_success = 0;
/// A fault of the program. Also what verify, replay and doctor return when they find damage, other bits, or
/// something to fix.
inline constexpr int exit_internal_fault = 1;
inline constexpr int exit_user_fault = 2;
/// Stopped before the end; the same command makes sense again.
inline constexpr int exit_incomplete = 75;
/// The reader of the output went away before its end: what a shell shows for programs that SIGPIPE has ended.
inline constexpr int exit_reader_gone = 141;

}  // namespace clog::console
