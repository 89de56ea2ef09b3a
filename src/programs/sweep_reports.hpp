#pragma once

namespace clog {

/// `clogsweep status FILE`, `verify FILE`, `replay FILE TASK`: what they do is in their --help. They need
/// neither MPI nor the sweep's config, and never write. Each returns the program's exit code. @throws Error
int clogsweep_status(int argc, const char* const* argv);
int clogsweep_verify(int argc, const char* const* argv);
int clogsweep_salvage(int argc, const char* const* argv);
int clogsweep_replay(int argc, const char* const* argv);

}  // namespace clog
