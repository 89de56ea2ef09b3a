#pragma once

#include <string>
#include <string_view>

namespace clog {

/// The words in one line, separated by `between`. (fmt::join is not used, because g++ 12 with -O3 warns
/// wrongly of a write beyond an array.)
template <class Words>
std::string joined(const Words& words, std::string_view between = ", ") {
  std::string text;
  for (const std::string& word : words) {
    if (&word != &*words.begin()) text += between;
    text += word;
  }
  return text;
}

}  // namespace clog
