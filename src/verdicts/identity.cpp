// identity: what the sampler says twice, it says alike: pdf with the draw and pdf(w); weight and f cos / p; f and what
// f ought to be; MIS weights that sum to one; and p |Jacobian| of the warp (jacobian.cpp).
//
// Tolerance: 1e-4, and what p itself moves by when the components of wi and wo move by four roundings ("conditioning"):
// (w.R)^s moves by s eps when w.R does by eps, so a float sampler at s = 1e5 may differ from itself by per cents and be
// right.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "verdicts/ordered.h"

namespace crescent {

namespace {

constexpr double tolerance = 1e-4;  // relative

std::array<Vec3d, 6> nudges(Vec3d w, double by) {
    return {{{w.x + by, w.y, w.z}, {w.x - by, w.y, w.z}, {w.x, w.y + by, w.z}, {w.x, w.y - by, w.z},
        {w.x, w.y, w.z + by}, {w.x, w.y, w.z - by}}};
}

std::vector<Pair> nudged(Vec3d wo, Vec3d wi, double grain) {
    const double by = 4 * std::max(grain, 0x1p-50);
    std::vector<Pair> at;
    for (Vec3d v : nudges(wi, by)) at.push_back({wo, v});
    for (Vec3d v : nudges(wo, by)) at.push_back({v, wi});
    return at;
}

double largest_change(std::span<const double> values, double from) {
    double most = 0;
    for (double v : values)
        if (std::isfinite(v)) most = std::max(most, std::fabs(v - from));
    return most;
}

/// Draws for which `said` and `asked` differ beyond tolerance and conditioning.
struct Mismatch {
    std::size_t count = 0, tried = 0;
    double worst = 0;  // relative
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
    bool matters() const { return count >= 3 && static_cast<double>(count) > 1e-4 * static_cast<double>(tried); }
    std::string told(std::string_view a, std::string_view b) const {
        return fmt::format(
            "{} and {} differ for {} of {} draws, most at w = ({:.6g}, {:.6g}, {:.6g}): {:.6g} against {:.6g}", a, b,
            count, tried, at.x, at.y, at.z, said, asked);
    }
};

bool close(double a, double b, double extra = 0) {
    return std::fabs(a - b) <= tolerance * std::max(std::fabs(a), std::fabs(b)) + extra;
}

Mismatch pdf_twice(const Work& work, int t) {
    Mismatch m;
    const Batchful& b = work.first(t);
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        const Draw& d = b.draws[i];
        if (!(d.pdf > 0) || !work.counts(d.wi)) continue;  // elsewhere a pdf weighs nothing
        ++m.tried;
        if (close(d.pdf, b.pdf[i], 2 * work.subject.doubt(d.wi))) continue;
        if (m.count < 4096 && close(d.pdf, b.pdf[i], pdf_conditioning(work, t, d.wi, b.pdf[i]))) continue;
        m.add(d.pdf, b.pdf[i], d.wi);
    }
    return m;
}

/// The sampler's own weight beside f cos / p, and f beside what it ought to be.
Mismatch weight_twice(const Work& work, const Batchful& b, bool truth) {
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
        if (close(said, asked)) continue;
        const double loose = f_conditioning(work, work.trial.wo, wi[i], f[i]);
        if (m.count < 4096 && close(said, asked, truth ? loose : g * loose + 4 * work.grain() * std::fabs(asked) / cos))
            continue;
        m.add(said, asked, wi[i]);
    }
    return m;
}

/// The same u in the opposite order: answers that differ come from something else than wo and u.
struct Repeated {
    std::size_t tried = 0, other = 0;
    Vec2d u{};
    Vec3d first{}, again{};
};

Repeated ask_again(const Work& work, int technique) {
    Repeated out;
    if (!work.subject.draws_at_will() || work.subject.own_random()) return out;
    const Batchful& b = work.first(technique);
    out.tried = std::min<std::size_t>(b.u.size(), 256);
    std::vector<Vec2d> u(b.u.begin(), b.u.begin() + static_cast<std::ptrdiff_t>(out.tried));
    std::reverse(u.begin(), u.end());
    std::vector<Draw> again(out.tried);
    work.subject.sample(technique, work.trial.wo, u, again);
    for (std::size_t i = 0; i < out.tried; ++i) {
        const Draw &x = b.draws[i], &y = again[out.tried - 1 - i];
        const bool nothing = !(x.pdf > 0) && !(y.pdf > 0);
        if (nothing || (x.pdf == y.pdf && x.wi.x == y.wi.x && x.wi.y == y.wi.y && x.wi.z == y.wi.z)) continue;
        if (out.other++ > 0) continue;
        out.u = b.u[i];
        out.first = x.wi;
        out.again = y.wi;
    }
    return out;
}

