#pragma once

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "clog/core/tools/error.hpp"
#include "clog/store/run_table.hpp"

namespace clog::store {

/// A test with a separate empty folder.
class FolderTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / (std::string("clog_") + info->test_suite_name() + "_" +
                                                        info->name() + "_" + std::to_string(getpid()));
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write_text(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  std::string text_of(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator(file), {}};
  }
  std::ptrdiff_t num_files() const {
    return std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator());
  }

  std::filesystem::path folder_;
};

/// Writes a table. An existing table is replaced.
inline void publish(const std::string& path, const std::vector<sweep::RunRow>& rows,
                    const Provenance& provenance, const std::vector<CircleFile>& circles = {}) {
  const OutputPath place = OutputPath::resolve(path);
  publish_sweep(place, place.stamp(), {rows, provenance, circles});
}

/// Simulates a full disk by a limit on the size of files. Call this in a separate process, because the
/// process exits: with 2 if the action throws an Error, whose text is printed on the error stream, and with 0
/// otherwise.
[[noreturn]] inline void run_on_full_disk(rlim_t num_bytes, const std::function<void()>& action) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before;
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit tight{num_bytes, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &tight);
  try {
    action();
  } catch (const Error& error) {
    // The limit ends before the printing, because the error stream may be a file.
    setrlimit(RLIMIT_FSIZE, &before);
    std::fputs(error.what(), stderr);
    std::_Exit(2);
  }
  std::_Exit(0);
}

}  // namespace clog::store
