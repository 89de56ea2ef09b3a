#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "clog/results/activity.hpp"
#include "clog/results/growth.hpp"
#include "clog/store/journal.hpp"
#include "clog/store/output_path.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/messages.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::results {

/// The state of a sweep's runs, on rank 0 and on disk: the table, which another thread publishes from time to
/// time, and the journal beside it, which contains later results and the snapshots of running tasks. A
/// stopped or killed sweep resumes from these files. A run is identified by its parameters and seed
/// (sweep::identity), not by its task number.
class SweepState {
 public:
  /// Reads the files, and checks that they belong to this sweep.
  /// @param num_wanted  number of tasks, from the start of the plan, that are requested at first (rounds may
  /// request more)
  /// @param attempts  number of attempts for a crashing run, over all sessions
  /// @throws Error if the file is not a sweep's, has another model version or other settings, or another
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
  /// Number of tasks that get the results of tasks_left() in other laboratories.
  std::int64_t num_waiting() const;
  /// Number of tasks_left() that resume from a snapshot.
  std::int64_t num_resumed() const;
  /// Number of runs in the file that are outside this plan; the file keeps them.
  std::int64_t num_beyond() const { return static_cast<std::int64_t>(other_runs_.size()); }
  /// Number of physically impossible rows; their runs are recomputed.
  std::int64_t num_faulty() const { return num_faulty_; }
  /// Number of damaged records of the journal. Runs of such records resume from an earlier record, or
  /// restart.
  std::int64_t num_unreadable() const { return journal_.num_unreadable(); }

  /// Names what could not be verified in the file that the sweep resumes from; empty if all was verified.
  const std::string& caution() const { return caution_; }

  /// Starts to record in the table how many of `num_ranks` ranks are busy (Activity).
  void watch_ranks(int num_ranks);
  /// A rank has ended its task, whatever the outcome.
  void rank_is_free();
  sweep::Start start(std::int64_t task, int rank);
  /// A started task does not use its snapshot, but restarts.
  void restarted(std::int64_t task);
  void report(const sweep::Report& report);
  /// Row of a run that has begun.
  const sweep::RunRow& row(std::int64_t task) const { return runs_.at(task)->row; }
  /// If all runs that have begun have failed, the first of them, otherwise nullptr.
  const sweep::RunRow* first_if_all_failed() const;
  /// Discards a failure, so that the task runs again with the same attempt number.
  void withdraw_failure(std::int64_t task);
  bool tries_again(const sweep::RunRow& failed) const {
    return sweep::may_succeed_later(failed) && failed.attempt < attempts_;
  }
  /// Call this often: it starts to publish the table if that is due, or detects that a publication has ended,
  /// and never waits for the disk.
  void tick();
  bool is_publishing() const { return publication_.valid(); }
  /// Publishes the table, and removes the journal of a complete sweep. Returns a message if that fails.
  std::string finish();

 private:
  using Clock = std::chrono::steady_clock;
  using Entry = store::Journal::Entry;

  store::OutputPath place_;
  std::string path_;   // path without symbolic links, for messages and readers
  std::string stamp_;  // stamp of the table as this sweep read or wrote it last; empty if there was none
  const sweep::Plan* plan_;
  store::Provenance provenance_;
  std::int64_t attempts_;
  store::Journal journal_;
  using Entries = std::vector<std::unique_ptr<Entry>>;
  Entries runs_;                            // runs by task; nullptr for a task that has not begun
  Entries other_runs_;                      // runs that are in the file, but not in this plan
  std::vector<store::CircleFile> circles_;  // files of the circles of all runs
  std::int64_t num_wanted_;
  std::int64_t num_faulty_ = 0;
  std::vector<std::int64_t> tasks_left_;
  std::unordered_map<std::int64_t, std::vector<std::int64_t>>
      waiting_;  // tasks, by their twins in tasks_left_
  /// What is known of a task from earlier sessions or attempts.
  struct Past {
    double wall_seconds = 0, processor_seconds = 0;  // time spent on the task
    std::string instruction_set;  // that of the snapshot from which the task resumes; empty if it restarts
    void take_costs(const sweep::RunRow& row) {
      wall_seconds = row.wall_seconds;
      processor_seconds = row.processor_seconds;
    }
  };
  std::unordered_map<std::int64_t, Past> past_;
  std::string caution_;
  std::optional<Activity> activity_;
  std::string earlier_activity_;  // the lines of other sessions
  std::string session_time_;
  Clock::time_point begin_ = Clock::now();
  bool is_published_ = false;
  Clock::time_point publication_begin_, publication_end_;
  std::mutex changing_;  // protects rows that a publication may be reading
  // Gives the stamp; this is the last member, so that it ends first.
  std::future<std::optional<std::string>> publication_;

  Entry* entry(std::int64_t task) const {
    return task < std::ssize(runs_) ? runs_[static_cast<std::size_t>(task)].get() : nullptr;
  }
  std::unique_ptr<Entry>& place_of(std::int64_t task);
  std::vector<const Entry*> entries() const;  // of all runs
  bool is_over(const sweep::RunRow& row) const;
  sweep::RunRow new_row(std::int64_t task) const;
  void keep_circles(const store::SweepFile& file);
  store::SweepFile read_table();
  void adopt(const store::SweepFile& file, const sweep::Settings& settings);
  std::string settings_that_differ(const store::SweepFile& file, const sweep::Settings& settings) const;
  /// Runs by their identity.
  using Known = std::unordered_map<std::string, std::unique_ptr<Entry>>;
  bool is_of_its_task(const sweep::RunRow& row) const;
  Known recognise(std::vector<sweep::RunRow> rows, std::vector<Entry> records,
                  const sweep::Settings& settings);
  void refuse_foreign(const sweep::RunRow& record, const FixedValues& fixed) const;
  std::int64_t num_tasks_known(const Known& known) const;
  void find_runs(Known& known, std::int64_t num_tasks);
  void find_tasks(Known known);
  double seconds_so_far() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  sweep::RunRow published(const sweep::RunRow& row) const;
  void write_down(const Entry& entry);
  void request(std::int64_t task);
  static std::unique_ptr<Entry> copy_of(const Entry& twin);
  Entry& copy_to(std::int64_t task, const Entry& twin);
  void pass_on(const Entry& twin);
  /// Publishes the rows of all runs, also of those outside this plan.
  std::optional<std::string> publish_to(const store::OutputPath& place, const std::string& stamp,
                                        const std::vector<const Entry*>& all,
                                        const store::Provenance& provenance);
  void publish();
  void begin_publication();
  void end_publication();
  [[noreturn]] void rescue();
  void prepare_journal(const std::vector<const Entry*>& all, std::uint64_t place);
};

}  // namespace clog::results