Mismatch mis_sum(const Work& work, const Batchful& b) {
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

Verdict wrong(const Work& work, Verdict v, const Mismatch& m, std::string_view a, std::string_view b) {
    v.state = State::wrong;
    v.say = m.told(a, b) + ".";
    v.evidence["mismatches"] = m.count;
    v.evidence["largest_relative_difference"] = m.worst;
    v.evidence["direction_grain"] = work.grain();
    return v;
}

}  // namespace

double pdf_conditioning(const Work& work, int technique, Vec3d wi, double p) {
    const std::vector<Pair> at = nudged(work.trial.wo, wi, work.grain());
    std::vector<double> values(at.size());
    work.subject.pdf(technique, at, values);
    return 2 * largest_change(values, p);
}

double f_conditioning(const Work& work, Vec3d wo, Vec3d wi, double f) {
    const std::vector<Pair> at = nudged(wo, wi, std::max(work.grain(), 0x1p-24));
    std::vector<double> values(at.size());
    work.subject.f(at, values);
    return 2 * largest_change(values, f);
}

Verdict judge_identity(const Work& work) {
    Verdict v = work.verdict("identity", State::right, "");
    double one_to_one = 1;
    for (int t = 0; t < work.subject.techniques(); ++t) {
        const Batchful& b = work.first(t);
        const std::string tag = work.subject.techniques() > 1 ? fmt::format("_{}", t + 1) : "";
        if (const Repeated r = ask_again(work, t); r.other > 0) {
            v.state = State::wrong;
            v.evidence["asked_again"] = r.tried;
            v.evidence["answered_otherwise"] = r.other;
            v.say = fmt::format(
                "The same u gives another answer when it is asked again, {} of {} times; at u = ({:.9g}, {:.9g}) first "
                "({:.6g}, {:.6g}, {:.6g}), then ({:.6g}, {:.6g}, {:.6g}). "
                "The sampler is no function of w_o and u: it keeps a state, or answers out of turn.",
                r.other, r.tried, r.u.x, r.u.y, r.first.x, r.first.y, r.first.z, r.again.x, r.again.y, r.again.z);
            return v;
        }
        if (const Mismatch m = pdf_twice(work, t); m.matters())
            return wrong(work, v, m, "The pdf that came with the draw", "pdf(w)");
        if (work.subject.has_f()) {
            if (const Mismatch m = weight_twice(work, b, false); m.matters())
                return wrong(work, v, m, "The weight", "f cos / p");
            if (const Mismatch m = work.subject.has_true_f() ? weight_twice(work, b, true) : Mismatch{}; m.matters())
                return wrong(work, v, m, "f", "the BRDF it claims to be");
        }
        if (work.subject.techniques() > 1)
            if (const Mismatch m = mis_sum(work, b); m.matters())
                return wrong(work, v, m, "The sum of the MIS weights", "1");
        const WarpFinding warp = study_warp(work, t);
        v.evidence["warp_points" + tag] = warp.usable;
        v.evidence["p_jacobian_is_1" + tag] = warp.one_to_one;
        one_to_one = std::min(one_to_one, warp.one_to_one);
        if (warp.below >= 3 && static_cast<double>(warp.below) > 5e-3 * static_cast<double>(warp.usable)) {
            v.state = State::wrong;
            v.evidence["smallest_p_jacobian"] = warp.smallest;
            v.say = fmt::format(
                "p |Jacobian of the warp| is below 1 at {} of {} points, least at u = ({:.4g}, {:.4g}): {:.6g}. The "
                "sampler is denser there than p says.",
                warp.below, warp.usable, warp.at.x, warp.at.y, warp.smallest);
            return v;
        }
        v.evidence["steps_of_u" + tag] = warp.steps_tried;
        v.evidence["steps_without_a_move" + tag] = warp.stuck;
        if (warp.steps_tried >= 40 && static_cast<double>(warp.stuck) > 0.4 * static_cast<double>(warp.steps_tried)) {
            v.state = State::wrong;
            v.say = fmt::format(
                "The direction stands still for {} of {} moves of u by 2^-19: u is used with too few bits, and only a "
                "grid of directions is ever drawn.",
                warp.stuck, warp.steps_tried);
            return v;
        }
    }
    v.say = "The pdf with a draw equals pdf(w)";
    if (work.subject.has_f()) v.say += ", the weight f cos / p";
    if (work.subject.techniques() > 1) v.say += ", the MIS weights sum to 1";
    if (!work.subject.draws_at_will()) v.say += "; the warp itself is not at hand";
    else if (one_to_one > 0.99) v.say += ", and p |Jacobian of the warp| is 1";
    else v.say += ", and p |Jacobian of the warp| is nowhere below 1";
    v.say += ".";
    return v;
}

}  // namespace crescent
