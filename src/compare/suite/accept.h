// --accept: the candidate of some views becomes the baseline, of all of them at once.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "compare/suite/suite.h"

namespace crescent {

/// Which views of a candidate become the baseline, and the statements of the manifest about it.
struct Acceptance {
    std::vector<std::string> views;      // names; empty: all that have a candidate
    std::string because, date, program;  // for the manifest
};

/// Replaces the baseline's files of these views, stored as the suite states, and writes baseline.json next to them: the
/// files with their hashes, mean and variance of each region, program, date and reason of each view. A named view
/// without renders of the candidate is removed from the baseline. `read` returns the suite; it is called again with the
/// baseline locked against others that accept. What is stored is what was measured, also if candidates are rewritten
/// meanwhile. A kill leaves the old baseline or the new one. Returns a line for each view. Throws InputError,
/// OutputError, Interrupted.
std::vector<std::string> accept_views(
    const std::function<Suite()>& read, const Acceptance& acceptance, ProgressMonitor& monitor);

}  // namespace crescent
