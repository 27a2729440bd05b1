// A run in memory: an experiment made in code, its steps called one by one, the RMSE of two arms with its interval over
// seeds. No file is read or written. `in_memory stop` sets the stop flag during the run, as a host's button would.
#include <cstdio>
#include <cstring>

#include <crescent/crescent.h>

namespace {

crescent::Shape ball() {
    crescent::Shape shape;
    shape.name = "ball";
    shape.form = crescent::shapes::Sphere{{0, 1, 0}, 1};
    shape.material.rho_d = {0.2, 0.2, 0.2};
    shape.material.rho_s = 0.1;
    shape.material.brdf = crescent::lobe_named("phong");
    shape.material.s = 40;
    shape.occludes = true;
    return shape;
}

crescent::Experiment two_arms() {
    crescent::Experiment e;
    e.title = "two arms on a glossy ball";
    e.file = "made-in-code.toml";
    e.seed = 7;
    e.seeds = 12;
    e.image = {96, 64};
    e.camera = {{0, 1, 4}, {0, 1, 0}, {0, 1, 0}, 40};
    e.shapes = {ball()};
    e.fill = {0.3, 0.3, 0.3};
    crescent::DiskLight area_light;
    area_light.name = "lamp";
    area_light.center = {1, 3, 2};
    area_light.normal = crescent::normalize(crescent::Vec3d{-1, -2, -2});
    area_light.radius = 0.5;
    area_light.radiance = {40, 40, 40};
    e.disks = {area_light};
    e.arms = {{"by the cosine", "cosine", {4, 16}, {}}, {"by the lobe", "phong", {4, 16}, {}}};
    e.regions = {{"ball", {32, 16, 64, 48}, {}}};
    return e;
}

}  // namespace

int main(int argc, char** argv) {
    const bool stop = argc > 1 && std::strcmp(argv[1], "stop") == 0;
    const crescent::RunPlan plan = crescent::plan(two_arms());
    const crescent::Engine engine{.threads = 2};
    crescent::PolledMonitor monitor;  // its state() may be read, and its `stop` be set, from any thread
    crescent::Prepared prepared = crescent::prepare(plan, engine, monitor);

    std::vector<crescent::JobResult> results;
    for (const crescent::Job& job : plan.jobs) {
        if (stop && results.size() == 3) monitor.stop = true;
        results.push_back(crescent::execute(plan, prepared, job, engine, monitor));
        if (results.back().stopped) {
            std::printf("stopped after %zu of %zu jobs\n", results.size() - 1, plan.jobs.size());
            return 130;
        }
    }
    const crescent::Measured measured =
        crescent::collect(plan, std::move(prepared), std::move(results), engine, monitor);

    for (const crescent::SeedSpread& band : measured.metrics.bands)
        if (band.metric == "rmse.ball" && band.key.n == 16)
            std::printf("%s: RMSE %.4g, 5 to 95 %% of %d seeds: %.4g to %.4g%s\n", band.key.arm.c_str(), band.measured,
                band.band.seeds, band.band.q05, band.band.q95, band.band.heavy ? " (heavy tail)" : "");
}
