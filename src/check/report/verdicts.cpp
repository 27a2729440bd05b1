// A verdict is wrong if a finding of its families is there; inconclusive where a stated size is too large for one;
// skipped where the sampler gives nothing that its families could ask; else right.
#include "check/report/verdicts.h"

#include <algorithm>
#include <fmt/format.h>

#include "check/constants.h"
#include "check/decide/tail.h"
#include "judgements/all.h"

namespace crescent::check {

namespace {

std::string direction(Vec3d w) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", w.x, w.y, w.z); }

/// What was found, how large, with its interval, and where.
std::string sentence_of(const CheckAt& c, const Finding& f) {
    const Answer& a = f.second.sd > 0 ? f.second : f.first;
    const double half = 1.96 * a.sd;
    switch (f.first.family) {
        case Family::mass:
        case Family::mass_sets: {
            const double drawn = a.expected + a.difference;
            if (!(drawn > 0)) return fmt::format("Nothing is drawn, and p integrates to {:.5g}.", a.expected);
            return fmt::format("p integrates to {:.6g} +- {:.1g} where {:.6g} of the samples draw a direction.",
                a.expected, half, drawn);
        }
        case Family::node:
        case Family::node_sets: {
            const ChartRect& r = c.plan->tree.nodes()[static_cast<std::size_t>(f.first.member)].rect;
            return fmt::format(
                "Draws and p differ about w_i = {}, within {:.2g} rad: by {:+.3g} +- {:.1g} of what is drawn.",
                direction(from_chart(r.at(0.5, 0.5))), std::max(r.theta_width(), r.phi_width()), a.difference, half);
        }
        case Family::slope:
        case Family::slope_sets:
            return fmt::format("Draws are {} concentrated than p: mean of h ln p {:+.3g} +- {:.1g}.",
                a.difference > 0 ? "more" : "less", a.difference, half);
        case Family::centre:
        case Family::centre_sets:
            return fmt::format("The mean direction of the draws is off p's in {} by {:+.3g} +- {:.1g}.",
                "xyz"[std::clamp(f.first.member, 0, 2)], 2 * a.difference, 2 * half);
        case Family::delta_share:
            return fmt::format("A delta part is {:.5g} +- {:.1g} of the draws and states a probability of {:.5g}.",
                a.expected + a.difference, half, a.expected);
        case Family::delta_scatter:
            return "Draws said to be of delta parts have more than 16 directions: what has a density is no delta part.";
        case Family::delta_weight:
            return fmt::format("{:g} draws of a delta part have another weight than the first of it.", a.difference);
        case Family::depth: return "Draws and p differ in many small places.";
        case Family::bridge:
        case Family::bridge_sets:
            return fmt::format("Draws and p differ where they are: {:+.3g} +- {:.1g} of the bridge sum {:.4g}.",
                a.difference, half, a.expected);
        case Family::pointwise:
            return fmt::format("The pdf with a draw is not pdf(w) for {:.2g} of the draws.", a.difference);
        case Family::zero: return fmt::format("pdf(w) is 0 at {:.2g} of the draws.", a.difference);
        case Family::weight: return fmt::format("The weight is not f cos / pdf for {:.2g} of the draws.", a.difference);
        case Family::repeats:
            return fmt::format("{:g} of {:g} draws repeat a direction.", a.difference, c.observations.independent);
        case Family::support:
            return fmt::format(
                "p is 0 over directions that carry {:.3g} % of f L cos.", 100 * a.difference / a.expected);
        case Family::mean:
            return fmt::format("The weights estimate the light {:+.3g} % off, +- {:.1g} %.",
                100 * a.difference / a.expected, 100 * half / a.expected);
        case Family::true_f: return fmt::format("f is not the BRDF for {:.2g} of the draws.", a.difference);
        case Family::albedo:
            return fmt::format("f reflects {:.5g} +- {:.1g} of an even light.", 1 + a.difference, half);
        default: return fmt::format("{:g} answers cannot be used.", a.difference);
    }
}

std::string sentence_of(const SmallFault& f) {
    std::string out = fmt::format("{:g} of {:g}: {}", f.times, f.of, f.what);
    if (f.size != 0) out += fmt::format(" ({:+.3g})", f.size);
    return out + ".";
}

/// Whether the sampler gives what a verdict needs.
bool can_be_asked(const JudgedSampler& s, std::string_view name) {
    if (name == "normalised" || name == "density") return s.traits().has_pdf;
    if (name == "support") return s.traits().has_pdf && s.has_f();
    if (name == "physics") return s.has_f() || s.traits().delta;
    if (name == "mean") return s.has_f();
    if (name == "tail") return s.has_drawn_f();
    return name != "efficiency";  // of several samplers
}

void add_sizes(const Sizes& s, Verdict& v) {
    const auto add = [&](const char* name, const std::optional<double>& size) {
        if (size) v.evidence["would_have_found"][name] = *size;
    };
    if (v.name == "normalised") add("constant", s.constant);
    if (v.name != "density") return;
    add("leak", s.leak), add("cap", s.cap), add("rotation", s.rotation), add("parameter", s.parameter);
}

void judge_at(const CheckAt& c, Verdict& v) {
    for (const SmallFault& f : c.small)
        if (info(f.family).verdict == v.name)
            v.state = State::wrong, v.say += (v.say.empty() ? "" : " ") + sentence_of(f);
    const Finding* worst = nullptr;
    for (const Finding& f : c.findings)
        if (info(f.first.family).verdict == v.name) {
            v.evidence["tests"][std::string(info(f.first.family).name)] = {{"difference", f.second.difference},
                {"expected", f.second.expected}, {"sd", f.second.sd}, {"p_first", f.first.p}, {"p_again", f.second.p}};
            if (!worst || f.second.p < worst->second.p) worst = &f;
        }
    if (worst) v.state = State::wrong, v.say += (v.say.empty() ? "" : " ") + sentence_of(c, *worst);
    for (const Answer& a : c.answers)
        if (info(a.family).verdict == v.name && v.state != State::wrong)
            v.evidence["p"][std::string(info(a.family).name)] = a.p;
    if (v.state == State::wrong) return;
    add_sizes(c.sizes, v);
    if (c.inconclusive && (v.name == "density" || v.name == "normalised")) {
        Sizes only;
        v.name == "normalised" ? void(only.constant = c.sizes.constant) : void(only = c.sizes);
        if (v.name == "density") only.constant.reset();
        if (worst_ratio(only) <= inconclusive_at) return;
        v.state = State::inconclusive;
        v.say = "A fault ten times its target would not have been found.";
        v.next = {NextStep::Kind::more_draws, worst_ratio(only) * worst_ratio(only) / 25};
    }
}

}  // namespace

std::vector<Verdict> verdicts_of(
    std::span<const Trial> trials, const CheckOutcome& outcome, const std::optional<Cause>& cause) {
    std::vector<Verdict> out;
    bool first_density = true;
    for (std::size_t k = 0; k < outcome.trials.size(); ++k) {
        const Trial& trial = trials[outcome.trials[k]];
        for (std::string_view name : verdict_names) {
            Verdict v;
            v.arm = trial.arm, v.trial = trial.text(), v.name = name;
            if (v.trial != without_wo) v.wo = {trial.theta_deg, trial.azimuth_deg};
            if (!can_be_asked(*trial.subject, name)) {
                v.state = State::skipped;
                out.push_back(std::move(v));
                continue;
            }
            for (const CheckAt& c : outcome.at[k]) {
                judge_at(c, v);
                v.seconds += c.seconds / static_cast<double>(verdict_names.size());
            }
            if (name == "tail") judge_tail(trial, outcome.at[k], v);
            if (name == "mean") leave_heavy_mean_open(outcome.at[k], v);
            if (k == 0)
                for (const SmallFault& f : outcome.small)
                    if (info(f.family).verdict == name) v.state = State::wrong, v.say += sentence_of(f);
            if (cause && first_density && v.state == State::wrong && (name == "density" || name == "normalised")) {
                v.cause = cause->text;
                v.evidence["diagnosis"] = cause->factor;
                first_density = false;
            }
            out.push_back(std::move(v));
        }
    }
    return out;
}

}  // namespace crescent::check
