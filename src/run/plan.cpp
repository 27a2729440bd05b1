// Seeds are seed_of(seed, k) for k = 0, 1, ..., without duplicates. Jobs are ordered by seed, then arms in the
// experiment's order, then the exponent control; the exponents are collected from the jobs.
#include "run/plan.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "base/errors.h"
#include "base/machine.h"
#include "experiment/identity.h"
#include "math/simd/random.h"
#include "render/film.h"
#include "render/tiles.h"

namespace crescent {

std::vector<std::uint32_t> seeds_of(const Experiment& experiment) {
    std::vector<std::uint32_t> series;
    for (std::uint32_t k = 0; series.size() < static_cast<std::size_t>(experiment.seeds); ++k)
        if (const std::uint32_t seed = seed_of(experiment.seed, k); std::ranges::find(series, seed) == series.end())
            series.push_back(seed);
    return series;
}

std::vector<Job> jobs_of(const Experiment& experiment, std::uint32_t seed) {
    std::vector<Job> jobs;
    const double exponent = experiment.s();
    for (const ArmPlan& arm : experiment.arms) jobs.push_back({arm.name, arm.sampler, arm.n, exponent, seed});
    if (!experiment.exponent) return jobs;
    const ExponentControl& control = *experiment.exponent;
    const ArmPlan& arm = *experiment.find_arm(control.arm);
    for (double s : control.s) {
        const bool is_planned = s == exponent && std::ranges::find(arm.n, control.n) != arm.n.end();
        if (!is_planned) jobs.push_back({arm.name, arm.sampler, {control.n}, s, seed});
    }
    return jobs;
}

RunPlan plan(const Experiment& experiment, SeedRange range) {
    RunPlan out;
    out.whole = out.experiment = with_files(experiment);
    out.hash = hash(out.whole);
    if (range.last == 0) range.last = experiment.seeds;
    if (range.first < 1 || range.first > range.last || range.last > experiment.seeds)
        throw InputError({"--seed-range", 0, 0},
            fmt::format("expected seeds within 1:{}, the series of the experiment, not {}:{}", experiment.seeds,
                range.first, range.last));
    out.range = range;
    const std::vector<std::uint32_t> series = seeds_of(experiment);
    out.seeds.assign(series.begin() + (range.first - 1), series.begin() + range.last);
    out.experiment.seed = out.seeds.front();
    out.experiment.seeds = static_cast<int>(out.seeds.size());
    for (const std::uint32_t seed : out.seeds)
        for (Job& job : jobs_of(out.experiment, seed)) {
            if (std::ranges::find(out.exponents, job.s) == out.exponents.end()) out.exponents.push_back(job.s);
            out.jobs.push_back(std::move(job));
        }
    return out;
}

// ---- Memory is the larger of two moments: the last references are made from the hits of the primary rays, which are
// then given up; the last films are measured. Kept points live until then. Four bytes per pixel for each plane of each
// film and reference. The suggested image fits into 90 % of the available memory.

namespace {

// Code, fonts, plates and the report: 20 to 35 MB on the experiments of this repository.
constexpr double base_bytes = 34e6;
constexpr double of_shape_map = 2;               // bytes per pixel
constexpr double of_shapes = 4;                  // the same, of Scene::remember_primaries without whole hits
constexpr double of_luminance = sizeof(double);  // the same, while FLIP looks for its exposures

double pixels_of(const Experiment& experiment) {
    return static_cast<double>(experiment.image.width) * experiment.image.height;
}

double pixels_that_fit(double pixels, double needed_bytes, double available_bytes) {
    const double bytes_per_pixel = (needed_bytes - base_bytes) / pixels;
    return std::max(0.0, (0.9 * available_bytes - base_bytes) / bytes_per_pixel);
}

/// Bytes per pixel of everything that lives from the references on.
double of_references(const Experiment& experiment, std::size_t exponents) {
    const ReferencePlan& reference = experiment.reference;
    const bool has_two =
        reference.kind != ReferenceKind::paired && (reference.monte_carlo || reference.kind == ReferenceKind::note);
    return (has_two ? 2.0 : 1.0) * 4.0 * static_cast<double>(ReferenceFilm().planes().size() * exponents);
}

/// Of the sky's distribution and of the triangles that emit; their files are in memory already.
double of_emitters(const Experiment& experiment) {
    double bytes = 0;
    // One float of a texel, and the guides that find it.
    if (experiment.sky && experiment.sky->image) bytes += 8.0 * static_cast<double>(experiment.sky->image->texels());
    for (const MeshObject& mesh : experiment.meshes) {
        if (!mesh.emits() || !mesh.pack) continue;
        const double copies =
            static_cast<double>(std::max<std::size_t>(1, mesh.instances.size())) * (mesh.two_sided ? 2 : 1);
        constexpr double of_triangle = 400;  // with its nodes in the tree of emitting triangles
        bytes += copies * of_triangle * static_cast<double>(mesh.pack->mesh.triangles.size());
    }
    return bytes;
}

}  // namespace

std::uint64_t memory_needed(const Experiment& experiment, std::uint64_t points) {
    double sample_counts = 0, largest_count = 0;
    std::set<double> exponents;
    for (const Job& job : jobs_of(experiment, experiment.seed)) {
        sample_counts += static_cast<double>(job.n.size());
        largest_count = std::max(largest_count, static_cast<double>(job.n.size()));
        exponents.insert(job.s);
    }
    const double pixels = pixels_of(experiment), working_count = experiment.seeds > 1 ? largest_count : 0;
    const double film = 4.0 * static_cast<double>(Film().planes().size());
    const bool keeps_hits = pixels <= static_cast<double>(Scene::whole_hits);
    const double constant_bytes = of_references(experiment, exponents.size()) + of_shape_map;
    const double films = constant_bytes + of_shapes + film * (sample_counts + working_count) + of_luminance;
    const double reference_peak = pixels * (constant_bytes + (keeps_hits ? sizeof(Hit) : of_shapes));
    // Without kept points each job makes them of the hits, which then live as long as the films.
    const double film_peak = pixels * (films + (keeps_hits && points == 0 ? sizeof(Hit) : 0));
    return static_cast<std::uint64_t>(
        base_bytes + static_cast<double>(points) + std::max(reference_peak, film_peak) + of_emitters(experiment));
}

bool can_keep_points(const RunPlan& plan, const Scene& scene, std::uint64_t available) {
    return memory_needed(plan.experiment, bytes_of_points(scene)) <= available / 2;
}

std::string why_too_large(const Experiment& experiment, std::uint64_t available) {
    const auto needed_bytes = static_cast<double>(memory_needed(experiment)), bytes = static_cast<double>(available);
    if (needed_bytes <= bytes) return "";
    const double pixels = pixels_of(experiment);
    const double scale = std::sqrt(pixels_that_fit(pixels, needed_bytes, bytes) / pixels);
    const int width = static_cast<int>(experiment.image.width * scale),
              height = static_cast<int>(experiment.image.height * scale);
    std::string message = fmt::format(
        "this run needs about {:.2g} GB of memory, and {:.2g} GB are available: every sample count of every arm is "
        "held at {} "
        "x {} pixels",
        needed_bytes / 1e9, bytes / 1e9, experiment.image.width, experiment.image.height);
    if (width > 0 && height > 0)
        message += fmt::format(
            "; expected fewer sample counts, or a smaller image, such as --set image.width={} --set image.height={} "
            "with its "
            "boxes",
            width, height);
    return message;
}

void check_memory(const Experiment& experiment) {
    if (const std::string reason = why_too_large(experiment, available_memory()); !reason.empty())
        throw OutputError(reason);
}

}  // namespace crescent
