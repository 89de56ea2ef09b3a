#pragma once

#include <span>
#include <string>
#include <vector>

#include "clog/campaign/curves.hpp"

namespace clog::campaign {

/// Peak, crossings, and some places of every curve, for people.
std::string curves_to_text(const std::vector<FittedCurve>& curves, std::span<const Group> groups,
                           const CurveQuestion& question);
/// A line for every place of every curve.
std::string curves_to_csv(const std::vector<FittedCurve>& curves, const CurveQuestion& question);
/// All that is known of every curve, and the points that it goes through.
std::string curves_to_json(const std::vector<FittedCurve>& curves, std::span<const Group> groups,
                           const CurveQuestion& question);

}  // namespace clog::campaign
