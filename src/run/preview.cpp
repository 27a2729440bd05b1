// The steps of a run without its jobs: what the camera sees, the reference, one plate.
#include "run/preview.h"

#include <algorithm>

#include "report/plates/plates.h"
#include "run/collect.h"
#include "run/resources.h"

namespace crescent::inline runs {

namespace {

/// Returns the scene and references of the experiment without its arms.
Experiment without_arms(Experiment e) {
    e.arms.clear();
    e.exponent.reset();
    e.furnaces.clear();
    e.published.reset();
    e.seeds = 1;
    if (e.reference.kind == ReferenceKind::note) e.reference.kind = ReferenceKind::quadrature;
    e.reference.monte_carlo = false;
    if (e.reference.kind == ReferenceKind::paired) e.reference.n = std::min<std::uint64_t>(e.reference.n, 16);
    return e;
}

}  // namespace

std::vector<unsigned char> preview(const Experiment& experiment, const Engine& engine, ProgressMonitor& monitor) {
    check_font(experiment);
    RunPlan seen = plan(without_arms(experiment));
    seen.exponents = {experiment.s()};
    const Engine with = settled(engine);
    const Prepared prepared = prepare(seen, with, monitor);
    monitor.check();
    const Metrics none;
    const PlateInputs in{seen.experiment, none, prepared.shapes, [](const RunKey&) { return nullptr; },
        [&](double s) { return reference_of(seen.experiment, prepared, s); }, with.backend->name(),
        experiment.theme.value_or(Theme::dark)};
    const Provenance p = provenance_of(seen, *with.backend, "");
    return encode_png(draw_preview(in), {{"crescent", p.version + " " + p.commit}, {"plate", "preview"}});
}

}  // namespace crescent::inline runs
