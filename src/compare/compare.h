// crescent compare: renders of other programs -> meters with their doubt, bias tests, plates, report.
#pragma once

#include "base/progress_monitor.h"
#include "compare/outputs.h"
#include "compare/plan.h"
#include "compare/results.h"

namespace crescent::inline comparing {

/// Where the outputs go.
struct CompareOptions {
    std::string out = "out/compare";
};

/// Reads, measures and writes everything under options.out; outputs appear whole or not at all. `summary` is for the
/// terminal. Throws InputError, OutputError, Interrupted.
CompareResult compare(const ComparePlan& plan, const CompareOptions& options, const Provenance& provenance,
    ProgressMonitor& monitor, std::string& summary);

}  // namespace crescent::inline comparing
