// efficiency: variance of X times the time of one sample, beside every other arm on the same surface, light and w_o.
// Two arms whose intervals (two standard errors, in the logarithm) overlap are not ranked.
#include "verdicts/efficiency.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "math/functions.h"
#include "simd/random.h"
#include "stats/moments.h"
#include "subjects/faults.h"
#include "subjects/numbers.h"
#include "trials/trial_context.h"
#include "trials/unmet.h"
#include "trials/weights.h"
#include "verdicts/judge.h"
#include "verdicts/verdict_kind.h"

namespace crescent::inline verdicts {

namespace {

std::string company_of(const Trial& t) {
    std::string key = fmt::format("{:g} {:g} {} {}", t.theta_deg, t.azimuth_deg, t.brdf, t.lighting);
    for (const auto& [name, value] : t.parameters) key += fmt::format(" {}={:g}", name, value);
    return key;
}

}  // namespace

double Efficiency::low() const { return value() * math::exp(-2 * math::hypot(relative_se, cost_se)); }
double Efficiency::high() const { return value() * math::exp(2 * math::hypot(relative_se, cost_se)); }

Efficiency measure_efficiency(const TrialContext& work, std::size_t trial) {
    Efficiency e;
    e.trial = trial;
    e.whole = work.whole();
    const std::vector<double>& x = work.first_weights(false);
    const Spread s = spread(x);
    double m4 = 0;
    for (double v : x) m4 += sqr(sqr(v - s.mean)) / s.n;
    e.variance = sqr(s.sd);
    e.relative_se = e.variance > 0 ? std::sqrt(std::max(m4 / sqr(e.variance) - 1, 0.0) / s.n) : 0;
    e.heavy = !mean_is_testable(s, tail_of(x), work.trial.theory) ||
        (!work.pilot_directions().empty() && has_unmet_tail(work, false));
    return e;
}

namespace {

/// What one sample took in one turn, ns; nothing where the sampler cannot be asked any more.
std::optional<double> time_once(
    const Trial& trial, std::span<const Numbers> u, std::vector<Draw>& draws, Efficiency& e) {
    try {
        const auto start = std::chrono::steady_clock::now();
        for (int t = 0; t < trial.subject->techniques(); ++t)
            trial.subject->sample(t, trial.wo, u, std::span(draws).first(u.size()));
        return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() /
            static_cast<double>(u.size());
    } catch (const SubjectTooSlow&) {
    } catch (const SubjectFault& fault) { e.fault = fault.what(); }
    return {};
}

}  // namespace

void measure_costs(std::span<const Trial> trials, const TestSettings& settings, std::span<Efficiency> all,
    const ProgressMonitor& monitor) {
    constexpr std::size_t turns = 7, most = 1024, of_a_program = 512;
    std::vector<Numbers> u(most);
    for (std::size_t i = 0; i < most; ++i) u[i] = drawn_numbers(seed_of(settings.seed, 0), 0, i, 0, Numbers::most);
    std::vector<std::vector<double>> times(all.size());
    std::vector<Draw> draws(most);
    for (std::size_t turn = 0; turn < turns; ++turn)
        for (std::size_t i = 0; i < all.size(); ++i) {
            monitor.check();
            const Trial& trial = trials[all[i].trial];
            if (times[i].size() < turn || !trial.subject->draws_at_will()) continue;  // it was given up
            const std::size_t n = trial.subject->limited() ? of_a_program : most;
            if (const std::optional<double> ns = time_once(trial, std::span(u).first(n), draws, all[i]))
                times[i].push_back(*ns);
        }
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (times[i].size() < turns) continue;
        std::sort(times[i].begin(), times[i].end());
        all[i].nanoseconds = times[i][turns / 2];
        all[i].cost_se = 0.5 * (times[i][turns - 2] - times[i][1]) / all[i].nanoseconds;
    }
}

namespace {

/// Arms on the same surface, light and w_o beside one, by variance times time.
struct Ranks {
    std::vector<std::string> better, worse, level;  // than these it is; level: not ranked against these
};

Ranks ranks_of(const Efficiency& e, std::span<const Trial> trials, std::span<const Efficiency* const> company) {
    Ranks out;
    for (const Efficiency* o : company) {
        if (o->trial == e.trial || !(o->nanoseconds > 0) || o->whole != e.whole) continue;
        const bool level = o->heavy || (o->low() <= e.high() && e.low() <= o->high());
        (level ? out.level : e.high() < o->low() ? out.better : out.worse).push_back(trials[o->trial].arm);
    }
    return out;
}

std::string told(const Efficiency& e, const Ranks& ranks) {
    std::string say = fmt::format("A sample takes {:.3g} ns", e.nanoseconds);
    if (!ranks.better.empty())
        say += fmt::format("; variance x time is better than that of {}", fmt::join(ranks.better, ", "));
    if (!ranks.worse.empty()) say += fmt::format("; worse than that of {}", fmt::join(ranks.worse, ", "));
    if (!ranks.level.empty())
        say +=
            fmt::format("; not ranked against {}: intervals overlap or a tail is heavy", fmt::join(ranks.level, ", "));
    return say + ".";
}

/// Of a trial whose weights were looked at.
void judge_one(
    const Efficiency& e, std::span<const Trial> trials, std::span<const Efficiency* const> company, Verdict& v) {
    v.evidence["variance"] = e.variance;
    v.evidence["variance_relative_se"] = e.relative_se;
    if (!e.fault.empty()) {
        v.state = State::error;
        v.evidence["first_fault"] = e.fault;
        v.say = "The sampler broke off: " + e.fault + ".";
        return;
    }
    v.timing = {{"nanoseconds", e.nanoseconds}, {"variance_x_cost", e.value()}, {"low", e.low()}, {"high", e.high()}};
    if (e.heavy) {
        v.state = State::inconclusive;
        v.say = "inconclusive: heavy tail. The variance is not known, hence no rank.";
        v.settle = "The same as for the tail.";
        return;
    }
    v.state = State::right;
    v.say = fmt::format("The variance of X is {:.4g} (+- {:.1f} %).", e.variance, 100 * e.relative_se);
    if (e.nanoseconds > 0) v.say_timed = told(e, ranks_of(e, trials, company));
}

}  // namespace

std::vector<Verdict> judge_efficiency(std::span<const Trial> trials, std::span<const Efficiency> all) {
    std::vector<Verdict> out(trials.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
        out[i].arm = trials[i].arm;
        out[i].trial = trials[i].text();
        out[i].name = "efficiency";
        out[i].state = State::skipped;
        out[i].say = "There are no weights to take a variance of.";
    }
    std::map<std::string, std::vector<const Efficiency*>> companies;
    for (const Efficiency& e : all) companies[company_of(trials[e.trial])].push_back(&e);
    for (const auto& [on, company] : companies)
        for (const Efficiency* e : company) judge_one(*e, trials, company, out[e->trial]);
    return out;
}

constinit const VerdictKind kinds::efficiency = {
    .question = "what does a sample cost?", .compare = judge_efficiency, .may_stay_open = true};

}  // namespace crescent::inline verdicts
