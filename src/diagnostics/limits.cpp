#include "clog/diagnostics/limits.hpp"

#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "clog/core/tools/error.hpp"

namespace clog::diagnostics {
namespace {

namespace fs = std::filesystem;

/// The number after this name, in lines of the form `name number ...`.
std::optional<double> named_number(const fs::path& path, const std::string& wanted) {
  std::ifstream file(path);
  std::string name;
  double number = 0;
  while (file >> name >> number) {
    if (name == wanted) return number;
    file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return {};
}

std::optional<double> only_number(const fs::path& path) {
  std::ifstream file(path);
  double number = 0;
  if (file >> number) return number;
  return {};  // the file does not exist, or has no limit ("max")
}

/// Control groups of the process, from the innermost outwards. In a container, the innermost groups may be
/// missing.
std::vector<fs::path> control_groups(const fs::path& root) {
  std::ifstream file(root / "proc/self/cgroup");
  std::string own = "/";
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("0::/")) own = line.substr(3);
  std::vector<fs::path> groups = {root / "sys/fs/cgroup"};
  for (const fs::path& name : fs::path(own).relative_path()) {
    if (name == "..") break;  // this group is outside of the container
    groups.push_back(groups.back() / name);
  }
  return groups;
}

}  // namespace

double granted_cores(const fs::path& root) {
  double least = 0;
  for (const fs::path& group : control_groups(root)) {
    std::ifstream file(group / "cpu.max");
    double quota = 0, period = 0;
    if (!(file >> quota >> period) || period <= 0) continue;  // "max" is no number
    least = least > 0 ? std::min(least, quota / period) : quota / period;
  }
  return least;
}

double available_memory(const fs::path& root) {
  double available = 1024 * named_number(root / "proc/meminfo", "MemAvailable:").value_or(0);
  for (const fs::path& group : control_groups(root)) {
    const std::optional<double> limit = only_number(group / "memory.max");
    const std::optional<double> used = only_number(group / "memory.current");
    if (!limit || !used) continue;
    const double given_up = named_number(group / "memory.stat", "inactive_file").value_or(0);
    available = std::min(available, std::max(0.0, *limit - *used + given_up));
  }
  return available;
}

void require_open_files() {
  constexpr rlim_t least = 32, wanted = 1024;
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= wanted) return;
  limit.rlim_cur = std::min(limit.rlim_max, wanted);
  setrlimit(RLIMIT_NOFILE, &limit);
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < least)
    throw Error(fmt::format(
        "cannot start MPI (this shell allows {} open files, {} are needed); raise the limit: ulimit -n {}",
        limit.rlim_cur, least, wanted));
}

}  // namespace clog::diagnostics
