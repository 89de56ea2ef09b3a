#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clog/core/run/droplet_run.hpp"
#include "clog/single_run/preview.hpp"
#include "clog/store/trajectory_file.hpp"

namespace clog::single_run {

/// Follows one droplet to its end, or to a signal, and records samples.
class RecordedRun {
 public:
  /// Intervals between samples and between polygons, in checks of the run (0: no polygons).
  struct Intervals {
    std::int64_t samples = 1;
    std::int64_t polygons = 0;
  };
  /// @param samples, polygons  intervals [t0]; if `polygons` is missing, no polygons are kept
  static Intervals every(double samples, std::optional<double> polygons, double time_step);

  RecordedRun(DropletRun run, Intervals intervals);

  /// @param is_over  ends the run early if it returns true; the run is then interrupted
  void follow(const std::function<bool(const DropletRun&)>& is_over = {});
  /// Advances the run by a short piece, to measure the cost of a step. The run must not be used afterwards.
  MostCost measure_cost();

  const DropletRun& run() const { return run_; }
  /// The run's result; its status is `interrupted` if a signal ended it.
  RunResult result() const;
  /// A trajectory: samples, polygons, the obstacles near the polygons, and a row that contains the results.
  /// @param row  a row with the columns of parameters, see sweep::describe()
  /// @param origin  origin of the trajectory
  store::Trajectory trajectory(sweep::RunRow row, store::Provenance origin) const;
  /// Prints two lines about the run's end. Returns the exit code.
  int report() const;

 private:
  struct Column {
    store::TrajectoryColumn data;
    std::function<double(const DropletRun&)> measure;
  };
  DropletRun run_;
  Intervals intervals_;
  std::vector<Column> columns_;
  std::vector<store::PolygonFrame> polygons_;
  bool interrupted_ = false;
  double seconds_ = 0, processor_seconds_ = 0;

  void add_column(std::string name, std::string meaning, std::function<double(const DropletRun&)> measure) {
    columns_.push_back({{std::move(name), std::move(meaning), {}}, std::move(measure)});
  }
  void add_common_columns();
  void add_columns_of_channel();
  void take_sample();
  void take_polygon();
};

}  // namespace clog::single_run
