// The command line as words -> the chosen command with its flags.
#pragma once

#include <functional>

namespace crescent::cli {

/// The work that the command line asks for. A wrong command line is answered on stderr, with the nearest valid word,
/// and its work returns Exit::misused.
std::function<int()> parse(int argc, char** argv);

}  // namespace crescent::cli
