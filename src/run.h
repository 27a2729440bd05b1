// One run from experiment to report: the order in which the parts are called, and what is written where.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/watch.h"
#include "experiment/experiment.h"
#include "films/film.h"
#include "instruments.h"
#include "meters/evidence.h"
#include "meters/metrics.h"
#include "report/report.h"

namespace crescent {

struct RunOptions {
    std::string out = "out";
    int threads = 0;           // 0: as many as the machine has
    std::string isa;           // "": the best this machine has
    std::string command;       // as typed, for the provenance
    double keep_after_s = 10;  // passes and runs that take longer keep what they have finished, see kept.h
    std::shared_ptr<Instrument> instrument;  // null: the CPU
};

struct RunResult {
    Metrics metrics;
    Timing timing;
    Provenance provenance;
    std::string summary;  // for the terminal
};

/// What a run measures, in memory.
struct Measured {
    Metrics metrics;  // assertions on plates fail: there are none
    Evidence evidence;
    Provenance provenance;
    ShapeMap shapes;
    std::vector<std::pair<RunKey, Film>> films;  // of the experiment's own seed
    std::vector<ReferenceFilm> references;       // the kind that the meters use, one an exponent
};
/// Runs `experiment` and writes nothing.
Measured measure_in_memory(const Experiment& experiment, const RunOptions& options, Watch& watch);

/// Runs `experiment` and writes everything under options.out; outputs appear whole or not at all.
RunResult run(const Experiment& experiment, const RunOptions& options, Watch& watch);

}  // namespace crescent
