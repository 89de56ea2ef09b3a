#pragma once

#include <string>
#include <vector>

#include "clog/console/signals.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/fit/calibration.hpp"
#include "clog/laboratory/profile_file.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::laboratory {

/// A measured passage through a channel.
struct Trial {
  std::string file;
  fit::Profile frames;
  bool is_of_laboratory = true;  ///< a CSV file, which does not say through which channel it was
};
/// @param scales  of files in laboratory units
/// @throws Error naming file and line, or if a simulated passage was through another channel, or at another
/// speed, than is to be simulated
std::vector<Trial> read_trials(const std::vector<std::string>& files, const ProfileScales& scales,
                               const RunParameters& simulated);

/// Line tension and near-wall drag of each trial, all side by side; how far they are is told on the standard
/// error.
/// @param settings  of the simulated droplet in its channel, these two excepted
/// @throws console::Stopped after a signal, with the best so far
std::vector<fit::Calibration> calibrate(const std::vector<Trial>& trials, const sweep::Settings& settings);

/// Warnings about a trial's numbers.
std::vector<std::string> warnings(const fit::Calibration& found);

}  // namespace clog::laboratory
