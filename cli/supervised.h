// Work that calls into shared libraries is done by a child process, and this one tells how it ended: a library that
// crashes, or calls exit(), ends the child alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crescent.h"

namespace crescent::cli {

/// A library that the work calls, and the arm that it is; "": it is judged by itself.
struct CalledLibrary {
    std::string path, arm;
};

/// How the child ended: with an exit code that was meant, or, where `fault` is not "", by what a library did.
struct ChildEnd {
    int code = 0;
    std::string fault;
};

/// Call it before there are threads. It returns twice: nothing in the child, which goes on with the work, and in this
/// process, once the child has ended, how. SIGINT, SIGTERM and SIGHUP go to the child meanwhile. Where no process is to
/// be had it returns once, nothing, and the work is done here.
std::optional<ChildEnd> done_by_child(const std::vector<CalledLibrary>& libraries, bool quiet);

/// The same for the work on an experiment whose outputs go to the folder `out`; nothing where it names no library.
/// Gives the child's exit code. Throws OutputError where a library ended the child; what stood in `out` stands as
/// before then.
std::optional<int> done_by_child(const Experiment& experiment, const std::string& out, bool quiet);

/// To be called by all that ends the process on purpose, with the exit code, which it returns; async-signal-safe.
int ends_on_purpose(int code);

}  // namespace crescent::cli
