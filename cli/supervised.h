// Work that calls into shared libraries is done by a child process, and this one tells how it ended: a library that
// crashes, or calls exit(), ends the child alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crescent.h"

namespace crescent::cli {

/// A shared library that the work calls, and the name of its arm; "" where it is judged by itself.
struct CalledLibrary {
    std::string path, arm;
};

/// How the child ended: with an exit code of its own or, where `fault` is not "", by a library's doing, which it says.
struct ChildEnd {
    int code = 0;
    std::string fault;
};

/// Forks; to be called before there are threads. In the child it returns nothing, and the caller does the work. In the
/// parent it returns when the child has ended, and says how; SIGINT, SIGTERM and SIGHUP are passed on until then. Where
/// the system gives no process it returns nothing once, and the caller does the work itself.
std::optional<ChildEnd> done_by_child(const std::vector<CalledLibrary>& libraries, bool quiet);

/// The same for a run of an experiment into the folder `out`: the child's exit code, or nothing in the child and where
/// the experiment names no library. Throws OutputError where a library ended the child; `out` is then as it was.
std::optional<int> done_by_child(const Experiment& experiment, const std::string& out, bool quiet);

/// Notes that the process is about to end with this exit code on purpose, so that the parent does not blame a library
/// for it; returns the code. Async-signal-safe.
int ends_on_purpose(int code);

}  // namespace crescent::cli
