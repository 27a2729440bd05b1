// A verdict is wrong if there is a finding of its families; inconclusive if a stated size is too large; skipped if the
// sampler provides nothing that its families can test; otherwise right.
#include "check/report/verdicts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/constants.h"
#include "check/decide/check_at.h"
#include "check/verdict.h"
#include "check/verdicts/kinds.h"

namespace crescent::check {

namespace {

void add_sizes(const Sizes& s, Verdict& v) {
    const auto add = [&](const char* name, const std::optional<double>& size) {
        constexpr double all = 0.99;  // of the draws or of p: no fault of this kind would be found
        if (!size || *size > all) return;
        double& most = v.hidden[name];
        most = std::max(most, *size);
        v.evidence["would_have_found"][name] = most;
    };
    if (v.name == "normalised") add("constant", s.constant);
    if (v.name != "density") return;
    add("leak", s.leak), add("cap", s.cap), add("rotation", s.rotation), add("parameter", s.parameter);
}

void decide_at(const CheckAt& c, Verdict& v) {
    constexpr double beyond_chance = 1e9;  // standard errors of a count
    const DrawChecks& checks = c.observations.checks;
    if (v.name == verdict_names[0] && checks.tested > 0)
        v.nothing = std::max(v.nothing, static_cast<double>(checks.nothing) / static_cast<double>(checks.tested));
    for (const SmallFault& f : c.small)
        if (info(f.family).verdict == v.name)
            v.state = State::wrong, v.size = beyond_chance * f.times / std::max(f.of, 1.0),
            v.message += (v.message.empty() ? "" : " ") + sentence_of(f, c.numbers);
    const Finding* worst = nullptr;
    for (const Finding& f : c.findings)
        if (info(f.first.family).verdict == v.name) {
            v.evidence["tests"][std::string(info(f.first.family).name)] = {{"difference", f.second.difference},
                {"expected", f.second.expected}, {"sd", f.second.sd}, {"p_first", f.first.p}, {"p_again", f.second.p}};
            if (!worst || f.second.p < worst->second.p) worst = &f;
        }
    if (worst) {
        const Answer& a = worst->second.sd > 0 ? worst->second : worst->first;
        v.size = std::max(v.size, std::fabs(a.difference) * (a.sd > 0 ? 1 / a.sd : beyond_chance));
    }
    if (worst) v.state = State::wrong, v.message += (v.message.empty() ? "" : " ") + sentence_of(c, *worst);
    for (const Answer& a : c.answers)
        if (info(a.family).verdict == v.name && v.state != State::wrong)
            v.evidence["p"][std::string(info(a.family).name)] = a.p;
    if (v.state == State::wrong) return;
    add_sizes(c.sizes, v);
    if (c.inconclusive && (v.name == "density" || v.name == "normalised")) {
        Sizes only;
        v.name == "normalised" ? void(only.constant = c.sizes.constant) : void(only = c.sizes);
        if (v.name == "density") only.constant.reset();
        if (worst_ratio(only) <= c.most_ratio()) return;
        v.state = State::inconclusive;
        v.message = "A fault ten times its target would not have been found.";
        v.next = {NextStep::Kind::more_draws, worst_ratio(only) * worst_ratio(only) / 25};
    }
}

/// Adds the cause to one verdict: a constant to `normalised`, another density to `density`, otherwise to the verdict of
/// the cause, or else to the first wrong verdict.
void place(const Cause& cause, std::vector<Verdict>& all) {
    std::vector<std::string_view> names = {"density", "normalised"};
    if (!cause.verdict.empty()) names = {cause.verdict};
    else if (cause.factor == "constant") names = {"normalised", "density"};
    names.push_back("");
    for (std::string_view name : names)
        for (Verdict& v : all) {
            if (v.state != State::wrong || (!name.empty() && v.name != name)) continue;
            v.cause = cause.text;
            v.evidence["diagnosis"] = cause.factor;
            if (cause.exponent != 0) v.evidence["diagnosis_value"] = cause.exponent;
            if (cause.error > 0) v.evidence["diagnosis_error"] = cause.error;
            return;
        }
}

}  // namespace

std::vector<Verdict> verdicts_of(
    std::span<const CheckCase> check_cases, const CheckOutcome& outcome, const std::optional<Cause>& cause) {
    std::vector<Verdict> out;
    for (std::size_t k = 0; k < outcome.check_cases.size(); ++k) {
        const CheckCase& check_case = check_cases[outcome.check_cases[k]];
        for (std::size_t n = 0; n < verdict_names.size(); ++n) {
            const std::string_view name = verdict_names[n];
            const VerdictKind& kind = *verdict_kinds[n];
            Verdict v;
            v.arm = check_case.arm, v.check_case = check_case.text(), v.name = name;
            if (v.check_case != without_wo) v.wo = {check_case.theta_deg, check_case.azimuth_deg};
            if (!kind.applies(*check_case.adapter)) {
                v.state = State::skipped;
                v.message = kind.needs;
                out.push_back(std::move(v));
                continue;
            }
            for (const CheckAt& c : outcome.at[k]) {
                decide_at(c, v);
                if (kind.add) kind.add(c, v);
                v.seconds += c.seconds / static_cast<double>(verdict_names.size());
            }
            if (name == "tail") test_tail(check_case, outcome.tails[k], v);
            if (name == "mean") test_plain_mean(outcome.tails[k], v);
            for (const CheckAt& c : outcome.at[k]) note_limits(*check_case.adapter, c, v);
            if (k == 0)
                for (const SmallFault& f : outcome.small)
                    if (info(f.family).verdict == name)
                        v.state = State::wrong,
                        v.message +=
                            (v.message.empty() ? "" : " ") + sentence_of(f, check_case.adapter->traits().numbers);
            if (v.state == State::right && v.message.empty() && !outcome.at[k].empty())
                v.message = sentence_of_right(outcome.at[k][0], name);
            out.push_back(std::move(v));
        }
    }
    if (cause) place(*cause, out);
    return out;
}

}  // namespace crescent::check
