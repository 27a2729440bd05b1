// valid: what comes back can be used at all.
#include "verdicts/valid.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "math/spherical.h"
#include "simd/frame.h"
#include "subjects/numbers.h"
#include "trials/trial_context.h"
#include "verdicts/corners.h"
#include "verdicts/verdict_kind.h"

namespace crescent::inline verdicts {

namespace {

/// NaN has no sign that means anything.
std::string number(double v) { return std::isnan(v) ? "nan" : fmt::format("{:.9g}", v); }

std::string told(Vec3d w) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", w.x, w.y, w.z); }

/// What is wrong with one draw, "" if nothing.
std::string fault_of(const Draw& d, double pdf_there) {
    if (std::isnan(d.pdf)) return "pdf is NaN";
    if (d.pdf < 0) return fmt::format("pdf is {:.9g}, negative", d.pdf);
    if (std::isinf(d.pdf)) return "pdf is infinite (a delta part is told apart: see docs/check.md)";
    if (std::isnan(d.wi.x + d.wi.y + d.wi.z)) return "the direction is NaN";
    if (d.pdf == 0 && d.delta == 0) return "";
    if (!(d.delta >= 0 && d.delta <= 1))
        return fmt::format("a delta part is chosen with probability {}, not in (0, 1]",
            number(d.delta == delta_never_chosen ? 0 : d.delta));
    if (d.delta > 0 && !d.weight) return "a draw of a delta part comes without its weight";
    const double length2 = dot(d.wi, d.wi);
    if (!std::isfinite(length2)) return "the direction is infinite";
    if (std::fabs(std::sqrt(length2) - 1) > 1e-5)
        return fmt::format("the direction {} has length {:.9g}, not 1", told(d.wi), std::sqrt(length2));
    if (!std::isfinite(pdf_there) || pdf_there < 0)
        return fmt::format("pdf(w) at {} is {}", told(d.wi), number(pdf_there));
    if (d.weight && !(std::isfinite(*d.weight) && is_finite(d.weights)))
        return fmt::format("the weight at {} is not finite", told(d.wi));
    constexpr double rounding = 1e-6;  // of 1 - F in single precision
    if (const double least = std::min({d.weight.value_or(0), d.weights.x, d.weights.y, d.weights.z}); least < -rounding)
        return fmt::format("the weight at {} is {:.9g}, negative", told(d.wi), least);
    return "";
}

/// "samples.csv:17, " for a draw that stands in a file.
std::string at_place(const TrialContext& work, const SampleBatch& b, std::size_t i) {
    const std::string place = work.subject.place(&b == &work.first(0) ? 0 : 1, i);
    return place.empty() ? "" : place + ", ";
}

}  // namespace

std::string first_fault(const TrialContext& work, int technique, const SampleBatch& b) {
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        const std::string fault = fault_of(b.draws[i], b.pdf[i]);
        if (!fault.empty())
            return fmt::format("{}at {}{}: {}", at_place(work, b, i), told(b.u[i], work.traits.numbers),
                work.subject.techniques() > 1 ? fmt::format(" of technique {}", technique + 1) : "", fault);
    }
    if (!work.subject.has_drawn_f()) return "";
    const std::vector<double>& f = work.f_of_drawn(b);
    for (std::size_t i = 0; i < f.size(); ++i) {
        const Draw& d = b.draws[i];
        if (!(d.pdf > 0) || !work.counts(d.wi)) continue;
        if (!std::isfinite(f[i]) || f[i] < 0)
            return fmt::format("{}f at {} is {}", at_place(work, b, i), told(d.wi), number(f[i]));
        if (!std::isfinite(f[i] * d.wi.z / d.pdf))
            return fmt::format("the weight f cos / p at {} is not finite", told(d.wi));
    }
    return "";
}

