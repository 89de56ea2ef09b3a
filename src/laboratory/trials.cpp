#include "clog/laboratory/trials.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <semaphore>
#include <thread>
#include <utility>

#include "clog/campaign/stored_sweep.hpp"
#include "clog/console/signals.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/scene/channel.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/laboratory/progress.hpp"
#include "clog/sweep/single_run.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::laboratory {
namespace {

/// One of the machine's cores, as long as it lives. Waits until one is free.
class UseOfCore {
 public:
  UseOfCore() { cores().acquire(); }
  UseOfCore(UseOfCore&&) = delete;
  ~UseOfCore() { cores().release(); }

 private:
  static std::counting_semaphore<>& cores() {
    static std::counting_semaphore<> free(std::max(1u, std::thread::hardware_concurrency()));
    return free;
  }
};

/// The simulated droplet's way past the frames.
class ChannelSimulation {
 public:
  ChannelSimulation(sweep::Settings settings, const fit::Profile& measured) : settings_(std::move(settings)) {
    const auto [first, last] = std::minmax_element(
        measured.begin(), measured.end(), [](const fit::Frame& a, const fit::Frame& b) { return a.h < b.h; });
    const RunParameters usual = sweep::single_run(settings_);
    // Motion is overdamped: half a diameter before the first frame the start is forgotten. The droplet must
    // not touch the channel at the start.
    const double start = std::min({first->h - 0.5, -2.0, last_free_start(usual) - 0.1});
    const double end = last->h + 0.1;
    settings_.set("start", sweep::shortest(start));
    settings_.set("end", sweep::shortest(end));
    settings_.set("max-time", sweep::shortest(30 * (end - start) / usual.drag.terminal_speed));
  }

  /// Called from several threads at a time; as many compute as there are cores.
  /// @throws console::Stopped after a signal
  fit::Profile operator()(double line_tension, double near_wall_drag) const {
    const UseOfCore core;
    sweep::Settings settings = settings_;
    settings.set("line-tension", sweep::shortest(line_tension));
    settings.set("near-wall-drag", sweep::shortest(near_wall_drag));
    const RunParameters parameters = sweep::single_run(settings);
    DropletRun run(parameters);
    fit::Profile profile;
    bool is_over = false;
    while (!is_over) {
      if (console::stop_signalled()) throw console::Stopped("stopped by a signal");
      profile.push_back({parameters.channel.start + run.displacement()[0],
                         run.droplet().centre_velocity()[0] / parameters.drag.terminal_speed,
                         run.droplet().shape().shape_parameter()});
      is_over = run.advance(1);
    }
    return profile;  // of a droplet that breaks, as far as it came
  }

 private:
  sweep::Settings settings_;
};

/// @throws Error if a simulated passage was through another channel, or at another speed, than is to be
/// simulated
void refuse_other_channel(const std::string& file, const store::Provenance& origin,
                          const RunParameters& simulated) {
  const auto compare = [&](const std::string& option, double stored, double given) {
    if (stored != given)
      throw Error(fmt::format("{0} was written with {1}={2}, not {3}; give {1}={2}", file, option,
                              sweep::shortest(stored), sweep::shortest(given)));
  };
  compare("orifice", sweep::to_number(campaign::attribute(origin, "orifice")), simulated.channel.orifice);
  compare("wedge-angle", sweep::to_number(campaign::attribute(origin, "wedge_angle")),
          simulated.channel.wedge_angle);
  compare("tip-radius", sweep::to_number(campaign::attribute(origin, "tip_radius")),
          simulated.channel.tip_radius);
  compare("terminal-speed", sweep::single_run(campaign::stored_settings(file, origin)).drag.terminal_speed,
          simulated.drag.terminal_speed);
}

}  // namespace

std::vector<Trial> read_trials(const std::vector<std::string>& files, const ProfileScales& scales,
                               const RunParameters& simulated) {
  std::vector<Trial> trials;
  for (const std::string& file : files) {
    MeasuredProfile measured = read_measured_profile(file, scales);
    if (!measured.origin.empty()) refuse_other_channel(file, measured.origin, simulated);
    trials.push_back({file, std::move(measured.frames), measured.origin.empty()});
  }
  return trials;
}

