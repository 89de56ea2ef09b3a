#pragma once

#include <initializer_list>
#include <utility>

#include "clog/sweep/settings.hpp"

namespace clog::sweep {

inline Settings settings_of(std::initializer_list<std::pair<const char*, const char*>> texts) {
  Settings settings;
  for (const auto& [name, text] : texts) settings.set(name, text);
  return settings;
}

}  // namespace clog::sweep