namespace {

/// " 812 of 32768 draws, 2.5 %, cannot be used: 800 of them are NaN."; "" where all can.
std::string share_of_faults(const TrialContext& work, int technique, Verdict& v) {
    const SampleBatch& b = work.first(technique);
    std::size_t faults = 0, nan = 0;
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        const Draw& d = b.draws[i];
        if (fault_of(d, b.pdf[i]).empty()) continue;
        ++faults;
        nan += std::isnan(d.pdf + d.wi.x + d.wi.y + d.wi.z + d.weight.value_or(0) + b.pdf[i]);
    }
    if (faults == 0) return "";
    v.evidence["draws_that_cannot_be_used"] = faults;
    v.evidence["draws_that_are_nan"] = nan;
    v.evidence["draws"] = b.draws.size();
    const double percent = 100 * static_cast<double>(faults) / static_cast<double>(b.draws.size());
    return fmt::format(" {} of {} draws, {:.3g} %, cannot be used{}.", faults, b.draws.size(), percent,
        nan == faults ? ": they are NaN"
            : nan > 0 ? fmt::format(": {} of them are NaN", nan)
                      : std::string());
}

/// Near the horizon on both sides, near the normal and between.
std::vector<Vec3d> all_over() {
    std::vector<Vec3d> wi;
    constexpr int turns = 16;
    for (double z : {1.0, 0.9999, 0.97, 0.85, 0.6, 0.35, 0.15, 0.05, 1e-2, 1e-3, 1e-5, 0.0, -1e-5, -1e-3, -1e-2, -0.1,
             -0.5, -0.9, -1.0})
        for (int k = 0; k < turns; ++k) wi.push_back(math::spherical(z, 2 * pi * (k + 0.37) / turns));
    return wi;
}

/// pdf(w) and f(w) there, whether drawn or not.
std::string fault_all_over(const TrialContext& work, int technique) {
    std::vector<Vec3d> wi = all_over();
    const std::vector<double> p = work.pdf(technique, wi);
    for (std::size_t i = 0; i < wi.size(); ++i)
        if (!std::isfinite(p[i]) || p[i] < 0) return fmt::format("pdf(w) at {} is {}", told(wi[i]), number(p[i]));
    if (!work.subject.has_f()) return "";
    std::erase_if(wi, [&](Vec3d w) { return !work.counts(w); });
    const std::vector<double> f = work.f(wi);
    for (std::size_t i = 0; i < wi.size(); ++i)
        if (!std::isfinite(f[i]) || f[i] < 0) return fmt::format("f at {} is {}", told(wi[i]), number(f[i]));
    return "";
}

/// f is told, and is 0 wherever it is asked: seen from below a surface that is opaque there, or from behind a shading
/// normal. Where nothing is drawn no draw tells of a sharp lobe: back along w_o, on through and by the mirror it is
/// looked for.
bool reflects_nothing(const TrialContext& work) {
    if (!work.subject.has_f()) return false;
    const Vec3d wo = work.trial.wo;
    std::vector<Vec3d> wi = {wo, -wo, mirror(wo), -mirror(wo)};
    std::erase_if(wi, [&](Vec3d w) { return !work.counts(w); });
    const std::vector<double> f = work.f(wi);
    return std::ranges::all_of(f, [](double v) { return v == 0; }) &&
        work.incoming(TrialContext::Where::everywhere, false).value == 0;
}

/// Nothing was drawn. It need not have been where p is small, which normalised tells of; nor under a surface of which
/// nothing is known but a p that is 0.
std::optional<Verdict> judge_no_draw(const TrialContext& work, std::uint64_t draws) {
    if (reflects_nothing(work))
        return work.verdict("valid", State::right, "No sample draws anything here, and f is 0: nothing to draw.");
    if (!work.traits.has_pdf) return {};
    const std::vector<double> p = work.any_pdf(all_over());
    if (std::ranges::any_of(p, [](double v) { return v > 0; }))
        return work.verdict("valid", State::right,
            fmt::format(
                "None of {} samples drew anything here, where p is not 0 everywhere: what it integrates to tells "
                "whether that can be.",
                draws));
    if (work.trial.wo.z < 0 && !work.subject.has_f() && !work.traits.eta && !work.traits.delta)
        return work.verdict("valid", State::right, "No sample draws anything here, and p is 0: nothing to draw.");
    return {};
}

