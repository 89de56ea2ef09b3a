#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "clog/scheduler/scheduler.hpp"
#include "clog/sweep/job.hpp"
#include "order_of.hpp"

/// Helpers for programs that test the scheduler under mpirun. When one rank finds a fault, all ranks have to
/// exit.

namespace clog {

inline void expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "failed: %s\n", what);
  std::_Exit(1);
}

/// A job with a number of slices that depends on its task.
class SyntheticJob : public sweep::Job {
 public:
  SyntheticJob(std::int64_t task, std::span<const std::byte> snapshot)
      : task_(task), slices_left_(1 + task * 7 % 5 - static_cast<std::int64_t>(snapshot.size())) {}
  bool advance() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return --slices_left_ <= 0;
  }
  std::vector<std::byte> snapshot() const override {
    // The number of bytes is one more than the number of slices done.
    return std::vector<std::byte>(1 + task_ * 7 % 5 - slices_left_);
  }
  sweep::RunRow row() const override {
    sweep::RunRow row;
    row.task = task_;
    row.distance = static_cast<double>(task_ * task_);
    row.status = slices_left_ > 0 ? RunStatus::interrupted : RunStatus::clogged;
    row.steps = 1 + task_ * 7 % 5 - slices_left_;
    return row;
  }

 private:
  std::int64_t task_;
  std::int64_t slices_left_;
};

inline const sweep::JobFactory make_synthetic_job = [](std::int64_t task,
                                                       std::span<const std::byte> snapshot) {
  return std::make_unique<SyntheticJob>(task, snapshot);
};

/// Names for the hosts of ranks: "0" has the first `ranks_per_host` ranks.
inline std::vector<std::string> hosts_of_ranks(int num_ranks, int ranks_per_host) {
  std::vector<std::string> hosts;
  hosts.reserve(static_cast<std::size_t>(num_ranks));
  for (int rank = 0; rank < num_ranks; ++rank) hosts.push_back(std::to_string(rank / ranks_per_host));
  return hosts;
}

/// A sweep of one round with this number of ranks on each host.
inline scheduler::SweepEnd run_once(const scheduler::Communicator& ranks, const scheduler::TaskOrder& tasks,
                                    const sweep::JobFactory& make_job, const scheduler::SweepEvents& events,
                                    bool master_computes,
                                    std::chrono::milliseconds report_interval = std::chrono::seconds(10),
                                    int ranks_per_host = 1) {
  scheduler::Schedule schedule(tasks, hosts_of_ranks(ranks.size(), ranks_per_host), master_computes);
  return scheduler::run_tasks(ranks, schedule, make_job, events, report_interval);
}

}  // namespace clog
