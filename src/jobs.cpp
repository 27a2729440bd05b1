#include "jobs.h"

#include <fmt/format.h>

#include <algorithm>

#include "estimator/estimator.h"
#include "meters/tail.h"
#include "simd/random.h"
#include "version.h"

namespace crescent {

namespace {

class Cpu : public Instrument {
public:
    explicit Cpu(std::string isa) : isa_(std::move(isa)) {}
    std::string name() const override { return "CPU"; }
    std::vector<Film> films(const Scene& scene, const Job& job, Watch& watch) override {
        return estimate_films(scene, job.arm->sampler, job.n, job.seed, isa_, watch, job.keeper);
    }

private:
    std::string isa_;
};

}  // namespace

std::shared_ptr<Instrument> cpu_instrument(std::string isa) { return std::make_shared<Cpu>(std::move(isa)); }

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
    for (const ArmPlan& arm : experiment.arms) jobs.push_back({&arm, arm.n, own, seed, nullptr});
    if (!experiment.exponent) return jobs;
    const ExponentControl& control = *experiment.exponent;
    const auto arm = std::find_if(
        experiment.arms.begin(), experiment.arms.end(), [&](const ArmPlan& a) { return a.name == control.arm; });
    for (double s : control.s) {
        const bool there = s == own && std::find(arm->n.begin(), arm->n.end(), control.n) != arm->n.end();
        if (!there) jobs.push_back({&*arm, {control.n}, s, seed, nullptr});
    }
    return jobs;
}

std::optional<Tail> region_tail(
    const Scene& scene, const Job& job, const Box& box, const std::string& isa, Watch& watch) {
    constexpr std::uint64_t most = 4'000'000, most_a_pixel = 256;
    const std::uint64_t pixels = static_cast<std::uint64_t>(box.width()) * static_cast<std::uint64_t>(box.height());
    const std::uint64_t n = std::min(std::max<std::uint64_t>(most / pixels, 1), most_a_pixel);
    const std::size_t length = tail_length(pixels * n);
    std::uint64_t drawn = 0;
    if (length == 0) return std::nullopt;
    return fit_pooled_tail(largest_samples(scene, job.arm->sampler, n, job.seed, box, length + 1, isa, watch, drawn));
}

Provenance provenance_of(const Experiment& experiment, const Instrument& instrument, const std::string& command) {
    Provenance p;
    p.version = version();
    p.commit = commit();
    p.compiler = compiler();
    p.experiment_file = experiment.file;
    p.experiment_hash = fmt::format("{:016x}", hash(experiment));
    p.instrument = instrument.name(), p.instrument_details = instrument.details();
    p.command = command;
    p.seeds = seeds_of(experiment);
    return p;
}

}  // namespace crescent
