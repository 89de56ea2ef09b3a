#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace clog::scheduler {

/// Decides whether a failed task or its rank (a broken node) is at fault. A task's result depends on no rank,
/// so the test is to try the task on other ranks:
///
/// - A failure counts against its rank until the rank succeeds with another task, or until the task also
///   fails on a trusted rank: then the task is at fault. A rank is trusted if it has succeeded and is not on
///   hold.
/// - Three failures that count against a rank put it on hold: it gets no more tasks until their cause is
///   known.
/// - If one of the three tasks then succeeds elsewhere, the rank is set aside for good.
/// - If all ranks but one are set aside, the last rank cannot be compared with another, so three failures set
///   it aside at once. A rank that was alone from the beginning is never set aside.
class RankTrust {
 public:
  explicit RankTrust(const std::vector<int>& ranks);

  /// Records that a task succeeded, or failed. Returns the ranks that are set aside as a result.
  std::vector<int> succeeded(std::int64_t task, int rank);
  std::vector<int> failed(std::int64_t task, int rank);
  /// Call this when no remaining rank can decide whether a rank or a task is at fault. Releases all ranks on
  /// hold that are still in service.
  void let_go();

  int num_in_service() const { return num_in_service_; }
  bool may_work(int rank) const { return records_.at(rank).in_service && !is_on_hold(rank); }
  /// Whether this rank may retry a failed task: only after every other rank has tried it.
  bool is_next_for(std::int64_t task, int rank) const;
  bool is_trusted(int rank) const;
  /// Tasks that failed on this rank, and have neither failed on a trusted rank nor succeeded on any rank.
  std::vector<std::int64_t> unsettled_tasks(int rank) const;
  /// Unsettled tasks of a rank on hold that another rank in service has not tried yet. Other ranks should try
  /// these tasks, to decide whether the rank may be released. Empty if this rank is not on hold, or if all
  /// tasks seem to fail on all ranks.
  std::vector<std::int64_t> tasks_in_doubt(int rank) const;

 private:
  struct Record {
    bool in_service = true;
    bool has_succeeded = false;
    bool is_refuted = false;                 // whether a task held against it has succeeded elsewhere
    std::vector<std::int64_t> held_against;  // tasks that count against the rank
  };
  static constexpr std::size_t most_failures = 3;

  std::unordered_map<int, Record> records_;  // records of the ranks, by rank
  // The ranks on which a task failed, by task until it succeeds.
  std::unordered_map<std::int64_t, std::vector<int>> failed_on_;
  int num_in_service_;
  int num_ranks_;
  bool has_let_go_ = false;

  bool is_on_hold(int rank) const;
  static bool has_many_failures(const Record& record) { return record.held_against.size() >= most_failures; }
  bool set_aside_if_due(Record& record);
};

}  // namespace clog::scheduler
