// Third step of a run: the results of its jobs -> every number of the run, in memory. Results may come in any order,
// and from other threads or machines.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "metrics/article_checks.h"
#include "metrics/metrics.h"
#include "report/report.h"
#include "run/execute.h"
#include "samplers/external_sampler.h"

namespace crescent::inline runs {

/// Everything that a run measured; nothing in it refers to something outside.
struct Measured {
    Experiment experiment;  // as in the plan
    Metrics metrics;        // assertions on plates are not judged: none are drawn yet
    Evidence evidence;
    Provenance provenance;
    Timing timing;
    ShapeMap shapes;
    std::vector<std::pair<RunKey, Film>> films;          // of the jobs whose films were kept
    std::vector<ReferenceFilm> quadrature, monte_carlo;  // one an exponent; none where not asked for
    Plates plates;                                       // none before write()
    ExternalSamplers outside;                            // plates ask them for their densities
    bool stopped = false;

    const Film* film(const RunKey& key) const;       // null: not kept
    const ReferenceFilm* reference(double s) const;  // the one that the metrics use; null: not made
};

/// What is measured beside the jobs.
struct CollectOptions {
    std::string command;  // as typed, for the provenance; "": `crescent run` and the experiment's file
    bool studies = true;  // tails, furnaces, evidence; without them the metrics of the jobs alone
};

/// Takes what was made; `results` need not be all of the plan's.
Measured collect(const RunPlan& plan, Prepared prepared, std::vector<JobResult> results, const Engine& engine,
    ProgressMonitor& monitor, const CollectOptions& options = {});

/// The tail index of one arm's samples X in a box, read off as many samples as about four million allow; none where too
/// few spread. May throw Interrupted.
std::optional<Tail> region_tail(
    const Scene& scene, const Job& job, const Box& box, const std::string& isa, ProgressMonitor& monitor);

/// What follows from the metrics of all seeds: bands, ladders, and the assertions that need no plate.
void add_spreads(Measured& measured);

/// What made the outputs of a plan: its experiment, seeds, version, back end and command.
Provenance provenance_of(const RunPlan& plan, const Backend& backend, const std::string& command);

}  // namespace crescent::inline runs