std::vector<fit::Calibration> calibrate(const std::vector<Trial>& trials, const sweep::Settings& settings) {
  CalibrationProgress progress(trials.size());
  const auto calibrate_one = [&](std::size_t trial) {
    const fit::Profile& profile = trials[trial].frames;
    fit::Calibration found =
        fit::calibrate(profile, ChannelSimulation(settings, profile), {},
                       [&](const fit::CalibrationAttempt& attempt) { progress.tried(trial, attempt); });
    progress.ended();
    return found;
  };
  std::vector<std::future<fit::Calibration>> running;
  for (std::size_t trial = 0; trial < trials.size(); ++trial)
    running.push_back(std::async(std::launch::async, calibrate_one, trial));
  std::vector<fit::Calibration> found;
  try {
    for (auto& trial : running) found.push_back(trial.get());
  } catch (const console::Stopped& stop) {
    for (auto& trial : running)
      if (trial.valid()) trial.wait();
    progress.finish();
    std::string words = stop.what();
    for (std::size_t trial = 0; trial < trials.size(); ++trial)
      words += fmt::format("; {}: {}", trials[trial].file, progress.best(trial));
    throw console::Stopped(words);
  }
  progress.finish();
  return found;
}

namespace {

/// Independent noise exceeds it once in seven hundred trials.
double largest_correlation_of_noise(const fit::Calibration& found) { return 3 / std::sqrt(found.num_frames); }

/// The best run's residuals are no noise: something else than Gamma and b_0 differs.
void append_shape_of_residuals(const fit::Calibration& found, std::vector<std::string>& all) {
  constexpr double mesh = 0.01;  // runs without noise differ by less, smoothly, in speed and in shape
  const double largest = largest_correlation_of_noise(found);
  const auto is_systematic = [&](double correlation, double deviation) {
    return correlation > largest && deviation > mesh;
  };
  const bool is_speed = is_systematic(found.correlation.speed, found.deviation.speed);
  const bool is_shape = is_systematic(found.correlation.shape, found.deviation.shape);
  if (!is_speed && !is_shape) return;
  all.push_back(fmt::format(
      "the {} of successive frames differ alike from the best run (correlation {:.2f}; noise of {} frames "
      "stays "
      "below {:.2f}): no Gamma and b_0 explain this profile, and errors are too small; look at V_t "
      "(terminal-speed, or --speed and --angle) first, then at orifice, wedge-angle and units",
      is_speed ? "speeds" : "shapes", is_speed ? found.correlation.speed : found.correlation.shape,
      found.num_frames, largest));
}

}  // namespace

std::vector<std::string> warnings(const fit::Calibration& found) {
  std::vector<std::string> all;
  if (!found.is_converged)
    all.emplace_back("the search did not converge: another place may have a smaller Delta_v");
  if (found.is_at_bound) all.emplace_back("the best is at the end of what was searched, and may lie beyond");
  if (found.num_never_reached > 0)
    all.push_back(fmt::format(
        "no simulated droplet comes to {} of the frames: look at --orifice, at the units and at h",
        found.num_never_reached));
  if (std::isnan(found.line_tension_error))
    all.emplace_back(
        "no errors: the frames do not determine both, or the droplet clogs at a line tension beside this "
        "one");
  constexpr double good = 0.2;  // speeds that agree within a fifth
  if (found.deviation.speed > good)
    all.emplace_back(
        "Delta_v is large: no simulated droplet moves like this one; look at --orifice, units, vertices");
  append_shape_of_residuals(found, all);
  constexpr double near = 1.1;
  if (found.clogging_tension < near * found.line_tension)
    all.push_back(fmt::format("close to a clog: simulated droplets of Gamma = {:.4g} and more do not pass",
                              found.clogging_tension));
  return all;
}

}  // namespace clog::laboratory
