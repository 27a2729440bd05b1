// Intervals are two standard errors of the logarithm. Times vary between runs and are stored separately.
#include "check/decide/efficiency.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "base/parallel.h"
#include "check/constants.h"
#include "check/decide/check_sampler.h"
#include "check/decide/tail.h"
#include "check/estimate/observations.h"
#include "check/sources/check_case.h"
#include "math/functions.h"

namespace crescent::check {

double Efficiency::low() const { return value() * math::exp(-2 * math::hypot(relative_se, cost_se)); }
double Efficiency::high() const { return value() * math::exp(2 * math::hypot(relative_se, cost_se)); }

namespace {

/// Draws of a baseline. For a program each costs an evaluation of f, and a variance known to 3 % is enough for a rank.
constexpr std::uint32_t baseline_draws = 1u << 15, baseline_draws_of_program = 1u << 12;

std::vector<double> baseline_weights(const CheckCase& check_case, const StreamKey& key) {
    std::vector<double> out;
    const std::uint32_t n = check_case.adapter->limited() ? baseline_draws_of_program : baseline_draws;
    for (int t = 0; t < check_case.adapter->techniques(); ++t) {
        Source source(*check_case.adapter, t, check_case.wo, check_case.light);
        StreamKey draw_key = key;
        draw_key.technique = static_cast<std::uint8_t>(t);
        std::vector<double> x;
        std::vector<PrimarySample> u;
        for (std::uint32_t from = 0; from < n; from += batch_size) {
            u.resize(std::min(batch_size, n - from));
            for (std::uint32_t i = 0; i < u.size(); ++i)
                u[i] = numbers_at(draw_key, from + i, source.numbers(), source.resolution());
            const std::vector<Draw> batch = source.draw(u);
            std::vector<std::size_t> indices;
            std::vector<Vec3d> wi;
            for (std::size_t i = 0; i < batch.size(); ++i)
                if (batch[i].pdf > 0 && batch[i].wi.z > 0) {
                    indices.push_back(i);
                    wi.push_back(batch[i].wi);
                }
            std::vector<double> p(wi.size(), 1);
            std::vector<Vec3d> f(wi.size());
            source.f_cos(wi, f);
            append_weights(source, batch, {.rows = indices, .wi = wi, .p = p, .f_cos = f}, x);
        }
        if (out.empty()) out = std::move(x);
        else
            for (std::size_t i = 0; i < x.size(); ++i) out[i] += x[i];
    }
    return out;
}

void note_variance(const WeightTail& t, Efficiency& e) {
    e.has_weights = t.has_weights;
    e.is_over_sphere = t.has_lower_draws;
    e.variance = sqr(t.spread.sd);
    e.relative_se = t.variance_error;
    e.heavy = t.heavy() || t.open() || t.has_unseen();
}

Efficiency variance_of_baseline(const CheckCase& check_case, std::size_t index, const StreamKey& key) {
    Efficiency e;
    e.check_case = index;
    try {
        note_variance(tail_of_weights(baseline_weights(check_case, key)), e);
    } catch (const SamplerTimeout&) {
    } catch (const SamplerError& fault) { e.fault = fault.what(); }
    return e;
}

}  // namespace

std::vector<Efficiency> variances_of(std::span<const CheckCase> check_cases, std::span<const CheckOutcome> outcomes,
    const CheckSettings& settings, const ProgressMonitor& monitor) {
    std::vector<Efficiency> out(check_cases.size());
    std::vector<std::size_t> baselines;
    for (const CheckOutcome& o : outcomes)
        for (std::size_t k = 0; k < o.check_cases.size(); ++k) {
            Efficiency& e = out[o.check_cases[k]];
            e.check_case = o.check_cases[k];
            note_variance(o.tails[k], e);
        }
    for (std::size_t i = 0; i < check_cases.size(); ++i)
        if (check_cases[i].baseline) baselines.push_back(i);
    const auto run = [&](std::size_t b) {
        monitor.check();
        const std::size_t i = baselines[b];
        const StreamKey key{.seed = settings.seed,
            .place = static_cast<std::uint16_t>(i),
            .technique = 0,
            .stage = 1,
            .purpose = Purpose::light,
            .part = 3};
        out[i] = variance_of_baseline(check_cases[i], i, key);
    };
    const bool is_serial = std::ranges::any_of(check_cases, [](const CheckCase& t) { return t.adapter->serial(); });
    for_each_index(is_serial, baselines.size(), run);
    return out;
}

namespace {

/// The time of one sample in one turn, ns; none if the sampler does not answer any more.
std::optional<double> time_once(
    const CheckCase& check_case, std::span<const PrimarySample> u, std::vector<Draw>& draws, Efficiency& e) {
    try {
        const auto start = std::chrono::steady_clock::now();
        for (int t = 0; t < check_case.adapter->techniques(); ++t)
            check_case.adapter->sample(t, check_case.wo, u, std::span(draws).first(u.size()));
        return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() /
            static_cast<double>(u.size());
    } catch (const SamplerTimeout&) {
    } catch (const SamplerError& fault) { e.fault = fault.what(); }
    return {};
}

}  // namespace

void measure_costs(std::span<const CheckCase> check_cases, std::uint32_t seed, std::span<Efficiency> variances,
    const ProgressMonitor& monitor) {
    constexpr std::size_t turns = 7, batch_draws = 1024, program_draws = 512;
    std::vector<PrimarySample> u(batch_draws);
    const StreamKey key{.seed = seed, .place = 0, .technique = 0, .stage = 1, .purpose = Purpose::light, .part = 4};
    for (std::uint32_t i = 0; i < batch_draws; ++i)
        u[i] = numbers_at(key, i, PrimarySample::most_numbers, Resolution::single);
    std::vector<std::vector<double>> times(variances.size());
    std::vector<Draw> draws(batch_draws);
    for (std::size_t turn = 0; turn < turns; ++turn)
        for (std::size_t i = 0; i < variances.size(); ++i) {
            monitor.check();
            const CheckCase& check_case = check_cases[variances[i].check_case];
            if (!variances[i].has_weights || times[i].size() < turn || !check_case.adapter->can_draw()) continue;
            const std::size_t n = check_case.adapter->limited() ? program_draws : batch_draws;
            if (const std::optional<double> ns = time_once(check_case, std::span(u).first(n), draws, variances[i]))
                times[i].push_back(*ns);
        }
    for (std::size_t i = 0; i < variances.size(); ++i) {
        if (times[i].size() < turns) continue;
        std::sort(times[i].begin(), times[i].end());
        variances[i].nanoseconds = times[i][turns / 2];
        variances[i].cost_se = 0.5 * (times[i][turns - 2] - times[i][1]) / variances[i].nanoseconds;
    }
}

namespace {

/// The surface, light and w_o that ranked samplers share.
std::string group_of(const CheckCase& t) {
    std::string key = fmt::format("{:g} {:g} {} {}", t.theta_deg, t.azimuth_deg, t.brdf, t.lighting);
    for (const auto& [name, value] : t.parameters) key += fmt::format(" {}={:g}", name, value);
    return key;
}

/// Samplers ranked by variance times time.
struct Ranks {
    std::vector<std::string> better, worse,
        tied;  // samplers with a smaller value, a larger value, and those that are not distinguished
};

Ranks ranks_of(const Efficiency& e, std::span<const CheckCase> check_cases, std::span<const Efficiency* const> group) {
    Ranks out;
    for (const Efficiency* o : group) {
        if (o->check_case == e.check_case || !(o->nanoseconds > 0) || o->is_over_sphere != e.is_over_sphere) continue;
        const bool is_tied = o->heavy || (o->low() <= e.high() && e.low() <= o->high());
        (is_tied ? out.tied : e.high() < o->low() ? out.better : out.worse).push_back(check_cases[o->check_case].arm);
    }
    return out;
}

std::string ranks_text(const Efficiency& e, const Ranks& ranks) {
    std::string message = fmt::format("A sample takes {:.3g} ns", e.nanoseconds);
    if (!ranks.better.empty())
        message += fmt::format("; variance x time is lower than that of {}", fmt::join(ranks.better, ", "));
    if (!ranks.worse.empty()) message += fmt::format("; higher than that of {}", fmt::join(ranks.worse, ", "));
    if (!ranks.tied.empty())
        message +=
            fmt::format("; not ranked against {}: intervals overlap or a tail is heavy", fmt::join(ranks.tied, ", "));
    return message + ".";
}

void test_one_efficiency(
    const Efficiency& e, std::span<const CheckCase> check_cases, std::span<const Efficiency* const> group, Verdict& v) {
    if (!e.fault.empty()) {
        v.state = State::error;
        note_first_failure(e.fault, v);
        v.sentences = {{"failure", "The sampler failed: " + e.fault + "."}};
        return;
    }
    v.evidence["variance"] = e.variance;
    v.evidence["variance_relative_se"] = e.relative_se;
    if (e.heavy) {
        v.state = State::inconclusive;
        v.sentences = {{"heavy tail", "Heavy tail: the variance is not known, so it is not ranked."}};
        v.next.kind = NextStep::Kind::heavier_pdf;
        return;
    }
    v.state = State::right;
    v.sentences = {
        {"variance", fmt::format("The variance of X is {:.4g} (+- {:.1f} %).", e.variance, 100 * e.relative_se)}};
    if (e.nanoseconds > 0) v.timed_message = ranks_text(e, ranks_of(e, check_cases, group));
}

}  // namespace

std::vector<Verdict> test_efficiency(std::span<const CheckCase> check_cases, std::span<const Efficiency> variances) {
    std::vector<Verdict> out(check_cases.size());
    std::map<std::string, std::vector<const Efficiency*>> groups;
    for (const Efficiency& e : variances)
        if (e.has_weights) groups[group_of(check_cases[e.check_case])].push_back(&e);
    std::size_t last_case = 0;
    for (const Efficiency& e : variances) {
        if (!check_cases[e.check_case].baseline) last_case = e.check_case;
        Verdict& v = out[e.check_case];
        v.arm = check_cases[e.check_case].arm;
        v.check_case = check_cases[e.check_case].text();
        v.name = "efficiency";
        v.state = State::skipped;
        v.sentences = {{"no weights", "There are no weights, so there is no variance."}};
        if (e.has_weights || !e.fault.empty())
            test_one_efficiency(e, check_cases, groups[group_of(check_cases[e.check_case])], v);
        // A program failed while its f was evaluated for a baseline: reported where it would be ranked.
        if (check_cases[e.check_case].baseline && !e.fault.empty()) {
            out[last_case].state = State::error;
            out[last_case].sentences = v.sentences;
        }
    }
    return out;
}

}  // namespace crescent::check
