#include "clog/scheduler/machine_trust.hpp"

#include <algorithm>

namespace clog::scheduler {

MachineTrust::MachineTrust(const std::vector<std::string>& hosts, int first) : machine_of_(hosts) {
  const std::set<std::string> computing(hosts.begin() + std::min<std::ptrdiff_t>(first, std::ssize(hosts)),
                                        hosts.end());
  for (std::size_t rank = 0; rank < hosts.size(); ++rank) {
    machine_of_[rank] =
        (computing.size() > 1 ? "host " : "rank " + std::to_string(rank) + " on ") + hosts[rank];
    if (static_cast<int>(rank) >= first) machines_[machine_of_[rank]];
  }
  num_in_service_ = static_cast<int>(machines_.size());
}

std::optional<MachineTrust::Suspect> MachineTrust::suspect(const std::string& name) {
  Machine& machine = machines_.at(name);
  if (!machine.in_service || machine.failures.size() < most_failures) return std::nullopt;
  Suspect found{name, machine.message, false, machine.failures};
  const bool is_refuted =
      std::erase_if(found.tasks, [this](auto task) { return !failed_on_.contains(task); });
  const bool is_last_of_several = num_in_service_ == 1 && machines_.size() > 1;
  if (is_refuted || is_last_of_several) {
    found.is_set_aside = true;
    machine.in_service = false;
    --num_in_service_;
    return found;
  }
  // Without a trusted machine, no machine is suspect, because all tasks seem to fail on all machines.
  const auto is_trustworthy = [this](const auto& other) { return is_trusted(other.second); };
  if (may_work(machine) || (has_let_go_ && std::ranges::none_of(machines_, is_trustworthy)))
    return std::nullopt;
  std::erase_if(found.tasks, [&](auto task) { return is_next_for(task, name); });
  return found;
}

std::vector<MachineTrust::Suspect> MachineTrust::succeeded(std::int64_t task, int rank) {
  Machine& here = machines_.at(name_of(rank));
  here.has_succeeded = true;
  here.failures.clear();
  std::vector<Suspect> suspects;
  if (const auto failed = failed_on_.extract(task))
    for (const std::string& name : failed.mapped())
      if (std::optional<Suspect> found = suspect(name)) suspects.push_back(std::move(*found));
  return suspects;
}

std::optional<MachineTrust::Suspect> MachineTrust::failed(std::int64_t task, int rank,
                                                          const std::string& message) {
  const std::string& name = name_of(rank);
  Machine& here = machines_.at(name);
  here.message = message;
  bool is_own_fault = false;
  for (const std::string& other : failed_on_[task]) {
    if (other == name) continue;
    if (is_trusted(here)) machines_.at(other).failures.erase(task);
    is_own_fault = is_own_fault || is_trusted(machines_.at(other));
  }
  failed_on_[task].insert(name);
  if (!is_own_fault) here.failures.insert(task);
  // The machine was set aside earlier, but tasks that were still running on it may fail later.
  if (!here.in_service) return Suspect{name, message, false, {task}};
  return suspect(name);
}

void MachineTrust::end_holds() {
  has_let_go_ = true;
  for (auto& [name, machine] : machines_)
    if (machine.in_service) machine.failures.clear();
}

bool MachineTrust::is_next_for(std::int64_t task, const std::string& name) const {
  const auto failed = failed_on_.find(task);
  if (failed == failed_on_.end() || !failed->second.contains(name)) return true;
  return std::ranges::all_of(machines_, [&](const auto& other) {
    return !other.second.in_service || failed->second.contains(other.first);
  });
}

}  // namespace clog::scheduler
