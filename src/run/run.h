// The steps of a run in one call: plan, execute, collect, write.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "base/progress.h"
#include "experiment/experiment.h"
#include "run/backend.h"
#include "run/collect.h"
#include "run/execute.h"
#include "run/plan.h"
#include "run/write.h"

namespace crescent {

/// The options of a run that are not in the experiment.
struct RunOptions {
    std::string out = "out";
    int threads = 0;                   // 0: as many as this process may use
    std::string isa;                   // "": the best this machine has
    std::string command;               // as typed, for the provenance
    double keep_after_s = 10;          // longer runs keep the passes that they have finished, see checkpoint.h
    std::shared_ptr<Backend> backend;  // null: the CPU
    double timeout_s = 0;              // for one response of a program or plugin; 0: 10 and 60 s
    OutputParts parts;
    SeedRange seeds;
    bool references = true;    // false: films of the first seed alone, without metrics, plates and report
    bool studies = true;       // tails, furnaces and article checks, which need references
    std::size_t columns = 80;  // of the summary, where longer lines are cut; 0: none is cut
};

/// The measurements of a run, as they were written.
struct RunResult {
    Metrics metrics;
    Timing timing;
    Provenance provenance;
    std::string summary;  // for the terminal
};

/// Begins the stage of a seed, "seed 3 of 16", if this job of the plan is its first; units are samples. `pixels`: those
/// that show geometry.
void begin_seed(const RunPlan& plan, std::size_t job, std::uint64_t pixels, ProgressMonitor& monitor);

/// Runs `experiment` and writes nothing. Throws Interrupted if the monitor requests it.
Measured measure_in_memory(const Experiment& experiment, const RunOptions& options, ProgressMonitor& monitor);

/// Runs `experiment` and writes everything under options.out; outputs appear all at once or not at all. Throws
/// Interrupted.
RunResult run(const Experiment& experiment, const RunOptions& options, ProgressMonitor& monitor);

}  // namespace crescent
