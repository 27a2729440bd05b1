// Results do not depend on threads: each case has streams of its own, named by its place in the call.
#include "check/decide/check_sampler.h"

#include <algorithm>

#include "base/parallel.h"
#include "check/constants.h"
#include "check/decide/whole_sampler.h"

namespace crescent::check {

bool CheckOutcome::wrong() const {
    return !small.empty() || std::ranges::any_of(at, [](const auto& techniques) {
        return std::ranges::any_of(techniques, [](const CheckAt& c) { return c.wrong(); });
    });
}

namespace {

std::vector<CheckOutcome> grouped(std::span<const Trial> trials) {
    std::vector<CheckOutcome> out;
    for (std::size_t i = 0; i < trials.size(); ++i) {
        if (trials[i].baseline) continue;
        const auto same = [&](const CheckOutcome& o) {
            const Trial& t = trials[o.trials[0]];
            return t.arm == trials[i].arm && t.brdf == trials[i].brdf && t.parameters == trials[i].parameters &&
                t.lighting == trials[i].lighting;
        };
        auto at = std::ranges::find_if(out, same);
        if (at == out.end()) out.push_back({trials[i].arm, {}, {}, {}, 0}), at = out.end() - 1;
        at->trials.push_back(i);
    }
    return out;
}

/// Built-in arms are made for one w_o each, under one light: special w_o are for subjects that take any.
bool takes_any_wo(std::span<const Trial> trials, const CheckOutcome& o) {
    return std::ranges::all_of(
        o.trials, [&](std::size_t i) { return trials[i].subject == trials[o.trials[0]].subject; });
}

void look_at_whole(std::span<const Trial> trials, const CheckSettings& settings, CheckOutcome& out) {
    const JudgedSampler& subject = *trials[out.trials[0]].subject;
    StreamKey key{settings.seed, static_cast<std::uint16_t>(out.trials[0]), 0, 1, Purpose::light, 0};
    const auto add = [&](std::optional<SmallFault> fault) {
        if (fault) out.small.push_back(*fault);
    };
    if (takes_any_wo(trials, out)) {
        std::vector<Vec3d> ordinary;
        for (std::size_t i : out.trials)
            if (ordinary.size() < 3) ordinary.push_back(trials[i].wo);
        for (int t = 0; t < subject.techniques(); ++t) add(special_places(subject, t, ordinary));
        add(reciprocity(subject, key));
    }
    for (std::size_t i : out.trials) {
        const std::size_t before = out.small.size();
        add(mis_weights(*trials[i].subject, trials[i].wo, key));
        if (out.small.size() > before) break;
    }
}

}  // namespace

std::vector<CheckOutcome> check_samplers(
    std::span<const Trial> trials, const CheckSettings& settings, ProgressMonitor& monitor) {
    std::vector<CheckOutcome> out = grouped(trials);
    struct Job {
        std::size_t outcome, index;
    };
    std::vector<Job> jobs;
    for (std::size_t o = 0; o < out.size(); ++o) {
        out[o].at.resize(out[o].trials.size());
        for (std::size_t k = 0; k < out[o].trials.size(); ++k) jobs.push_back({o, k});
    }
    const double questions =
        std::max(settings.cases, static_cast<double>(jobs.size())) * static_cast<double>(Family::families);
    const auto run = [&](std::size_t j) {
        monitor.check();
        CheckOutcome& o = out[jobs[j].outcome];
        const std::size_t i = o.trials[jobs[j].index];
        const Trial& trial = trials[i];
        for (int t = 0; t < trial.subject->techniques(); ++t)
            o.at[jobs[j].index].push_back(check_sampler_at(*trial.subject, t, trial.wo,
                {trial.light, static_cast<std::uint16_t>(i), questions}, settings.budget, settings.seed));
        monitor.advance(1);
    };
    const bool serial = std::ranges::any_of(trials, [](const Trial& t) { return t.subject->serial(); });
    if (serial)
        for (std::size_t j = 0; j < jobs.size(); ++j) run(j);
    else parallel_for(std::size_t{0}, jobs.size(), run);
    for (CheckOutcome& o : out) {
        look_at_whole(trials, settings, o);
        for (const auto& techniques : o.at)
            for (const CheckAt& c : techniques) o.evaluations += c.evaluations;
    }
    return out;
}

}  // namespace crescent::check
