#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "clog/store/run_table.hpp"
#include "clog/sweep/run_row.hpp"

namespace clog::results {

/// Finds the events of a sweep by reading its file repeatedly. An event is one line of JSON: a start, an end
/// or an interruption of a task, a new attempt, or a new round. A task that starts and ends between two reads
/// gets two lines.
class Events {
 public:
  /// @param path  path of the file, for messages
  explicit Events(std::string path) : path_(std::move(path)) {}

  /// Returns the events since the last call. The first call returns only the numbers of all runs and of
  /// finished runs.
  /// @throws Error as stored_plan()
  std::vector<std::string> look(const store::SweepFile& file);
  /// The last line, after the sweep has ended.
  std::string end() const;

 private:
  struct Known {
    RunStatus status;
    std::int64_t attempt;
  };

  std::string path_;
  bool has_looked_ = false;
  std::string config_;
  std::string num_wanted_;
  std::int64_t num_runs_ = 0;
  std::int64_t num_finished_ = 0;
  std::map<std::int64_t, Known> known_;
  std::vector<std::string> columns_;  // columns that appear in events, see listed_columns()

  bool count_runs(const store::SweepFile& file);
  std::vector<std::string> of_row(const sweep::RunRow& row) const;
};

}  // namespace clog::results
