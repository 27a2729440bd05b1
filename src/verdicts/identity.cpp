// identity: what the sampler says twice, it says alike: pdf with the draw and pdf(w); weight and f cos / p; f and what
// f ought to be; MIS weights that sum to one; and p |Jacobian| of the warp (warp.cpp).
//
// Tolerance: 1e-4, and what p itself moves by when the components of wi and wo move by four roundings ("conditioning"):
// (w.R)^s moves by s eps when w.R does by eps, so a float sampler at s = 1e5 may differ from itself by per cents and be
// right.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "trials/conditioning.h"
#include "trials/trial_context.h"
#include "verdicts/repeats.h"
#include "verdicts/verdict_kind.h"
#include "verdicts/warp.h"
#include "verdicts/weights_in_the_mean.h"

namespace crescent::inline verdicts {

namespace {

constexpr double tolerance = 1e-4;  // relative

/// Draws for which `said` and `asked` differ beyond tolerance and conditioning.
struct Mismatch {
    std::size_t count = 0, tried = 0, nudged = 0, left_out = 0;  // nudged: looked at by conditioning
    double worst = 0;                                            // relative
    Vec3d at{};
    double said = 0, asked = 0;
    void add(double a, double b, Vec3d w) {
        ++count;
        const double off = std::fabs(a - b) / std::max(std::fabs(a), std::fabs(b));
        if (off <= worst && count > 1) return;
        worst = off;
        at = w;
        said = a;
        asked = b;
    }
    /// A program is asked for the conditioning of so many draws; those beyond are left out.
    bool leaves_out(const TrialContext& work) {
        constexpr std::size_t most = 512;
        if (!work.thrifty() || ++nudged <= most) return false;
        --tried, ++left_out;
        return true;
    }
    bool matters() const { return count >= 3 && static_cast<double>(count) > 1e-4 * static_cast<double>(tried); }
    std::string told(std::string_view a, std::string_view b) const {
        return fmt::format(
            "{} and {} differ for {}{} of {} draws, most at w = ({:.6g}, {:.6g}, {:.6g}): {:.6g} against {:.6g}", a, b,
            left_out > 0 ? "at least " : "", count, tried + left_out, at.x, at.y, at.z, said, asked);
    }
};

/// Numbers under float's smallest normal one have few digits left in single precision.
bool close(double a, double b, double extra = 0) {
    return std::fabs(a - b) <= tolerance * std::max(std::fabs(a), std::fabs(b)) + 0x1p-126 + extra;
}

Mismatch pdf_twice(const TrialContext& work, int t) {
    Mismatch m;
    const SampleBatch& b = work.first(t);
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        const Draw& d = b.draws[i];
        if (!(d.pdf > 0) || !work.counts(d.wi)) continue;  // elsewhere a pdf weighs nothing
        ++m.tried;
        if (close(d.pdf, b.pdf[i], 2 * work.subject.tabulation_error(d.wi)) || m.leaves_out(work)) continue;
        if (m.count < 4096 && close(d.pdf, b.pdf[i], pdf_conditioning(work, t, d.wi, b.pdf[i]))) continue;
        m.add(d.pdf, b.pdf[i], d.wi);
    }
    return m;
}

/// The weight of one channel beside f cos / p of it.
Mismatch channel_twice(const TrialContext& work, const SampleBatch& b, int c) {
    Mismatch m;
    work.f_of_drawn(b);
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        const Draw& d = b.draws[i];
        if (!(d.pdf > 0) || !d.weight || !work.counts(d.wi)) continue;
        ++m.tried;
        const double cos = std::fabs(d.wi.z), g = cos / d.pdf, f = channel_of(b.f_channels[i], c),
                     said = channel_of(d.weights, c), asked = f * g;
        if (close(said, asked) || m.leaves_out(work)) continue;
        if (m.count < 4096 &&
            close(said, asked,
                g * f_conditioning(work, work.trial.wo, d.wi, f, c) +
                    4 * work.direction_resolution() * std::fabs(asked) / cos))
            continue;
        m.add(said, asked, d.wi);
    }
    return m;
}

/// The sampler's own weight beside f cos / p, and f beside what it ought to be.
Mismatch weight_twice(const TrialContext& work, const SampleBatch& b, bool truth) {
    Mismatch m;
    std::vector<Vec3d> wi;
    std::vector<const Draw*> draws;
    std::vector<double> f;
    const std::vector<double>& value = work.f_of_drawn(b);
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        const Draw& d = b.draws[i];
        if (!(d.pdf > 0) || !work.counts(d.wi)) continue;
        wi.push_back(d.wi);
        draws.push_back(&d);
        f.push_back(value[i]);
    }
    const std::vector<double> ought = truth ? work.f(wi, true) : f;
    for (std::size_t i = 0; i < wi.size(); ++i) {
        ++m.tried;
        const double cos = std::fabs(wi[i].z), g = cos / draws[i]->pdf;
        const double said = truth ? f[i] : draws[i]->weight.value_or(f[i] * g), asked = truth ? ought[i] : f[i] * g;
        if (close(said, asked) || m.leaves_out(work)) continue;
        const double loose = f_conditioning(work, work.trial.wo, wi[i], f[i]);
        if (m.count < 4096 &&
            close(said, asked, truth ? loose : g * loose + 4 * work.direction_resolution() * std::fabs(asked) / cos))
            continue;
        m.add(said, asked, wi[i]);
    }
    return m;
}

