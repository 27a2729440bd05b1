// Second step of a run: what all jobs share, then one job after another, which gives films and metrics.
//
// This and the later steps do not throw when the ProgressMonitor requests a stop: the result says `stopped` and its
// contents are not valid. InputError and OutputError are thrown as everywhere. No step changes anything global to the
// process (signals, locale, thread pools); each may be called from several threads with plans of their own.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "experiment/experiment.h"
#include "metrics/flip.h"
#include "metrics/metrics.h"
#include "render/film.h"
#include "render/tiles.h"
#include "run/backend.h"
#include "run/plan.h"
#include "samplers/sampler_adapter.h"
#include "scene/scene.h"

namespace crescent {

class Checkpoint;

/// The resources of a run. Films, references and metrics have the same bits for all values except the back end.
struct Engine {
    int threads = 0;                     // 0: usable_threads()
    std::string isa{};                   // a name of isas(); "": the best of this machine
    std::shared_ptr<Backend> backend{};  // null: the CPU
    double timeout_s = 0;                // for one answer of a program or plugin; 0: 10 and 60 s
    ExternalSamplers samplers{};         // of the caller, by arm: these are not opened
};
/// Returns the engine with all defaults filled in. Throws InputError if the instruction set is unknown or unsupported.
Engine settled(Engine engine);

/// Shared by all jobs of a plan.
struct Prepared {
    /// Nothing is prepared yet except the scene.
    explicit Prepared(const Experiment& experiment) : scene(experiment) {}

    Scene scene;                    // at the experiment's own s
    std::vector<TiledScene> views;  // the scene at each exponent, in the plan's order
    ExternalSamplers outside;
    ShapeMap shapes;
    std::vector<std::uint64_t> shape_pixels;  // of each shape, in the experiment's order
    std::uint64_t geometry_pixels = 0;
    std::vector<ReferenceFilm> quadrature, monte_carlo, paired;  // one per exponent, in the plan's order
    std::vector<FlipExposures> flip_exposures;  // of the same that the metrics use; none if no film has FLIP
    bool stopped = false;
};

/// The pixels of each shape, in the experiment's order. Throws InputError if the camera sees nothing.
std::vector<std::uint64_t> count_in_view(const Experiment& experiment, const ShapeMap& shapes);

/// Prepares what the camera sees, and the samplers that are not built in. Throws InputError if it sees nothing,
/// OutputError if memory is insufficient or a sampler does not start.
Prepared look(const RunPlan& plan, const Engine& engine = {});
/// Logs a warning for each arm whose films will be wrong although they can be made: weights of MIS that lose light.
void log_warnings(const RunPlan& plan, const Prepared& prepared, ProgressMonitor& monitor);
/// Adds the references that the experiment requests, unless the plan has none.
void add_references(const RunPlan& plan, Prepared& prepared, const Engine& engine, ProgressMonitor& monitor);
/// Does both steps.
Prepared prepare(const RunPlan& plan, const Engine& engine, ProgressMonitor& monitor);

/// The films and metrics of a job.
struct JobResult {
    Job job;
    std::vector<RunMetrics> metrics;  // one per sample count; collect() adds tails; none without references
    std::vector<Film> films;          // one per sample count; none if they were not requested
    double samples = 0;               // number drawn in this call
    double seconds = 0;               // of its films, without their metrics
    bool stopped = false;
};

/// Returns the job with the sampler that was opened for its arm, if the arm is not built in.
Job with_sampler(Job job, const Prepared& prepared);

/// Returns the prepared view at exponent s, which is one of the plan's.
const TiledScene& view_at(const Prepared& prepared, double s);

/// Runs one job. `keep_films` = false: only its metrics, which a checkpoint may hold already and which it keeps.
JobResult execute(const RunPlan& plan, const Prepared& prepared, const Job& job, const Engine& engine,
    ProgressMonitor& monitor, bool keep_films = true, Checkpoint* checkpoint = nullptr);

/// Returns the reference that the metrics of exponent s use, of what a run has prepared or measured; null if none was
/// computed.
template <class Run> const ReferenceFilm* reference_of(const Experiment& experiment, const Run& run, double s) {
    const std::vector<ReferenceFilm>& films = experiment.reference.kind == ReferenceKind::quadrature ? run.quadrature
        : experiment.reference.kind == ReferenceKind::paired                                         ? run.paired
                                                                                                     : run.monte_carlo;
    const auto film = std::ranges::find(films, s, &ReferenceFilm::s);
    return film == films.end() ? nullptr : &*film;
}

}  // namespace crescent
