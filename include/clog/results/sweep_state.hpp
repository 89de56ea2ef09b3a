#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "clog/results/sweep_files.hpp"
#include "clog/results/sweep_runs.hpp"
#include "clog/sweep/messages.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::results {

/// The state of a sweep's runs, on rank 0 and in the files from which a stopped or killed sweep resumes.
/// Parameters and seed identify a run (sweep::identity); its task number does not.
class SweepState {
 public:
  /// Reads the files, and checks that they belong to this sweep.
  /// @param num_wanted  number of tasks at the start of the plan that are requested first (rounds may request
  /// more)
  /// @param attempts  number of attempts for a crashing run, over all sessions
  /// @throws Error if the file is not of a sweep, has another model version or other settings, or if another
  /// sweep is writing to it
  SweepState(std::string path, const sweep::Plan& plan, const sweep::Settings& settings,
             store::Provenance provenance, std::int64_t num_wanted, std::int64_t attempts);

  /// Requests more of the plan's tasks; tasks_left() then returns the unfinished ones.
  void want(const std::vector<std::int64_t>& tasks);
  std::int64_t num_wanted() const { return num_wanted_; }
  /// Tasks that have begun and are not over, whether they are requested or not.
  std::vector<std::int64_t> tasks_begun() const;

  /// Tasks that are requested, not over and to be computed.
  const std::vector<std::int64_t>& tasks_left() const { return tasks_left_; }
  /// Number of tasks that copy the result of one of tasks_left(), because they are the same run in another
  /// laboratory.
  std::int64_t num_waiting() const;
  /// Number of tasks_left() that resume from a snapshot.
  std::int64_t num_resumed() const;
  /// Number of runs in the file that are outside this plan; the file keeps them.
  std::int64_t num_beyond() const { return std::ssize(runs_.others); }
  /// Number of physically impossible rows; their runs are recomputed.
  std::int64_t num_faulty() const { return num_faulty_; }
  /// Number of damaged records of the journal. Runs of such records resume from an earlier record, or
  /// restart.
  std::int64_t num_unreadable() const { return files_.num_unreadable(); }

  /// Names the parts of the earlier file that could not be verified; empty if everything was verified.
  const std::string& caution() const { return files_.caution(); }

  /// Starts to record in the table how many of `num_ranks` ranks are busy (Activity).
  void watch_ranks(int num_ranks) { files_.watch_ranks(num_ranks); }
  /// A rank has ended its task, whatever the outcome.
  void rank_is_free() { files_.rank_is_free(); }
  sweep::Start start(std::int64_t task, int rank);
  /// Call this when a started task cannot use its snapshot and restarts from its release.
  void restarted(std::int64_t task);
  void report(const sweep::Report& report);
  /// Row of a run that has begun.
  const sweep::RunRow& row(std::int64_t task) const { return runs_.by_task.at(task)->row; }
  /// The first run that has begun, if all runs that have begun have failed; otherwise nullptr.
  const sweep::RunRow* first_if_all_failed() const;
  /// Discards a failure, so that the task runs again with the same attempt number.
  void withdraw_failure(std::int64_t task);
  bool tries_again(const sweep::RunRow& failed) const { return runs_.tries_again(failed); }
  /// Call this often. It starts to publish the table if a publication is due, or detects that a publication
  /// has ended. It never waits for the disk.
  void tick() { files_.tick(); }
  bool is_publishing() const { return files_.is_publishing(); }
  /// Publishes the table, and removes the journal of a complete sweep. Returns a message if the removal
  /// fails.
  std::string finish();

 private:
  using Entry = SweepRuns::Entry;

  const sweep::Plan* plan_;
  SweepRuns runs_;
  std::int64_t num_wanted_;
  std::int64_t num_faulty_ = 0;
  std::vector<std::int64_t> tasks_left_;
  std::unordered_map<std::int64_t, std::vector<std::int64_t>>
      waiting_;  // waiting tasks, by their twins in tasks_left_
  /// Data on a task from earlier sessions or attempts.
  struct Past {
    double wall_seconds = 0, processor_seconds = 0;  // time spent on the task
    std::string instruction_set;  // instruction set of the snapshot from which the task resumes; empty if the
                                  // task restarts
    void take_costs(const sweep::RunRow& row) {
      wall_seconds = row.wall_seconds;
      processor_seconds = row.processor_seconds;
    }
  };
  std::unordered_map<std::int64_t, Past> past_;
  SweepFiles files_;  // the last member: it is destroyed first, and then waits for a publication that may
                      // read the runs

  sweep::RunRow new_row(std::int64_t task) const;
  void request(std::int64_t task);
  Entry& copy_to(std::int64_t task, const Entry& twin);
  void pass_on(const Entry& twin);
};

}  // namespace clog::results
