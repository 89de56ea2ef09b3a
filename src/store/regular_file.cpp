#include "clog/store/regular_file.hpp"

#include <sys/stat.h>

#include "clog/core/tools/error.hpp"

namespace clog::store {

std::string require_regular(std::string path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw Error(
        "cannot use " + path +
        " (not a regular file: a folder, pipe, device or socket); give another name, or move it away");
  return path;
}

}  // namespace clog::store
