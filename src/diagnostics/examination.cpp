#include "clog/diagnostics/examination.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/scheduler/communicator.hpp"

namespace clog::diagnostics {
namespace {

bool is_set(const char* name) { return std::getenv(name) != nullptr; }

bool is_open_mpi() { return scheduler::Communicator::library_version().starts_with("Open MPI"); }

/// The number in an environment variable of the launcher; 0 if unknown.
int number_in(const char* name) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : 0;
}

/// Why a single rank is probably a mistake; nullopt if one rank is intended.
std::optional<Finding> why_not_alone(int num_ranks) {
  if (num_ranks > 1) return {};
  constexpr const char* of_open_mpi = "OMPI_COMM_WORLD_SIZE";
  const bool by_mpirun = is_set(of_open_mpi) || is_set("MPI_LOCALNRANKS");  // MPI_LOCALNRANKS is set by MPICH
  if (const int tasks = number_in("SLURM_NTASKS"); tasks > 1 && !by_mpirun)
    return Finding{fmt::format("one rank in a Slurm allocation of {} tasks", tasks),
                   "srun cannot start this MPI's ranks together: use mpirun, as jobs/slurm.sh does, or "
                   "mpirun -np 1 for a single rank"};
  if (const int started = std::max(number_in(of_open_mpi), number_in("PMI_SIZE")); started > 1)
    return Finding{
        fmt::format("one rank, where mpirun has started {}", started),
        fmt::format("this mpirun belongs to another MPI: use that of {}, with which this program was built",
                    scheduler::Communicator::library_version())};
  return {};
}

Finding launcher(int num_ranks) {
  if (const auto finding = why_not_alone(num_ranks)) return *finding;
  if (num_ranks > 1) return {fmt::format("{} ranks, started together", num_ranks)};
  if (is_open_mpi() && geteuid() == 0 &&
      !(is_set("OMPI_ALLOW_RUN_AS_ROOT") && is_set("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM")))
    return {"one rank; mpirun refuses to start more as root",
            "in a container: source jobs/mpi-settings.sh first; elsewhere use an account of your own"};
  return {"one rank; run doctor under mpirun for more checks"};
}

Finding versions(const std::vector<RankFacts>& ranks) {
  std::set<std::string> all;
  for (const RankFacts& rank : ranks) all.insert(rank.version);
  if (all.size() == 1)
    return {fmt::format("clogsweep {}{}", *all.begin(), ranks.size() > 1 ? " on all ranks" : "")};
  return {"the ranks run different programs: " + joined(all),
          "install one build on all hosts, or on a shared file system"};
}

Finding instruction_sets_of(const std::vector<RankFacts>& ranks) {
  std::set<std::string> all;
  for (const RankFacts& rank : ranks) all.insert(rank.instruction_set);
  if (all.size() == 1) return {"instruction set " + *all.begin()};
  return {"instruction sets differ: " + joined(all),
          "results differ in their last bits only; for the same bits on all hosts: --instruction-set " +
              *all.rbegin()};
}

/// Finds out whether the ranks of a host are bound to too few cores.
Finding cores(const std::string& host, const std::vector<const RankFacts*>& ranks) {
  std::map<std::vector<int>, int> ranks_by_cores;
  std::set<int> all;
  for (const RankFacts* rank : ranks) {
    ++ranks_by_cores[rank->cores];
    all.insert(rank->cores.begin(), rank->cores.end());
  }
  const double granted = ranks.front()->cores_granted;
  const std::string unbind = how_to_unbind(scheduler::Communicator::library_version());
  const std::string where = fmt::format("{}: {}, {}", host, count_text(std::ssize(ranks), "rank"),
                                        count_text(std::ssize(all), "core"));
  if (ranks.size() > all.size())
    return {where, fmt::format("one rank per core is as fast: mpirun -np {}; if there are more cores, ranks "
                               "are bound: {}",
                               all.size(), unbind)};
  if (granted > 0 && granted < static_cast<double>(ranks.size()))
    return {fmt::format("{}, of which {:.3g} are granted (cpu.max of a control group)", where, granted),
            "ask for more cores, or start fewer ranks"};
  for (const auto& [set, number] : ranks_by_cores)
    if (static_cast<std::size_t>(number) > set.size())
      return {fmt::format("{}, but {} ranks are bound to {}", where, number,
                          set.size() == 1 ? fmt::format("one core ({})", set.front())
                                          : fmt::format("{} of them", set.size())),
              unbind + "; core instead of none if the host is yours alone"};
  return {where};
}

Finding memory(const std::string& host, const std::vector<const RankFacts*>& ranks) {
  constexpr double needed = 100e6;  // an upper bound of the memory of a rank with an array of 500 sigma
  const double available = ranks.front()->memory / static_cast<double>(ranks.size());
  const std::string what = fmt::format("{}: {:.3g} GB of memory per rank", host, available / 1e9);
  if (available < needed) return {what, "start fewer ranks per host, or use a smaller box"};
  return {what};
}

Finding speed(const std::vector<RankFacts>& ranks) {
  constexpr double much_slower = 1.5;
  std::vector<double> costs;
  costs.reserve(ranks.size());
  for (const RankFacts& rank : ranks) costs.push_back(rank.nanoseconds_per_step);
  std::sort(costs.begin(), costs.end());
  const double median = costs[(costs.size() - 1) / 2];
  const std::string what = fmt::format("a step takes {:.3g}{} ns per vertex", costs.front(),
                                       costs.size() > 1 ? fmt::format(" to {:.3g}", costs.back()) : "");
  std::set<std::string> slow;
  for (const RankFacts& rank : ranks)
    if (rank.nanoseconds_per_step > much_slower * median)
      slow.insert(fmt::format("rank {} on {}", rank.rank, rank.host));
  if (slow.empty()) return {what};
  return {what + "; much slower than the median: " + joined(slow),
          "look for other programs on those cores, and for bound ranks"};
}

/// Tests the file operations of a sweep in the folder of its output, with a temporary file.
Finding folder(const std::string& output) {
  namespace fs = std::filesystem;
  const fs::path parent = fs::path(output).parent_path();
  const std::string place = parent.empty() ? "." : parent.string();
  std::string name = (fs::path(place) / "clogsweep-doctor.XXXXXX").string();
  const int file = mkstemp(name.data());
  if (file < 0)
    return {fmt::format("cannot write in {} ({})", place, std::strerror(errno)),
            "give a folder of yours that exists: --output FOLDER/sweep.h5"};
  const std::string renamed = name + ".h5";
  const std::vector<char> bytes(1 << 20, 'x');
  const auto begin = std::chrono::steady_clock::now();
  const bool is_written =
      write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()) && fsync(file) == 0;
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;
  const bool is_locked = flock(file, LOCK_EX | LOCK_NB) == 0;
  const bool is_renamed = rename(name.c_str(), renamed.c_str()) == 0;
  const int directory = open(place.c_str(), O_RDONLY | O_DIRECTORY);
  const bool is_synced = directory < 0 || fsync(directory) == 0 || errno == EINVAL;
  if (directory >= 0) close(directory);
  close(file);
  unlink(is_renamed ? renamed.c_str() : name.c_str());
  std::error_code ignored;
  const double free = static_cast<double>(fs::space(place, ignored).available);
  const std::string what =
      fmt::format("folder {}: {:.3g} GB free, a megabyte takes {:.3g} ms to reach the disk", place,
                  free / 1e9, elapsed.count());
  if (!is_written) return {what + ", cannot be written to", "make room, or give another --output"};
  if (!is_locked)
    return {what + ", files cannot be locked (flock)",
            "give an --output on another file system, or mount this one with locks; if no other sweep writes "
            "there: export HDF5_USE_FILE_LOCKING=FALSE"};
  if (!is_synced)
    return {what + ", the folder cannot be synchronised (sync fails)", "results are safe but in a power cut"};
  if (!is_renamed) return {what + ", files cannot be renamed", "give an --output on another file system"};
  if (free < 1e8) return {what, "make room, or give another --output"};
  return {what + ", locks work"};
}

}  // namespace

std::string how_to_unbind(const std::string& mpi) {
  constexpr std::string_view open_mpi = "Open MPI v";
  if (!mpi.starts_with(open_mpi)) return "mpirun -bind-to none";
  const int major = std::atoi(mpi.c_str() + open_mpi.size());
  return major >= 5 ? "set PRTE_MCA_hwloc_default_binding_policy=none"
                    : "set OMPI_MCA_hwloc_base_binding_policy=none";
}

std::vector<Finding> examine(const std::vector<RankFacts>& ranks, const std::string& output) {
  std::map<std::string, std::vector<const RankFacts*>> by_host;
  for (const RankFacts& rank : ranks) by_host[rank.host].push_back(&rank);
  std::vector<Finding> all = {launcher(static_cast<int>(ranks.size())), versions(ranks),
                              instruction_sets_of(ranks), speed(ranks)};
  for (const auto& [host, members] : by_host) {
    all.push_back(cores(host, members));
    all.push_back(memory(host, members));
  }
  all.push_back(folder(output));
  return all;
}

void refuse_to_be_alone(int num_ranks) {
  if (const auto finding = why_not_alone(num_ranks)) throw Error(finding->what + "; " + finding->remedy);
}

}  // namespace clog::diagnostics
