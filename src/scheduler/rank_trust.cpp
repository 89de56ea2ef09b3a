#include "clog/scheduler/rank_trust.hpp"

#include <algorithm>

namespace clog::scheduler {

RankTrust::RankTrust(const std::vector<int>& ranks)
    : num_in_service_(static_cast<int>(ranks.size())), num_ranks_(num_in_service_) {
  for (const int rank : ranks) records_[rank];
}

bool RankTrust::set_aside_if_due(Record& record) {
  const bool is_last_of_several = num_in_service_ == 1 && num_ranks_ > 1;
  if (!record.in_service || !has_many_failures(record) || !(record.is_refuted || is_last_of_several))
    return false;
  record.in_service = false;
  --num_in_service_;
  return true;
}

std::vector<int> RankTrust::succeeded(std::int64_t task, int rank) {
  Record& here = records_.at(rank);
  here.has_succeeded = true;
  here.is_refuted = false;
  here.held_against.clear();
  std::vector<int> set_aside;
  if (const auto failed = failed_on_.extract(task))
    for (const int other : failed.mapped()) {
      Record& there = records_.at(other);
      if (std::count(there.held_against.begin(), there.held_against.end(), task) == 0) continue;
      there.is_refuted = true;
      if (set_aside_if_due(there)) set_aside.push_back(other);
    }
  return set_aside;
}

std::vector<int> RankTrust::failed(std::int64_t task, int rank) {
  std::vector<int>& ranks = failed_on_[task];
  const bool here_is_trusted = is_trusted(rank);
  bool is_own_fault = false;
  for (const int other : ranks) {
    if (other == rank) continue;
    if (here_is_trusted) std::erase(records_.at(other).held_against, task);
    is_own_fault = is_own_fault || is_trusted(other);
  }
  if (std::count(ranks.begin(), ranks.end(), rank) == 0) ranks.push_back(rank);
  Record& here = records_.at(rank);
  if (!is_own_fault && std::count(here.held_against.begin(), here.held_against.end(), task) == 0)
    here.held_against.push_back(task);
  return set_aside_if_due(here) ? std::vector<int>{rank} : std::vector<int>();
}

void RankTrust::let_go() {
  has_let_go_ = true;
  for (auto& [rank, record] : records_)
    if (record.in_service) {
      record.is_refuted = false;
      record.held_against.clear();
    }
}

bool RankTrust::is_on_hold(int rank) const {
  const Record& record = records_.at(rank);
  return record.in_service && num_in_service_ > 1 && has_many_failures(record);
}

bool RankTrust::is_trusted(int rank) const {
  const Record& record = records_.at(rank);
  return record.in_service && record.has_succeeded && !has_many_failures(record);
}

bool RankTrust::is_next_for(std::int64_t task, int rank) const {
  const auto failed = failed_on_.find(task);
  if (failed == failed_on_.end()) return true;
  const std::vector<int>& ranks = failed->second;
  if (std::count(ranks.begin(), ranks.end(), rank) == 0) return true;
  return std::count_if(ranks.begin(), ranks.end(),
                       [this](int other) { return records_.at(other).in_service; }) == num_in_service_;
}

std::vector<std::int64_t> RankTrust::unsettled_tasks(int rank) const {
  std::vector<std::int64_t> tasks;
  for (const std::int64_t task : records_.at(rank).held_against)
    if (failed_on_.contains(task)) tasks.push_back(task);
  return tasks;
}

std::vector<std::int64_t> RankTrust::tasks_in_doubt(int rank) const {
  const auto is_trustworthy = [this](const auto& other) { return is_trusted(other.first); };
  if (!is_on_hold(rank) || (has_let_go_ && std::none_of(records_.begin(), records_.end(), is_trustworthy)))
    return {};
  std::vector<std::int64_t> tasks = unsettled_tasks(rank);
  std::erase_if(tasks, [&](std::int64_t task) { return is_next_for(task, rank); });
  return tasks;
}

}  // namespace clog::scheduler
