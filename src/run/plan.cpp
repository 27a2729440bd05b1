// Seeds are seed_of(seed, k) for k = 0, 1, ..., without duplicates. Jobs are ordered by seed, then arms in the
// experiment's order, then the exponent control; the exponents are collected from the jobs.
#include "run/plan.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "base/errors.h"
#include "base/machine.h"
#include "math/simd/random.h"
#include "render/film.h"
#include "render/tiles.h"

namespace crescent::inline runs {

std::vector<std::uint32_t> seeds_of(const Experiment& experiment) {
    std::vector<std::uint32_t> series;
    for (std::uint32_t k = 0; series.size() < static_cast<std::size_t>(experiment.seeds); ++k)
        if (const std::uint32_t seed = seed_of(experiment.seed, k); std::ranges::find(series, seed) == series.end())
            series.push_back(seed);
    return series;
}

std::vector<Job> jobs_of(const Experiment& experiment, std::uint32_t seed) {
    std::vector<Job> jobs;
    const double own = experiment.s();
    for (const ArmPlan& arm : experiment.arms) jobs.push_back({arm.name, arm.sampler, arm.n, own, seed});
    if (!experiment.exponent) return jobs;
    const ExponentControl& control = *experiment.exponent;
    const ArmPlan& arm = *experiment.find_arm(control.arm);
    for (double s : control.s) {
        const bool there = s == own && std::ranges::find(arm.n, control.n) != arm.n.end();
        if (!there) jobs.push_back({arm.name, arm.sampler, {control.n}, s, seed});
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

// ---- Four bytes per pixel for each plane of each film and reference held, 12 more per pixel, the hits of images up to
// 2^20 pixels, 150 MB for the program. The suggested image fits into 90 % of the available memory.

namespace {

constexpr double for_itself = 150e6;  // code, fonts, plates, the report; measured on the gallery at 64 x 36
// Per pixel: Scene::remember_primaries' 4, shape map, shading point counts and rows being written to a file.
constexpr double working_bytes = 12;

double pixels_that_fit(double pixels, double needed, double available) {
    const double each = (needed - for_itself) / pixels;
    return std::max(0.0, (0.9 * available - for_itself) / each);
}

}  // namespace

std::uint64_t memory_needed(const Experiment& experiment) {
    const double film = 4.0 * static_cast<double>(Film().planes().size()),
                 reference = 4.0 * static_cast<double>(ReferenceFilm().planes().size());
    double sample_counts = 0, most = 0;
    std::set<double> exponents;
    for (const Job& job : jobs_of(experiment, experiment.seed)) {
        sample_counts += static_cast<double>(job.n.size());
        most = std::max(most, static_cast<double>(job.n.size()));
        exponents.insert(job.s);
    }
    const double pixels = static_cast<double>(experiment.image.width) * experiment.image.height;
    const ReferencePlan& asked = experiment.reference;
    const double references = asked.monte_carlo || asked.kind == ReferenceKind::note ? 2 : 1;
    const double again = experiment.seeds > 1 ? most : 0;
    const double a_pixel =
        film * (sample_counts + again) + references * reference * static_cast<double>(exponents.size()) + working_bytes;
    const double hits = pixels <= static_cast<double>(Scene::whole_hits) ? pixels * sizeof(Hit) : 0;
    // Three floats of a texel and one of its row's distribution.
    const double sky = experiment.sky && experiment.sky->image ? 16.0 * double(experiment.sky->image->texels()) : 0;
    return static_cast<std::uint64_t>(for_itself + pixels * a_pixel + hits + sky);
}

bool can_keep_points(const RunPlan& plan, const Scene& scene, std::uint64_t available) {
    return memory_needed(plan.experiment) + bytes_of_points(scene) <= available / 2;
}

std::string why_too_large(const Experiment& experiment, std::uint64_t available) {
    const auto needed = static_cast<double>(memory_needed(experiment)), there = static_cast<double>(available);
    if (needed <= there) return "";
    const double pixels = static_cast<double>(experiment.image.width) * experiment.image.height;
    const double scale = std::sqrt(pixels_that_fit(pixels, needed, there) / pixels);
    const int width = static_cast<int>(experiment.image.width * scale),
              height = static_cast<int>(experiment.image.height * scale);
    std::string message = fmt::format(
        "this run needs about {:.2g} GB of memory, and {:.2g} GB are available: every sample count of every arm is "
        "held at {} "
        "x {} pixels",
        needed / 1e9, there / 1e9, experiment.image.width, experiment.image.height);
    if (width > 0 && height > 0)
        message += fmt::format(
            "; expected fewer sample counts, or a smaller image, such as --set image.width={} --set image.height={} "
            "with its "
            "boxes",
            width, height);
    return message;
}

void check_memory(const Experiment& experiment) {
    if (const std::string why = why_too_large(experiment, available_memory()); !why.empty()) throw OutputError(why);
}

}  // namespace crescent::inline runs
