#include "sweep_input.hpp"

#include <iostream>

namespace clog {

store::SweepFile read_with_caution(const std::string& path) {
  store::SweepFile file = store::read_sweep(path);
  if (const std::string words = store::caution(path, file); !words.empty()) std::cerr << words << std::endl;
  return file;
}

}  // namespace clog
