#include "sweep_input.hpp"

#include "clog/cli/program.hpp"

namespace clog {

store::SweepFile read_with_caution(const std::string& path) {
  store::SweepFile file = store::read_sweep(path);
  if (const std::string words = store::caution(path, file); !words.empty()) cli::say(words);
  return file;
}

}  // namespace clog
