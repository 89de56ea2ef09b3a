#include "clogfit_report.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "clog/core/error.hpp"

namespace clog {

int clogfit_report(int argc, const char* const* argv) {
  const std::filesystem::path script = std::filesystem::path(CLOG_ANALYSIS_FOLDER) / "report.py";
  std::error_code error;
  if (!std::filesystem::exists(script, error))
    throw Error("the report is drawn by " + script.string() +
                ", which is not there; run analysis/report.py of the source tree instead");
  std::vector<std::string> words = {script.string()};
  words.insert(words.end(), argv + 2, argv + argc);
  // The numbers are to come from this very program, wherever it was built.
  if (std::find(words.begin(), words.end(), "--programs") == words.end()) {
    words.emplace_back("--programs");
    words.push_back(std::filesystem::read_symlink("/proc/self/exe").parent_path());
  }
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(script.c_str(), pointers.data());
  throw Error("cannot run " + script.string() + " (" + std::strerror(errno) +
              "); it needs Debian's python3 with h5py, pandas and matplotlib");
}

}  // namespace clog
