// The steps of a run in one call: plan, execute, collect, write.
#pragma once

#include <memory>
#include <string>

#include "base/progress.h"
#include "experiment/experiment.h"
#include "run/backend.h"
#include "run/collect.h"
#include "run/execute.h"
#include "run/plan.h"
#include "run/write.h"

namespace crescent::inline runs {

/// How a run is made, beside what the experiment says.
struct RunOptions {
    std::string out = "out";
    int threads = 0;           // 0: as many as this process may use
    std::string isa;           // "": the best this machine has
    std::string command;       // as typed, for the provenance
    double keep_after_s = 10;  // passes and runs that take longer keep what they have finished, see checkpoint.h
    std::shared_ptr<Backend> backend;  // null: the CPU
    double timeout_s = 0;              // for one answer of a program or plugin; 0: 10 and 60 s
    OutputParts parts;
    SeedRange seeds;
};

/// What a run measured, as it was written.
struct RunResult {
    Metrics metrics;
    Timing timing;
    Provenance provenance;
    std::string summary;  // for the terminal
};

/// Runs `experiment` and writes nothing. Throws Interrupted where the monitor says so.
Measured measure_in_memory(const Experiment& experiment, const RunOptions& options, ProgressMonitor& monitor);

/// Runs `experiment` and writes everything under options.out; outputs appear whole or not at all. Throws Interrupted.
RunResult run(const Experiment& experiment, const RunOptions& options, ProgressMonitor& monitor);

}  // namespace crescent::inline runs
