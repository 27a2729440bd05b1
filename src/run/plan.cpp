// Seeds are seed_of(seed, k) for k = 0, 1, ..., without duplicates. Jobs are ordered by seed, then arms in the
// experiment's order, then the exponent control; the exponents are collected from the jobs.
#include "run/plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.h"
#include "math/simd/random.h"

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

}  // namespace crescent::inline runs
