#pragma once

#include <string>

#include "clog/sweep/settings.hpp"

namespace clog::sweep {

/// Checks of settings of which each word has one value, before any parameter set is made of them.

/// A key that another one leaves without effect was given for nothing. @throws Error
void refuse_contradictions(const Settings& settings);
/// Keys that a scene leaves without effect, beyond those that check_each() knows. @throws Error
void refuse_useless_keys(const Settings& settings);
/// A question about a list that could be a decimal below one; empty for any other.
std::string possible_decimal(const Key& key, const Settings& settings);

}  // namespace clog::sweep
