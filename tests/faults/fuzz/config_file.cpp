/// Fuzz target that reads a config file, as --config does.

#include "clog/cli/command_line.hpp"
#include "fuzz.hpp"
#include "memory_file.hpp"

using namespace clog;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file({data, size});
  const std::string option = "--config=" + file.path();
  const char* const words[] = {"fuzz", option.c_str()};
  may_be_refused(
      [&] { cli::CommandLine("fuzz", "", cli::CommandLine::SweepKeys::accepted).parse(2, words); });
  return 0;
}
