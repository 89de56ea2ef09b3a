#include "clog/cli/analysis_script.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"

namespace clog::cli {

std::filesystem::path find_analysis_script(const std::string& name) {
  const std::filesystem::path folder = own_folder() / CLOG_SHARED_FOLDER / "analysis";
  std::error_code error;
  std::filesystem::path script = std::filesystem::canonical(folder / name, error);
  if (error)
    throw Error("cannot draw without " + (folder / name).lexically_normal().string() +
                ", which belongs to this program; install clogsweep as a whole (cmake --install)");
  return script;
}

void become_script(const std::string& name, const std::filesystem::path& script,
                   std::vector<std::string> arguments) {
  console::flush_output();
  setenv("CLOG_CALLED_AS", name.c_str(), 1);
  arguments.insert(arguments.begin(), script.string());
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  execv(script.c_str(), words.data());
  throw Error("cannot run " + script.string() + " (" + std::strerror(errno) +
              "); it needs Debian's python3 with h5py, pandas and matplotlib");
}

bool is_installed(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

std::filesystem::path own_folder() { return std::filesystem::read_symlink("/proc/self/exe").parent_path(); }

}  // namespace clog::cli
