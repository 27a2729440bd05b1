// Parses the command line into the chosen command with its flags.
#pragma once

#include <functional>

namespace crescent::cli {

/// Returns the work that the command line requests. For a wrong command line, prints the error to stderr with the
/// nearest valid word; its work returns Exit::misused.
std::function<int()> parse(int argc, char** argv);

}  // namespace crescent::cli
