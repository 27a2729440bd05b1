#include "jobs.h"

#include <algorithm>

#include "estimator/estimator.h"

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

std::vector<Job> jobs_of(const Experiment& experiment, std::uint32_t seed) {
    std::vector<Job> jobs;
    const double own = experiment.s();
    for (const ArmPlan& arm : experiment.arms) jobs.push_back({&arm, arm.n, own, seed, nullptr});
    if (!experiment.exponent) return jobs;
    const ExponentControl& control = *experiment.exponent;
    const auto arm = std::find_if(experiment.arms.begin(), experiment.arms.end(), [&](const ArmPlan& a) { return a.name == control.arm; });
    for (double s : control.s) {
        const bool there = s == own && std::find(arm->n.begin(), arm->n.end(), control.n) != arm->n.end();
        if (!there) jobs.push_back({&*arm, {control.n}, s, seed, nullptr});
    }
    return jobs;
}

}  // namespace crescent
