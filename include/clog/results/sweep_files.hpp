#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "clog/results/activity.hpp"
#include "clog/results/sweep_runs.hpp"
#include "clog/store/journal.hpp"
#include "clog/store/output_path.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::results {

/// The files of a sweep while it runs: the table, which another thread publishes from time to time, and the
/// journal beside it. The journal contains later results and the snapshots of running tasks.
class SweepFiles {
 public:
  using Entry = SweepRuns::Entry;

  /// Opens the journal. @param runs  the runs to be published; they outlive this object
  /// @throws Error if another sweep has it open
  SweepFiles(std::string path, const sweep::Plan& plan, store::Provenance provenance, const SweepRuns& runs);

  /// The path without symbolic links, for messages and readers.
  const std::string& path() const { return place_.path(); }
  /// The data of earlier sessions; empty if there were none.
  struct Earlier {
    store::SweepFile table;
    std::vector<Entry> records;  ///< records of the journal, the oldest first
  };
  /// Reads the data of earlier sessions, and keeps the provenance and the circles of the table.
  /// @throws Error if the table is not of a sweep, or has foreign objects, or if the journal has records but
  /// there is no table
  Earlier take_earlier();
  std::int64_t num_unreadable() const { return journal_.num_unreadable(); }
  /// Publishes the table for the first time.
  void begin_session();
  /// See SweepState::caution().
  const std::string& caution() const { return caution_; }

  /// Sets an attribute of the table.
  void set(const std::string& name, const std::string& text);
  /// These functions record how many ranks are busy (Activity).
  void watch_ranks(int num_ranks);
  void rank_is_busy();
  void rank_is_free() {
    if (activity_) activity_->ended(seconds_so_far());
  }
  void restarted() {
    if (activity_) activity_->restarted();
  }

  /// Adds the run to the journal.
  void write_down(const Entry& entry);
  /// See SweepState.
  void tick();
  bool is_publishing() const { return publication_.valid(); }
  /// Publishes the table of an incomplete sweep, and reduces the journal to the unfinished runs.
  void stop();
  /// Publishes the table of a complete sweep, and removes the journal. Returns a message if the removal
  /// fails.
  std::string complete();

 private:
  using Clock = std::chrono::steady_clock;

  store::OutputPath place_;
  std::string stamp_;  // stamp of the table as this sweep read or wrote it last; empty if there was none
  store::Journal journal_;
  const SweepRuns& runs_;
  std::vector<store::CircleFile> circles_;  // files of the circles of all runs
  store::Provenance provenance_;
  std::string caution_;
  std::optional<Activity> activity_;
  std::string earlier_activity_;  // the lines of other sessions
  std::string session_time_;
  Clock::time_point begin_;
  bool is_published_ = false;
  Clock::time_point publication_begin_, publication_end_;
  // Returns the stamp. This future is the last member: it is destroyed first, and then waits for the end of
  // the publication.
  std::future<std::optional<std::string>> publication_;

  double seconds_so_far() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  sweep::RunRow published(sweep::RunRow row) const;
  std::optional<std::string> publish_to(const store::OutputPath& place, const std::string& stamp,
                                        const std::vector<const Entry*>& all,
                                        const store::Provenance& provenance) const;
  store::SweepFile read_table();
  std::vector<Entry> take_records();
  void publish();
  void publish_last();
  void begin_publication();
  void end_publication();
  [[noreturn]] void rescue();
  void prepare_journal(const std::vector<const Entry*>& all, std::uint64_t place);
};

}  // namespace clog::results
