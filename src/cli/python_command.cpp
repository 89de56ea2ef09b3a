#include "clog/cli/python_command.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"

namespace clog::cli {

namespace {

const std::string python_path = "PYTHONPATH";

/// A value of PYTHONPATH with which Python first searches this folder for modules.
std::string with_others(const std::filesystem::path& folder) {
  const char* others = std::getenv(python_path.c_str());
  return others && *others ? folder.string() + ":" + others : folder.string();
}

}  // namespace

std::filesystem::path find_python_module() {
  const std::filesystem::path folder = own_folder() / CLOG_PYTHON_FOLDER;
  std::error_code error;
  std::filesystem::path module = std::filesystem::canonical(folder / "clogsweep", error);
  if (error)
    throw Error("cannot run without " + (folder / "clogsweep").lexically_normal().string() +
                ", which belongs to this program; install clogsweep as a whole (cmake --install)");
  return module;
}

void become_python(const std::string& name, const std::filesystem::path& module,
                   std::vector<std::string> arguments) {
  console::flush_output();
  setenv("CLOG_CALLED_AS", name.c_str(), 1);
  setenv(python_path.c_str(), with_others(module.parent_path()).c_str(), 1);
  setenv("PYTHONSAFEPATH", "1", 1);  // Python then finds no modules in the user's working folder
  arguments.insert(arguments.begin(), {CLOG_PYTHON_COMMAND, "-m", "clogsweep"});
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  execvp(words.front(), words.data());
  throw Error(std::string("cannot run ") + CLOG_PYTHON_COMMAND + " (" + std::strerror(errno) +
              "); install Python 3 with h5py, pandas, SciPy, tables and matplotlib");
}

std::string python_command(const std::filesystem::path& module, const std::vector<std::string>& arguments) {
  std::string command =
      python_path + "=" + module.parent_path().string() + " " + CLOG_PYTHON_COMMAND + " -m clogsweep";
  for (const std::string& argument : arguments) command += " " + argument;
  return command;
}

bool is_python_command(const std::string& name) {
  if (name.empty() || name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") != std::string::npos)
    return false;
  std::string module = name;
  std::ranges::replace(module, '-', '_');
  std::error_code none;
  return std::filesystem::exists(
      own_folder() / CLOG_PYTHON_FOLDER / "clogsweep" / "commands" / (module + ".py"), none);
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
