// Third step of a run: computes every number of the run from the results of its jobs, in memory. Results may come in
// any order, and from other threads or machines.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "metrics/article_checks.h"
#include "metrics/metrics.h"
#include "report/report.h"
#include "run/execute.h"
#include "samplers/sampler_adapter.h"

namespace crescent {

/// Everything that a run measured, without references to other objects.
struct Measured {
    Experiment experiment;  // as in the plan
    Metrics metrics;        // assertions on plates are not checked yet: no plates are drawn
    Evidence evidence;
    Provenance provenance;
    Timing timing;
    ShapeMap shapes;
    std::vector<std::pair<RunKey, Film>> films;                  // of the jobs whose films were kept
    std::vector<ReferenceFilm> quadrature, monte_carlo, paired;  // one per exponent; none if not requested
    Plates plates;                                               // none before write()
    ExternalSamplers outside;                                    // plates evaluate their densities
    bool stopped = false;

    const Film* film(const RunKey& key) const;       // null: not kept
    const ReferenceFilm* reference(double s) const;  // the one that the metrics use; null: not computed
};

/// What is measured in addition to the jobs.
struct CollectOptions {
    std::string command;  // as typed, for the provenance; "": `crescent run` and the experiment's file
    bool studies = true;  // tails, furnaces, article checks; without them only the metrics of the jobs
};

/// Takes ownership of the inputs; `results` may be a part of the plan's.
Measured collect(const RunPlan& plan, Prepared prepared, std::vector<JobResult> results, const Engine& engine,
    ProgressMonitor& monitor, const CollectOptions& options = {});

/// Returns the tail index of one arm's samples X in an area, from at most about four million samples; none if too few
/// vary. May throw Interrupted.
std::optional<Tail> region_tail(
    const Scene& scene, const Job& job, const AreaPixels& pixels, const std::string& isa, ProgressMonitor& monitor);

/// Computes what follows from the metrics of all seeds: bands, ladders, and the assertions that need no plate.
void add_spreads(Measured& result);

/// Returns the provenance of a plan's outputs: its experiment, seeds, version, back end and command.
Provenance provenance_of(const RunPlan& plan, const Backend& backend, const std::string& command);

}  // namespace crescent
