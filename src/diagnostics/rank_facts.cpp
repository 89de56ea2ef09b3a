#include "clog/diagnostics/rank_facts.hpp"

#include <sched.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "clog/console/build_info.hpp"
#include "clog/console/json_text.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/instruction_set.hpp"
#include "clog/diagnostics/limits.hpp"
#include "clog/scheduler/communicator.hpp"

namespace clog::diagnostics {
namespace {

std::vector<int> allowed_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> cores;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return cores;
  for (int core = 0; core < CPU_SETSIZE; ++core)
    if (CPU_ISSET(core, &set)) cores.push_back(core);
  return cores;
}

double step_cost(double seconds) {
  RunParameters parameters;
  parameters.obstacles.box = 20;
  parameters.obstacles.gap = 0.5;
  parameters.max_time = 1e9;
  parameters = resolve(parameters);
  DropletRun run(parameters);
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto begin = now();
  std::chrono::duration<double> elapsed{};
  while (elapsed.count() < seconds && !run.advance(8)) elapsed = now() - begin;
  return 1e9 * elapsed.count() / (static_cast<double>(run.result().steps) * *parameters.dp.vertices);
}

}  // namespace

RankFacts find_rank_facts(int rank, double seconds) {
  const console::BuildInfo build = console::build_info();
  return {.rank = rank,
          .host = scheduler::Communicator::host_name(),
          .version = build.version + " (git " + build.git_describe + ")",
          .instruction_set = instruction_set(),
          .cores = allowed_cores(),
          .cores_granted = granted_cores(),
          .memory = available_memory(),
          .nanoseconds_per_step = step_cost(seconds)};
}

std::string to_text(const RankFacts& facts) {
  return console::json_text({{"rank", facts.rank},
                             {"host", facts.host},
                             {"version", facts.version},
                             {"instruction_set", facts.instruction_set},
                             {"cores", facts.cores},
                             {"cores_granted", facts.cores_granted},
                             {"memory", facts.memory},
                             {"nanoseconds_per_step", facts.nanoseconds_per_step}},
                            -1);
}

RankFacts rank_facts_from(const std::string& text) {
  const nlohmann::json facts = nlohmann::json::parse(text);
  return {.rank = facts.at("rank"),
          .host = facts.at("host"),
          .version = facts.at("version"),
          .instruction_set = facts.at("instruction_set"),
          .cores = facts.at("cores"),
          .cores_granted = facts.at("cores_granted"),
          .memory = facts.at("memory"),
          .nanoseconds_per_step = facts.at("nanoseconds_per_step")};
}

}  // namespace clog::diagnostics
