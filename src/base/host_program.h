// The program that this code starts as a child process for work that may end it: plugins, and decoders of files.
#pragma once

#include <string>

namespace crescent {

/// Its name where it is a program of its own, next to a library that contains this code (the Python module).
inline constexpr const char* host_program_name = "crescent-plugin-host";

/// Returns the program to execute: the one that contains this code, or the small one next to the library that contains
/// it, or one in PATH. CRESCENT_PLUGIN_HOST overrides it. What it does depends on its first argument.
std::string host_program();

}  // namespace crescent
