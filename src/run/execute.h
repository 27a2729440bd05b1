// Second step of a run: what all jobs look at and are measured against, then one job after another -> films and
// metrics.
//
// Of these and the later steps: a stop that the ProgressMonitor was asked for is no exception. What is returned says
// `stopped` and holds nothing that can be relied on. InputError and OutputError are thrown as everywhere. No step
// changes anything that belongs to the process: signals, locale, thread pools; each may be called from several threads
// with plans of their own.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "metrics/metrics.h"
#include "render/film.h"
#include "render/tiles.h"
#include "run/backend.h"
#include "run/plan.h"
#include "scene/scene.h"

namespace crescent::inline runs {

class Checkpoint;

/// What a run is computed with. Films, references and metrics are the same bits whatever it says, but for the
/// back end.
struct Engine {
    int threads = 0;                     // 0: usable_threads()
    std::string isa{};                   // a name of isas(); "": the best of this machine
    std::shared_ptr<Backend> backend{};  // null: the CPU
    double timeout_s = 0;                // for one answer of a program or plugin; 0: 10 and 60 s
    ExternalSamplers samplers{};         // of the caller, by arm: these are not opened
};
/// With nothing left open. Throws InputError where the instruction set is not known or not here.
Engine settled(Engine engine);

/// What all jobs of a plan share.
struct Prepared {
    explicit Prepared(const Experiment& experiment) : scene(experiment) {}

    Scene scene;                    // at the experiment's own s
    std::vector<TiledScene> views;  // of it at each exponent, in the plan's order
    ExternalSamplers outside;
    ShapeMap shapes;
    std::vector<std::uint64_t> shape_pixels;  // of each shape, in the experiment's order
    std::uint64_t geometry_pixels = 0;
    std::vector<ReferenceFilm> quadrature, monte_carlo;  // one an exponent, in the plan's order
    bool stopped = false;
};

/// What the camera sees, and the samplers that are not built in. Throws InputError where it sees nothing,
/// OutputError where the machine has not the memory or a sampler does not start.
Prepared look(const RunPlan& plan, const Engine& engine = {});
/// Adds the references that the experiment asks for. A checkpoint keeps what is finished.
void add_references(const RunPlan& plan, Prepared& prepared, const Engine& engine, ProgressMonitor& monitor,
    Checkpoint* checkpoint = nullptr);
/// Both of them.
Prepared prepare(const RunPlan& plan, const Engine& engine, ProgressMonitor& monitor);

struct JobResult {
    Job job;
    std::vector<RunMetrics> metrics;  // one a sample count; tails come with collect()
    std::vector<Film> films;          // one a sample count; none where they were not asked for
    double samples = 0;               // that were drawn now
    double seconds = 0;
    bool stopped = false;
};

/// The job with the sampler that was opened for its arm, where the arm is none of the list.
Job with_sampler(Job job, const Prepared& prepared);

/// The prepared view at exponent s, which is one of the plan's.
const TiledScene& view_at(const Prepared& prepared, double s);

/// One job. `keep_films` = false: its metrics alone, which a checkpoint may hold already.
JobResult execute(const RunPlan& plan, const Prepared& prepared, const Job& job, const Engine& engine,
    ProgressMonitor& monitor, bool keep_films = true, Checkpoint* checkpoint = nullptr);

/// The reference that the metrics of exponent s use; null where none was made.
const ReferenceFilm* reference_of(const Experiment& experiment, const std::vector<ReferenceFilm>& quadrature,
    const std::vector<ReferenceFilm>& monte_carlo, double s);

}  // namespace crescent::inline runs
