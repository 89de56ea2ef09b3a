#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace clog::cli {

/// The folder of the Python module clogsweep, which is installed with this program. @throws Error if it is
/// missing
std::filesystem::path find_python_module();

/// Replaces this process by `python3 -m clogsweep`, so the exit code is that of the module.
/// @param name  the name that the module prints as its own
/// @param module  from find_python_module()
/// @param arguments  a command of the module, then its arguments
/// @throws Error if Python cannot be run
[[noreturn]] void become_python(const std::string& name, const std::filesystem::path& module,
                                std::vector<std::string> arguments);

/// The command as a user types it.
std::string python_command(const std::filesystem::path& module, const std::vector<std::string>& arguments);

/// Whether python3 -m clogsweep has this command.
bool is_python_command(const std::string& name);

/// Whether PATH has a program of this name.
bool is_installed(const std::string& program);

/// The folder this program is in.
std::filesystem::path own_folder();

}  // namespace clog::cli
