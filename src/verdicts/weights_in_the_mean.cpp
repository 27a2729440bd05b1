// Weights, pdf or f that are random estimates agree with one another in the mean alone. Where p is known at the draws,
// weight and f |cos| / p of one draw are a pair, and the mean of their difference times 1, cos theta_i and the other
// two components of w_i is 0. Where p is an estimate too, one over it is no estimate of 1 / p, and where there is no
// pdf(w) nothing is known of one draw: the mean weight of each channel is then held against int f |cos| of that
// channel.
#include "verdicts/weights_in_the_mean.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "stats/moments.h"
#include "trials/trial_context.h"
#include "trials/weights.h"

namespace crescent::inline verdicts {

namespace {

struct ComparedWeights {
    double p = 1;  // of the least likely
    int channel = 0;
    double said = 0, due = 0;
};

double weight_of(const TrialContext& work, const Draw& d, int channel) {
    return work.traits.channels == 3 ? channel_of(d.weights, channel) : *d.weight;
}

bool weighs(const TrialContext& work, const Draw& d) { return d.pdf > 0 && d.weight && work.counts(d.wi); }

void keep_least(ComparedWeights& out, const ComparedWeights& other) {
    if (other.p < out.p) out = other;
}

/// Means of (weight - f |cos| / p) g over the draws.
ComparedWeights in_pairs(const TrialContext& work, const SampleBatch& b, int channel) {
    ComparedWeights out{1, channel};
    work.f_of_drawn(b);
    std::vector<double> off(b.draws.size()), size(b.draws.size());
    const double n = static_cast<double>(b.draws.size());
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        const Draw& d = b.draws[i];
        if (!weighs(work, d)) continue;
        const double f = work.traits.channels == 3 ? channel_of(b.f_channels[i], channel) : b.f[i],
                     said = weight_of(work, d, channel), due = f * std::fabs(d.wi.z) / d.pdf;
        off[i] = said - due;
        size[i] = std::fabs(off[i]);
        out.said += said / n, out.due += due / n;
    }
    if (!mean_is_testable(spread(size), tail_of(size), work.trial.theory)) return out;
    Integral none;
    none.error = 1e-4 * std::fabs(out.due);
    for (int axis = 0; axis < 4; ++axis) {
        std::vector<double> x = off;
        for (std::size_t i = 0; axis < 3 && i < x.size(); ++i) x[i] *= channel_of(b.draws[i].wi, axis);
        Spread s = spread(x);
        for (double v : x) s.largest = std::max(s.largest, std::fabs(v));
        out.p = std::min(out.p, 4 * mean_p(s, none));
    }
    return out;
}

/// The mean weight against the integral.
ComparedWeights against_integral(const TrialContext& work, const SampleBatch& b, int channel) {
    std::vector<double> x(b.draws.size());
    for (std::size_t i = 0; i < x.size(); ++i)
        if (weighs(work, b.draws[i])) x[i] = weight_of(work, b.draws[i], channel);
    const Integral due = work.albedo_of(channel);
    const Spread s = spread(x);
    return {mean_is_testable(s, tail_of(x), work.trial.theory) ? mean_p(s, due) : 1, channel, s.mean, due.value};
}

/// p is known at each draw.
bool knows_p(const TrialContext& work) { return work.traits.has_pdf && !work.scatter().pdf(); }

ComparedWeights compared(const TrialContext& work, const SampleBatch& b) {
    ComparedWeights out;
    if (std::none_of(b.draws.begin(), b.draws.end(), [](const Draw& d) { return d.weight.has_value(); })) return out;
    const int channels = work.traits.channels;
    for (int c = 0; c < channels; ++c)
        if (knows_p(work)) keep_least(out, in_pairs(work, b, c));
        else if (channels == 3) keep_least(out, against_integral(work, b, c));  // of one channel, `mean` tells
    out.p = std::min(out.p * channels, 1.0);
    return out;
}

}  // namespace

bool weights_are_off(const TrialContext& work, int technique, Verdict& v) {
    const ComparedWeights first = compared(work, work.first(technique));
    v.evidence["p_weight_in_the_mean"] = first.p;
    if (!work.fails(first.p, [&](int round) { return compared(work, work.draw(technique, round)).p; })) return false;
    v.state = State::wrong;
    v.say = fmt::format(
        "The weight{} and {} differ in the mean ({:.6g} against {:.6g}), or along a direction, and again on a fresh "
        "seed.",
        work.traits.channels == 3 ? fmt::format(" of channel {}", first.channel + 1) : "",
        knows_p(work) ? "f |cos| / p" : "the integral of f |cos|", first.said, first.due);
    return true;
}

}  // namespace crescent::inline verdicts
