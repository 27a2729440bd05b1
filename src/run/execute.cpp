// Primary rays are traced once for all jobs, shading points are kept if memory allows. A job whose films are not kept
// and whose metrics are in the checkpoint is skipped; else the back end computes its films, which are measured in
// parallel.
#include "run/execute.h"

#include <algorithm>

#include "base/errors.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "metrics/flip.h"
#include "metrics/metrics.h"
#include "metrics/monte_carlo_reference.h"
#include "render/estimator.h"
#include "render/kernel.h"
#include "render/reference/paired.h"
#include "render/reference/reference.h"
#include "run/checkpoint.h"
#include "run/external_samplers.h"
#include "run/mis_warnings.h"
#include "run/plan.h"

namespace crescent {

namespace {

/// FLIP of one film of a job in each region; none if the job has none.
struct Flips {
    std::size_t film = 0;
    std::vector<double> values;
};

/// Returns whether the films of a seed have FLIP.
bool has_flip(const RunPlan& plan, std::uint32_t seed) {
    const std::vector<std::uint32_t> series = seeds_of(plan.whole);
    const auto place = static_cast<std::size_t>(std::ranges::find(series, seed) - series.begin());
    return place < static_cast<std::size_t>(std::max(plan.whole.flip_seeds, 1)) && !plan.experiment.regions.empty();
}

template <class AnyFilm> FlipImage flip_image(const AnyFilm& film) {
    return {film.width, film.height, film.r, film.g, film.b};
}

/// Computes the exposures of the references that FLIP is measured against: all jobs of an exponent share them.
std::vector<FlipExposures> exposures_of(const RunPlan& plan, const Prepared& prepared) {
    if (std::ranges::none_of(plan.seeds, [&](std::uint32_t seed) { return has_flip(plan, seed); })) return {};
    std::vector<FlipExposures> out(plan.exponents.size());
    parallel_for(std::size_t{0}, out.size(), [&](std::size_t k) {
        if (const ReferenceFilm* reference = reference_of(plan.experiment, prepared, plan.exponents[k]))
            out[k] = flip_exposures(flip_image(*reference));
    });
    return out;
}

/// Computes FLIP, which costs more than all other metrics, for the first seeds of the series at one sample count: the
/// experiment's own, at which arms are compared, or the highest.
Flips flips_of(const RunPlan& plan, const Prepared& prepared, const Job& job, const std::vector<Film>& films,
    const ReferenceFilm& reference, const std::string& isa) {
    if (!has_flip(plan, job.seed)) return {};
    const Experiment& experiment = plan.experiment;
    const ArmPlan* arm = experiment.find_arm(job.arm);
    ensure(arm != nullptr, "a job is of an arm of the experiment");
    const auto match = std::ranges::find(films, experiment.n_of(*arm), &Film::n);
    Flips out;
    out.film = match == films.end() ? films.size() - 1 : static_cast<std::size_t>(match - films.begin());
    const FlipImage test[] = {flip_image(films[out.film])};
    std::vector<AreaPixels> areas;
    for (const Region& region : experiment.regions) areas.emplace_back(region.area(), prepared.shapes);
    const auto exponent = static_cast<std::size_t>(std::ranges::find(plan.exponents, job.s) - plan.exponents.begin());
    // A part of a run brings its references along, and has no exposures.
    const FlipImage image = flip_image(reference);
    const FlipExposures exposures =
        exponent < prepared.flip_exposures.size() ? prepared.flip_exposures[exponent] : flip_exposures(image);
    out.values = mean_hdr_flips(image, exposures, test, areas, flip_pixels_per_degree, isa)[0];
    return out;
}

std::vector<RunMetrics> metrics_of(const RunPlan& plan, const Prepared& prepared, const Job& job,
    const std::vector<Film>& films, const std::string& isa) {
    const ReferenceFilm* reference = reference_of(plan.experiment, prepared, job.s);
    ensure(reference != nullptr, "references are made before the jobs that are measured against them");
    std::vector<RunMetrics> out(films.size());
    Flips flips;
    side_by_side(
        [&] {
            parallel_for(std::size_t{0}, films.size(), [&](std::size_t r) {
                const RunKey key{job.arm, films[r].n, job.s, job.seed};
                out[r] = measure(plan.experiment, key, films[r], *reference, prepared.shapes);
            });
        },
        [&] { flips = flips_of(plan, prepared, job, films, *reference, isa); });
    for (std::size_t r = 0; r < flips.values.size(); ++r) out[flips.film].regions[r].flip = flips.values[r];
    return out;
}

void compute(const RunPlan& plan, const Prepared& prepared, const Engine& engine, ProgressMonitor& monitor,
    bool keep_films, Checkpoint* checkpoint, JobResult& out) {
    const auto samples = static_cast<double>(prepared.geometry_pixels * out.job.n.back());
    if (checkpoint && !keep_films) out.metrics = checkpoint->metrics(out.job);
    if (!out.metrics.empty()) return monitor.skip(samples);
    const Stopwatch start;
    std::vector<Film> films = engine.backend->films(view_at(prepared, out.job.s), out.job, monitor);
    out.samples = samples;
    out.seconds = start.seconds();
    if (plan.references) out.metrics = metrics_of(plan, prepared, out.job, films, engine.isa);
    if (keep_films) out.films = std::move(films);
    else if (checkpoint) checkpoint->add(out.metrics);
}

/// If points are kept: makes all of them, and gives up the hits of which they were made.
void finish_points(const RunPlan& plan, Prepared& prepared, ProgressMonitor& monitor) {
    TiledScene view = view_at(prepared, prepared.scene.s());
    if (!view.keeps_points()) return;
    for_each_tile(view.tiles(), monitor, [&](std::size_t k) {
        (void)view.points(k);
        return 0.0;
    });
    view.forget_hits();
    prepared.scene.forget_hits();
    prepared.views = views_at(view, plan.exponents);
}

/// Computes the references that the experiment requests.
void compute_references(const RunPlan& plan, Prepared& prepared, const Engine& engine, ProgressMonitor& monitor) {
    const auto pixels = static_cast<double>(prepared.shapes.shape.size());
    const ReferencePlan& reference = plan.experiment.reference;
    if (reference.kind == ReferenceKind::paired) {
        monitor.begin("paired reference", pixels);
        prepared.paired = paired_reference(prepared.views, paired_plan(plan.whole), monitor);
        return;
    }
    monitor.begin("reference by quadrature", pixels);
    prepared.quadrature = quadrature_reference(prepared.scene, plan.exponents, monitor);
    if (reference.kind == ReferenceKind::quadrature && !reference.monte_carlo) return;
    monitor.begin("the article's reference", pixels);
    prepared.monte_carlo = monte_carlo_reference(prepared.views, plan.whole, engine.isa, monitor);
}

}  // namespace

Engine settled(Engine engine) {
    engine.isa = std::string(kernels_for(engine.isa).isa);
    if (engine.threads <= 0) engine.threads = usable_threads();
    if (!engine.backend) engine.backend = cpu_backend(engine.isa);
    return engine;
}

const TiledScene& view_at(const Prepared& prepared, double s) {
    const auto view = std::ranges::find(prepared.views, s, [](const TiledScene& v) { return v.scene().s(); });
    ensure(view != prepared.views.end(), "a job's exponent is one of its plan's");
    return *view;
}

std::vector<std::uint64_t> count_in_view(const Experiment& experiment, const ShapeMap& shapes) {
    std::vector<std::uint64_t> out(experiment.surface_count());
    for (const std::int16_t shape : shapes.shape)
        if (shape >= 0) ++out[static_cast<std::size_t>(shape)];
    if (std::ranges::all_of(out, [](std::uint64_t pixels) { return pixels == 0; }))
        throw InputError(experiment.place_of("camera"),
            "nothing is in view: every ray of the camera misses every shape; expected eye and target that face one");
    return out;
}

namespace {

void check_regions(const Experiment& experiment, const ShapeMap& shapes) {
    for (const Region& region : experiment.regions)
        if (AreaPixels(region.area(), shapes).count() == 0)
            throw InputError(region.location,
                fmt::format("regions.{}: the camera sees '{}' in no pixel of the {}", region.name, region.object(),
                    region.has_box ? "box" : "image"));
}

}  // namespace

Prepared look(const RunPlan& plan, const Engine& engine) {
    const Experiment& experiment = plan.experiment;
    if (engine.backend) engine.backend->check(experiment);
    check_memory(experiment);
    Prepared out(experiment);
    on_threads(threads_to_be_had(settled(engine).threads), [&] {
        out.scene.remember_primaries();
        out.shapes = shape_map(out.scene);
    });
    out.shape_pixels = count_in_view(experiment, out.shapes);
    check_regions(experiment, out.shapes);
    for (const std::uint64_t pixels : out.shape_pixels) out.geometry_pixels += pixels;
    out.outside = open_external(experiment, engine.timeout_s, engine.samplers);
    TiledScene view = out.scene;
    if (can_keep_points(plan, out.scene, available_memory())) view.keep_points();
    out.views = views_at(view, plan.exponents);
    return out;
}

void log_warnings(const RunPlan& plan, const Prepared& prepared, ProgressMonitor& monitor) {
    for (const std::string& line : mis_warnings(plan.experiment, prepared.outside)) monitor.warn(line);
}

void add_references(const RunPlan& plan, Prepared& prepared, const Engine& engine, ProgressMonitor& monitor) {
    if (!plan.references) return;
    const Engine settled_engine = settled(engine);
    prepared.stopped = !unless_stopped(settled_engine.threads, monitor, [&] {
        compute_references(plan, prepared, settled_engine, monitor);
        prepared.flip_exposures = exposures_of(plan, prepared);
        finish_points(plan, prepared, monitor);
    });
}

Prepared prepare(const RunPlan& plan, const Engine& engine, ProgressMonitor& monitor) {
    Prepared out = look(plan, engine);
    add_references(plan, out, engine, monitor);
    return out;
}

Job with_sampler(Job job, const Prepared& prepared) {
    const auto external = prepared.outside.find(job.arm);
    if (external != prepared.outside.end()) job.outside = external->second;
    return job;
}

JobResult execute(const RunPlan& plan, const Prepared& prepared, const Job& job, const Engine& engine,
    ProgressMonitor& monitor, bool keep_films, Checkpoint* checkpoint) {
    const Engine settled_engine = settled(engine);
    JobResult out;
    out.job = with_sampler(job, prepared);
    out.stopped = !unless_stopped(settled_engine.threads, monitor,
        [&] { compute(plan, prepared, settled_engine, monitor, keep_films, checkpoint, out); });
    return out;
}

}  // namespace crescent
