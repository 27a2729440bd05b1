// Where there is no pdf(w), weights and directions are held together by means alone: under a light L the mean of
// weight times L(w_i) is int f L |cos|. Of an even light it is right whatever the directions are, as long as the
// weights are; lights from several sides, broad and narrow, tell where draws go.
#include "verdicts/mean_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "stats/moments.h"
#include "trials/trial_context.h"
#include "trials/weights.h"

namespace crescent::inline verdicts {

namespace {

/// Radiance ((1 + w.axis) / 2)^sharpness.
struct Lobe {
    const char* where;
    Vec3d axis;
    double sharpness;
    double operator()(Vec3d w) const { return math::pow(std::max(0.5 * (1 + dot(w, axis)), 0.0), sharpness); }
};

std::vector<Lobe> lobes_of(const TrialContext& work) {
    const Vec3d wo = work.trial.wo, n{0, 0, wo.z > 0 ? 1.0 : -1.0}, r{-wo.x, -wo.y, wo.z};
    std::vector<Lobe> out = {{"the normal", n, 8}, {"the mirror direction", r, 2}, {"the mirror direction", r, 16},
        {"the mirror direction", r, 128}, {"w_o", wo, 16}, {"+x", {1, 0, 0}, 2}, {"-x", {-1, 0, 0}, 2},
        {"+y", {0, 1, 0}, 2}, {"-y", {0, -1, 0}, 2}};
    if (work.whole())
        for (const Lobe& through : {Lobe{"-w_o", -wo, 2}, {"-w_o", -wo, 32}, {"the other side", -n, 1}})
            out.push_back(through);
    return out;
}

struct UnderLobe {
    double p = 1, mean = 0, due = 0;
};

UnderLobe under(const TrialContext& work, const SampleBatch& b, const Lobe& light, const Integral& due) {
    std::vector<double> x(b.draws.size());
    for (std::size_t i = 0; i < x.size(); ++i)
        if (const Draw& d = b.draws[i]; d.pdf > 0 && d.weight && work.counts(d.wi)) x[i] = *d.weight * light(d.wi);
    const Spread s = spread(x);
    return {mean_is_testable(s, tail_of(x), work.trial.theory) ? mean_p(s, due) : 1, s.mean, due.value};
}

Integral due_under(const TrialContext& work, const Lobe& light) {
    return work.integrate_light(
        [&](std::span<const Vec3d> wi, std::span<double> out) {
            const std::vector<double> f = work.f(wi, true);
            for (std::size_t i = 0; i < out.size(); ++i)
                out[i] = work.counts(wi[i]) ? f[i] * std::fabs(wi[i].z) * light(wi[i]) : 0;
        },
        true);
}

}  // namespace

bool directions_are_off(const TrialContext& work, Verdict& v) {
    const std::vector<Lobe> lobes = lobes_of(work);
    std::vector<Integral> due;
    for (const Lobe& lobe : lobes) due.push_back(due_under(work, lobe));
    const double many = static_cast<double>(lobes.size());
    std::size_t worst = 0;
    const auto least = [&](const SampleBatch& b, UnderLobe& out) {
        for (std::size_t k = 0; k < lobes.size(); ++k)
            if (const UnderLobe one = under(work, b, lobes[k], due[k]); one.p < out.p) out = one, worst = k;
        return std::min(many * out.p, 1.0);
    };
    UnderLobe first, again;
    const double p = least(work.first(0), first);
    v.evidence["lights"] = lobes.size();
    v.evidence["p_lights"] = p;
    if (!work.fails(p, [&](int round) { return least(work.draw(0, round), again); })) return false;
    const Lobe& light = lobes[worst];
    v.state = State::wrong;
    v.say = fmt::format(
        "Under a light from {}, ((1 + cos) / 2)^{:g} of the angle to it, the mean of the weights is {:.6g} where "
        "quadrature says {:.6g}, and so on a fresh seed: the draws go elsewhere than their weights say.",
        light.where, light.sharpness, again.mean, again.due);
    v.evidence["light"] = fmt::format("{}, {:g}", light.where, light.sharpness);
    return true;
}

}  // namespace crescent::inline verdicts