/// What is wrong at corners of u or for a few draws alone leaves the rest to be judged.
std::optional<Verdict> judge_rare_faults(const TrialContext& work, int technique) {
    const CornerFaults at = corner_faults(work, technique);
    const SampleBatch& b = work.first(technique);
    if (at.count == 0 && b.dropped.empty()) return {};
    Verdict v = work.verdict("valid", State::wrong, "");
    v.evidence["usable"] = true;
    if (at.count > 0) {
        v.say = fmt::format(
            "What the sampler returns cannot be used {}: so at {} of {} corners of u. Random numbers of 24 bits come "
            "upon one in {:.3g} samples.",
            at.first, at.count, at.tried, 1 / at.chance);
        v.evidence["first_fault"] = at.first;
        v.evidence["corners"] = at.count;
        v.evidence["chance_of_a_sample"] = at.chance;
    }
    if (!b.dropped.empty()) {
        const std::string fault =
            fmt::format("at {}: {}", told(b.dropped[0].first, work.traits.numbers), fault_of(b.dropped[0].second, 0));
        v.say += fmt::format(
            "{}{} of {} draws cannot be used, first {}.", at.count ? " " : "", b.dropped.size(), b.draws.size(), fault);
        if (at.count == 0) v.evidence["first_fault"] = fault;
        v.evidence["draws_dropped"] = b.dropped.size();
    }
    v.say += " The other verdicts are of the draws that can be used.";
    return v;
}

Verdict judge_valid(TrialContext& work) {
    std::uint64_t draws = 0, drawn = 0, nothing = 0;
    for (int t = 0; t < work.subject.techniques(); ++t) {
        std::string fault = first_fault(work, t, work.first(t));
        if (fault.empty() && !work.subject.draws_at_will()) fault = first_fault(work, t, work.draw(t, 1));
        if (fault.empty()) fault = fault_all_over(work, t);
        if (!fault.empty()) {
            Verdict v = work.verdict("valid", State::wrong, "What the sampler returns cannot be used: " + fault + ".");
            v.evidence["first_fault"] = fault;
            v.say += share_of_faults(work, t, v);
            return v;
        }
        if (std::optional<Verdict> rare = judge_rare_faults(work, t)) return *rare;
        draws += work.first(t).draws.size();
        nothing += work.first(t).nothing - work.first(t).deltas;
        for (const Draw& d : work.first(t).draws) drawn += d.pdf > 0 || d.delta > 0;
    }
    if (drawn == 0)
        return judge_no_draw(work, draws)
            .value_or(work.verdict(
                "valid", State::wrong, fmt::format("None of {} samples drew anything: every pdf is 0.", draws)));
    Verdict v = work.verdict("valid", State::right,
        fmt::format("Every direction is finite and unit to 1e-5 and every pdf finite and at least 0, at the corners of "
                    "u, over {} draws and all over the sphere.",
            draws));
    if (const Scatter& s = work.scatter(); s.any()) {
        v.say += " " + told(s);
        v.evidence["random_estimates"] = {{"pdf", s.of_pdf}, {"f", s.of_f}, {"by_direction", s.hashed}};
    }
    v.evidence["draws"] = draws;
    const double share = static_cast<double>(nothing) / static_cast<double>(draws);
    if (share > 0.01) {
        v.evidence["share_that_drew_nothing"] = share;
        v.say += fmt::format(" {:.3g} % of them drew nothing: pdf 0, or under the horizon.", 100 * share);
    }
    v.evidence["direction_grain"] = work.direction_resolution();
    return v;
}

}  // namespace

constinit const VerdictKind kinds::valid = {.question = "can what comes back be used?", .judge = judge_valid};

}  // namespace crescent::inline verdicts
