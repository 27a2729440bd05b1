// A small run for the tests of this folder: two arms, two regions, three seeds, one plate, article checks. Each test
// changes the part that it tests.
#pragma once

#include <stdexcept>

#include "report/report.h"

namespace crescent::testing {

struct Sample {
    Experiment experiment;
    Metrics metrics;
    Evidence evidence;
    Provenance provenance;
    Timing timing;
    std::map<std::string, std::vector<unsigned char>> plates;

    Sample();
    ReportInputs inputs() const { return {experiment, metrics, evidence, provenance, plates}; }
    std::string html() const { return report_html(inputs()); }
    /// The metric of a region at one seed, which may be changed.
    RegionMetrics& region(const std::string& arm, const std::string& name, std::uint32_t seed);
    SeedSpread& band(const std::string& arm, const std::string& metric);
};

inline void add_band(Sample& s, const RunKey& key, const std::string& metric, double value, double published) {
    SeedSpread b;
    b.key = key;
    b.metric = metric;
    b.measured = value;
    b.band = {0.9 * value, value, 1.1 * value, 3, false};
    b.published = published;
    b.published_rank = published > value ? 1 : 0;
    s.metrics.bands.push_back(b);
}

inline void add_run(Sample& s, const std::string& arm, double in_h, double in_s) {
    for (const std::uint32_t seed : {7u, 8u, 9u}) {
        RunMetrics run;
        run.key = {arm, 64, 32, seed};
        run.regions = {{"H", in_h, in_h * in_h, 100, {}}, {"S", in_s, in_s * in_s, 400, {}}};
        if (seed == 7)
            for (RegionMetrics& r : run.regions) r.tail = Tail{0.1, 0.02, 50};
        run.fireflies = 12;
        run.y_mean = 0.5;
        run.rmse_frame = 1.25;
        run.largest = 1000;
        s.metrics.runs.push_back(run);
    }
    const RunKey key{arm, 64, 32, 7};
    add_band(s, key, "rmse.H", in_h, 1.3 * in_h);
    add_band(s, key, "rmse.S", in_s, in_s);
    add_band(s, key, "fireflies", 12, 12);
    s.metrics.ladders.push_back({arm, "H", 32, {16, 64}, {2 * in_h, in_h}, -0.5, -0.52, -0.48, false});
    s.metrics.film_hashes[arm + " n=64 s=32"] = "0123456789abcdef";
}

inline Experiment sample_experiment() {
    Experiment experiment;
    experiment.file = "a.toml";
    experiment.title = "A sample";
    experiment.seed = 7;
    experiment.seeds = 3;
    experiment.image = {32, 32};
    Shape ball;
    ball.name = "ball";
    ball.form = shapes::Sphere{{0, 0, 0}, 1};
    ball.material = {{0.2, 0.2, 0.2}, 0.1, lobe_named("phong"), 32, {}};
    experiment.shapes = {ball};
    DiskLight key;
    key.name = "key";
    key.radius = 0.1;
    experiment.disks = {key};
    experiment.arms = {{"cosine", "cosine", {16, 64}, {}}, {"phong", "phong", {16, 64}, {}}};
    experiment.exponent = ExponentControl{"phong", 64, {32}, "ball", {}};
    experiment.regions = {{"H", {0, 0, 9, 9}, {}}, {"S", {0, 10, 19, 29}, {}}};
    PlatePlan plate;
    plate.name = "hero";
    plate.caption = "A hero";
    experiment.plates = {plate};
    return experiment;
}

inline Evidence sample_evidence() {
    Evidence e;
    e.s = 32;
    e.rho_d = 0.2;
    e.rho_s = 0.1;
    e.expected = 0.3;
    e.furnace = {
        {"float32", 24, 1024, 0.18, 0.19, 0.2, 0.21, 0.28}, {"float64", 53, 1024, 0.18, 0.19, 0.201, 0.21, 0.28}};
    e.caps = {{24, 0.23}, {53, 0.28}};
    e.lost = {{0, 0, 0.001, 0}, {60, 0.2505, 0.001, 0.25}};
    e.rejections = {{2, 1.0 / 3, 100000, 1000, 11, 0.006, 0.02}, {32, 0.939, 100000, 1000, 780, 0.75, 0.81}};
    return e;
}

inline Sample::Sample() : experiment(sample_experiment()), evidence(sample_evidence()) {
    plates["hero"] = {1, 2, 3, 4};
    add_run(*this, "cosine", 6, 0.25);
    add_run(*this, "phong", 2, 1);
    metrics.furnaces = {{"cosine combined", "cosine", "combined", 1024, 0.301, 0.3, 0.001, Tail{-0.2, 0.1, 20}, 0, 0.3},
        {"phong combined", "phong", "combined", 1024, 0.2, 0.3, 0.05, Tail{0.94, 0.05, 20}, 0, {}}};
    metrics.references = {{32, "H", 0.01, 0.01, 1e-9, 0.002}};
    metrics.assertions = {{"phong is better in H", true, 2, 6, "<", "rmse.H(phong) < rmse.H(cosine)"},
        {"no bad samples", true, 0, 0, "==", "bad == 0"}};
    metrics.shape_pixels = {{"ball", 500}};
    metrics.geometry_pixels = 500;
    provenance = {
        "1.2.3", "abc", "GNU 12.2.0", "a.toml", "00ff", "CPU", "crescent run a.toml --seeds 3", {7, 8, 9}, {}};
    timing.estimating_s = 1.5;
    timing.total_s = 2.5;
    timing.threads = 2;
    timing.isa = "AVX2";
    timing.arms = {{"cosine", 64, 32, 4'000'000, 0.5}};
    timing.stages = {{"estimating", 1.5}};
}

inline RegionMetrics& Sample::region(const std::string& arm, const std::string& name, std::uint32_t seed) {
    for (RunMetrics& run : metrics.runs)
        if (run.key.arm == arm && run.key.seed == seed)
            for (RegionMetrics& r : run.regions)
                if (r.region == name) return r;
    throw std::out_of_range(arm + " " + name);
}

inline SeedSpread& Sample::band(const std::string& arm, const std::string& metric) {
    for (SeedSpread& b : metrics.bands)
        if (b.key.arm == arm && b.metric == metric) return b;
    throw std::out_of_range(arm + " " + metric);
}

}  // namespace crescent::testing
