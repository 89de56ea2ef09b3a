#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace clog::cli {

/// A script of the folder analysis, which is installed with this program. @throws Error  if it is not there
std::filesystem::path find_analysis_script(const std::string& name);

/// The program goes on as this script; its exit code is the script's.
/// @param name  under which the script speaks of itself
/// @throws Error  if the script cannot be run
[[noreturn]] void become_script(const std::string& name, const std::filesystem::path& script,
                                std::vector<std::string> arguments);

/// Is there a program of this name in PATH?
bool is_installed(const std::string& program);

/// The folder this program is in.
std::filesystem::path own_folder();

}  // namespace clog::cli
