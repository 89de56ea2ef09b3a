#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/core/droplet_run.hpp"
#include "clog/store/trajectory_file.hpp"
#include "clog/sweep/plan.hpp"
#include "run_preview.hpp"

namespace clog {

/// Follows one droplet to its end, or to a signal, and keeps samples of it on the way.
class WatchedRun {
 public:
  /// How often, in checks of the run (0: no polygons).
  struct Intervals {
    std::int64_t samples = 1;
    std::int64_t polygons = 0;
  };
  /// From --sample-interval and --polygon-interval. @throws Error
  static Intervals intervals(const cli::CommandLine& line, double time_step);

  WatchedRun(DropletRun run, Intervals intervals);

  /// A column of the table beside those that every run has.
  template <class Value>
  void add_column(std::string name, std::string meaning, Value value) {
    columns_.push_back({{std::move(name), std::move(meaning), {}}, value});
  }
  void follow();
  /// Advances the run by a short piece, to see what a step costs. The run is good for nothing else then.
  MostCost measure_cost();

  const DropletRun& run() const { return run_; }
  /// Of the run; `interrupted` if a signal ended it.
  RunResult result() const;
  /// Samples, polygons, the obstacles near them, and the row's columns of what came out.
  /// @param row  the columns of what was run, see sweep::describe()
  store::Trajectory trajectory(sweep::RunRow row, const cli::CommandLine& line) const;
  /// Two lines on how it ended. Returns the exit code.
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
  double seconds_ = 0;

  void add_common_columns();
  void take_sample();
  void take_polygon();
};

/// The systems of clogrun. Each reads its options, runs, writes, and returns the exit code.
int clogrun_array(cli::CommandLine& line);
int clogrun_channel(cli::CommandLine& line);
int clogrun_sag(cli::CommandLine& line);
int clogrun_replay(cli::CommandLine& line);

/// Keys and options that describe an obstacle array.
inline constexpr std::initializer_list<const char*> array_options = {"obstacle-gap",
                                                                     "obstacle-diameter",
                                                                     "obstacle-diameter-spread",
                                                                     "obstacle-density",
                                                                     "obstacle-layout",
                                                                     "lattice-angle",
                                                                     "seeds",
                                                                     "seed",
                                                                     "box",
                                                                     "boxes",
                                                                     "obstacles",
                                                                     "write-obstacles"};
/// On the standard error, what of the runs was not proved sound; nothing if all of it was.
void say_what_is_unproven(const sweep::Plan& plan);
/// The row of a run that meets no array, or a user's own.
sweep::RunRow row_of_scene(RunParameters run, ObstacleLayout layout);

/// @throws Error if one of these options was given, which have no meaning for the system
void refuse_options(const cli::CommandLine& line, const std::string& system,
                    std::initializer_list<const char*> options);

}  // namespace clog