Mismatch mis_sum(const TrialContext& work, const SampleBatch& b) {
    Mismatch m;
    std::vector<Pair> at;
    for (const Draw& d : b.draws)
        if (d.pdf > 0 && d.wi.z > 0) at.push_back({work.trial.wo, d.wi});
    std::vector<double> sum(at.size()), w(at.size());
    for (int t = 0; t < work.subject.techniques(); ++t) {
        work.subject.mis_weight(t, at, w);
        for (std::size_t i = 0; i < w.size(); ++i) sum[i] += w[i];
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
        ++m.tried;
        if (!close(sum[i], 1)) m.add(sum[i], 1, at[i].wi);
    }
    return m;
}

Verdict wrong(const TrialContext& work, Verdict v, const Mismatch& m, std::string_view a, std::string_view b) {
    v.state = State::wrong;
    v.say = m.told(a, b) + ".";
    v.evidence["mismatches"] = m.count;
    v.evidence["largest_relative_difference"] = m.worst;
    v.evidence["direction_grain"] = work.direction_resolution();
    return v;
}

/// The pdf, the weights and f beside one another, draw by draw; of what is a random estimate in the mean. True where
/// something is wrong, which `v` then tells.
bool answers_are_wrong(const TrialContext& work, int t, Verdict& v) {
    const SampleBatch& b = work.first(t);
    const auto tell = [&](const Mismatch& m, std::string_view one, std::string_view other) {
        if (m.matters()) v = wrong(work, v, m, one, other);
        return m.matters();
    };
    const Scatter& scatter = work.scatter();
    if (work.traits.has_pdf && !scatter.pdf() && tell(pdf_twice(work, t), "The pdf that came with the draw", "pdf(w)"))
        return true;
    if (!work.subject.has_f()) return false;
    if (scatter.any() || !work.traits.has_pdf) return weights_are_off(work, t, v);
    Verdict before = v;
    for (int c = 0; c < 3 && work.traits.channels == 3; ++c)
        if (tell(channel_twice(work, b, c), fmt::format("The weight of channel {}", c + 1), "f cos / p of it")) break;
    if (work.traits.channels == 1) tell(weight_twice(work, b, false), "The weight", "f cos / p");
    if (v.state == State::wrong && work.traits.own_random) {  // its weights may be estimates
        v = std::move(before);
        v.evidence["weights_are_estimates"] = true;
        return weights_are_off(work, t, v);
    }
    return v.state == State::wrong ||
        (work.subject.has_true_f() && tell(weight_twice(work, b, true), "f", "the BRDF it claims to be"));
}

std::string told_of(const TrialContext& work, bool estimated_weights) {
    const Scatter& scatter = work.scatter();
    const char* in_every = work.traits.channels == 3 ? " in every channel" : "";
    if (!work.traits.has_pdf)
        return std::string(work.traits.own_random ? "There is nothing that a draw says twice"
                                                  : "The same u gives the same answer") +
            (work.subject.has_f() && work.weighs() && work.traits.channels == 3
                    ? "; the mean weight of every channel is the integral of f |cos|"
                    : "");
    std::string out = scatter.pdf()
        ? "pdf(w) is a random estimate, so that neither the pdf with a draw nor the warp was "
          "held against it; `normalised` and `density` tell of its mean"
        : "The pdf with a draw equals pdf(w)";
    if (!work.subject.has_f()) return out;
    if (scatter.pdf()) return out + (work.traits.channels == 3 ? "; the mean weight is the integral of f |cos|" : "");
    return out + ", the weight f cos / p" + in_every + (scatter.f() || estimated_weights ? " in the mean" : "");
}

bool mis_weights_are_off(const TrialContext& work, const SampleBatch& b, Verdict& v) {
    if (work.subject.techniques() == 1) return false;
    const Mismatch m = mis_sum(work, b);
    if (m.matters()) v = wrong(work, v, m, "The sum of the MIS weights", "1");
    return m.matters();
}

Verdict judge_identity(TrialContext& work) {
    Verdict v = work.verdict("identity", State::right, "");
    const bool loose = work.traits.own_random || work.scatter().any();
    WarpSummary warps;
    for (int t = 0; t < work.subject.techniques(); ++t) {
        const SampleBatch& b = work.first(t);
        if (answers_otherwise(work, t, v) || repeats_directions(work, b, v) || answers_are_wrong(work, t, v) ||
            (!loose && has_uneven_deltas(work, b, v)) || mis_weights_are_off(work, b, v) ||
            warp_is_wrong(work, t, warps, v))
            return v;
    }
    v.say = told_of(work, v.evidence.contains("weights_are_estimates"));
    if (work.subject.techniques() > 1) v.say += ", the MIS weights sum to 1";
    v.say += told_of_warp(work, warps) + ".";
    return v;
}

/// Weights that are estimates, or have no pdf beside them, in the mean.
std::uint64_t tests_of_identity(const Trial& t) {
    const Traits traits = t.subject->traits();
    return t.subject->has_f() && (traits.own_random || !traits.has_pdf) ? 1 : 0;
}

}  // namespace

constinit const VerdictKind kinds::identity = {.question = "does the sampler agree with itself?",
    .judge = judge_identity,
    .tests = tests_of_identity,
    .asked_of_other_seeds = true};

}  // namespace crescent::inline verdicts
