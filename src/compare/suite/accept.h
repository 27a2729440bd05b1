// --accept: the candidate of some views becomes the baseline, of all of them at once.
#pragma once

#include <string>
#include <vector>

#include "compare/suite/suite.h"

namespace crescent::inline comparison {

/// Which views of a candidate become the baseline, and the statements of the manifest about it.
struct Acceptance {
    std::vector<std::string> views;      // names; empty: all that have a candidate
    std::string because, date, program;  // for the manifest
};

/// Replaces the baseline's files of these views, stored as the suite states, and writes baseline.json next to them: the
/// files with their hashes, mean and variance of each region, program, date and reason of each view. A kill leaves the
/// old baseline or the new one. Returns a line for each accepted view. Throws InputError, OutputError, Interrupted.
std::vector<std::string> accept_views(const Suite& suite, const Acceptance& acceptance, ProgressMonitor& monitor);

/// Returns the folder of the baseline: the part before the first wildcard of its first pattern.
std::string baseline_folder(const Suite& suite);

}  // namespace crescent::inline comparison
