#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace clog::scheduler {

/// Decides whether a failed task is at fault itself, or the machine that computed it. A machine is a host; if
/// all ranks are on one host, a machine is a rank. A task's result does not depend on the machine, so other
/// machines can test the task:
///
/// - A failure counts against its machine until the machine succeeds with another task, or until the task
///   also fails on a trusted machine. A machine is trusted if it has succeeded and is not on hold.
/// - Three failures that count put a machine on hold: it gets no more tasks until the cause of these failures
///   is known.
/// - If one of the three tasks then succeeds elsewhere, the machine is set aside for good.
/// - The last machine of several cannot be compared with another, so three failures set it aside at once. A
///   machine that was alone from the beginning is never set aside.
class MachineTrust {
 public:
  /// @param hosts  hosts of all ranks, by rank
  /// @param first  the first rank that computes
  MachineTrust(const std::vector<std::string>& hosts, int first);

  /// A machine that may be at fault for its failures.
  struct Suspect {
    std::string name;              ///< "host n17", or "rank 3 on n17"
    std::string message;           ///< message of its last failure
    bool is_set_aside;             ///< whether the machine is at fault, and gets no more tasks from now on
    std::set<std::int64_t> tasks;  ///< tasks that failed there, which other machines should try
  };
  /// Records that a task succeeded, or failed. Returns the machines that are suspect as a result.
  std::vector<Suspect> succeeded(std::int64_t task, int rank);
  std::optional<Suspect> failed(std::int64_t task, int rank, const std::string& message);
  /// Call this when no machine is left that could test the failed tasks. Machines on hold then get tasks
  /// again.
  void end_holds();

  int num_in_service() const { return num_in_service_; }
  bool may_work(int rank) const { return may_work(machines_.at(name_of(rank))); }
  bool is_trusted(int rank) const { return is_trusted(machines_.at(name_of(rank))); }
  /// Whether this rank may retry a failed task. The machine on which a task failed may retry it only after
  /// all other machines have tried it.
  bool is_next_for(std::int64_t task, int rank) const { return is_next_for(task, name_of(rank)); }

 private:
  struct Machine {
    bool in_service = true;
    bool has_succeeded = false;
    std::set<std::int64_t> failures;  // tasks with failures that count against the machine
    std::string message;              // message of the last failure
  };
  static constexpr std::size_t most_failures = 3;

  std::vector<std::string> machine_of_;      // names of machines, by rank
  std::map<std::string, Machine> machines_;  // by name
  // The machines on which a task has failed, by task; a success of the task removes its entry.
  std::unordered_map<std::int64_t, std::set<std::string>> failed_on_;
  int num_in_service_;
  bool has_let_go_ = false;

  const std::string& name_of(int rank) const { return machine_of_.at(static_cast<std::size_t>(rank)); }
  bool may_work(const Machine& machine) const {
    return machine.in_service && (num_in_service_ == 1 || machine.failures.size() < most_failures);
  }
  bool is_trusted(const Machine& machine) const { return machine.has_succeeded && may_work(machine); }
  bool is_next_for(std::int64_t task, const std::string& name) const;
  std::optional<Suspect> suspect(const std::string& name);
};

}  // namespace clog::scheduler
