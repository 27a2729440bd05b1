// A verdict is wrong if there is a finding of its families; inconclusive if a stated size is too large; skipped if the
// sampler provides nothing that its families can test; otherwise right.
#include "check/report/verdicts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/constants.h"
#include "check/decide/check_at.h"
#include "check/decide/sizes.h"
#include "check/decide/tail.h"
#include "check/report/places.h"
#include "check/report/sentences.h"
#include "check/verdict.h"
#include "check/verdicts/kinds.h"
#include "output/format.h"

namespace crescent::check {

namespace {

void add_sizes(const Sizes& sizes, const Traits& traits, Verdict& v) {
    constexpr double undetectable_share = 0.99;  // of the draws or of p: no fault of this kind would be found
    for (std::size_t k = 0; k < sizes.faults.size(); ++k) {
        const FaultKind& kind = fault_kinds()[k];
        const std::optional<double>& size = sizes.faults[k].size;
        if (v.name != kind.verdict || !size || *size > undetectable_share) continue;
        const char* name = kind.words(traits).name;
        double& largest = v.hidden[name];
        largest = std::max(largest, *size);
        v.evidence["would_have_found"][name] = largest;
    }
}

/// The share of the answers or tests that fail, as the size of a fault.
double share_of(const SmallFault& f) { return std::max(std::fabs(f.size), f.times / std::max(f.trials, 1.0)); }

/// Adds a fault of the answers or of one test, and the random numbers of its first place.
void add_fault(const SmallFault& f, const Traits& traits, Verdict& v) {
    v.state = State::wrong;
    v.size = std::max(v.size, share_of(f));
    if (const std::vector<double> u = numbers_of(f, traits); !u.empty()) v.evidence.emplace("first_u", u);
}

bool compares_densities(Family f) {
    return info(f).verdict == "density" && f != Family::delta_share && f != Family::delta_scatter;
}

/// The size of a finding as a share: of the draws, of p, or of the expected value.
double share_of(const CheckAt& c, const Answer& a) {
    const double relative = std::fabs(a.difference) / std::max(std::fabs(a.expected), 1e-300);
    switch (a.family) {
        case Family::values: return std::fabs(a.difference) / std::max<double>(static_cast<double>(c.evaluations), 1);
        case Family::repeats: return std::fabs(a.difference) / std::max(c.observations.independent, 1.0);
        case Family::mass:
        case Family::mass_sets:  // p over draws
            return std::fabs(math::log(std::max(a.expected, 1e-12) / std::max(a.expected + a.difference, 1e-12)));
        case Family::bridge:
        case Family::bridge_sets:
        case Family::support:
        case Family::mean:
        case Family::albedo: return relative;
        case Family::slope:
        case Family::slope_sets:
        case Family::centre:
        case Family::centre_sets:
        case Family::depth: return 0;  // no share: a mean or a sum of squares
        default: return std::fabs(a.difference);
    }
}

/// The sentence of the worst finding. For densities: where the shares of draws and p differ most, and whether the draws
/// are more concentrated, for any test that failed; the same wording at each w_o.
Sentences describe_worst(const CheckAt& c, const Finding& worst, Verdict& v) {
    const Answer& a = worst.second.sd > 0 ? worst.second : worst.first;
    Sentences out;
    double size = share_of(c, a);
    if (compares_densities(worst.first.family) && c.plan)
        if (const std::optional<ShareDifference> place = largest_difference(*c.plan, c.integrals, c.observations)) {
            out.push_back(sentence_of(*place, c.traits));
            size = std::fabs(place->difference());
            if (const auto spread = concentration_of(c))
                if (std::optional<Sentence> sentence = sentence_of(*spread, c.traits))
                    out.push_back(std::move(*sentence));
            v.evidence["largest_difference"] = {{"drawn", place->drawn_share}, {"drawn_error", place->drawn_error},
                {"p", place->claimed_share}, {"p_error", place->claimed_error}};
        }
    if (out.empty()) out = sentences_of(c, worst);
    if (const Count& invalid = c.observations.checks.invalid; a.family == Family::values && invalid.times > 0)
        v.evidence.emplace("first_u", numbers_of(invalid.first, c.traits));
    if (a.family == Family::mass || a.family == Family::mass_sets) v.integral = a.expected;
    v.size = std::max(v.size, size);
    return out;
}

/// Sets the state and the numbers of the verdict; returns what it states of this technique.
Sentences decide_at(const CheckAt& c, Verdict& v) {
    Sentences out;
    const DrawChecks& checks = c.observations.checks;
    if (v.name == verdict_names[0] && checks.draws > 0) {
        const auto draw_count = static_cast<double>(checks.draws);
        v.nothing = std::max(v.nothing, static_cast<double>(checks.nothing - checks.draws_below) / draw_count);
        v.outside = std::max(v.outside, static_cast<double>(checks.draws_below) / draw_count);
    }
    for (const SmallFault& f : c.small)
        if (info(f.family).verdict == v.name) {
            add_fault(f, c.traits, v);
            out.push_back(sentence_of(f, c.traits));
        }
    const Finding* worst = nullptr;
    for (const Finding& f : c.findings)
        if (info(f.first.family).verdict == v.name) {
            v.evidence["tests"][std::string(info(f.first.family).name)] = {{"difference", f.second.difference},
                {"expected", f.second.expected}, {"sd", f.second.sd}, {"p_first", f.first.p}, {"p_again", f.second.p}};
            if (!worst || f.second.p < worst->second.p) worst = &f;
        }
    if (worst) {
        v.state = State::wrong;
        std::ranges::move(describe_worst(c, *worst, v), std::back_inserter(out));
    }
    for (const Answer& a : c.answers)
        if (info(a.family).verdict == v.name && v.state != State::wrong)
            v.evidence["p"][std::string(info(a.family).name)] = a.p;
    if (v.state == State::wrong) return out;
    add_sizes(c.sizes, c.traits, v);
    if (v.name == "density" && c.moved_by_resolution > 0) {
        v.state = State::inconclusive;
        v.next_step = "Random numbers of 53 bits (u_bits=53).";
        return {{"resolution",
                    fmt::format("A step of 2^-24 of one random number moves {:.2g} % of the draws to another place.",
                        100 * c.moved_by_resolution)},
            {"difference", "The draws differ from p by no more than that."}};
    }
    const double ratio = worst_ratio(c.sizes, v.name);
    if (ratio <= c.most_ratio()) return out;
    v.state = State::inconclusive;
    constexpr double margin = 2;  // of the sizes that more draws are to reach
    v.next = {NextStep::Kind::more_draws, sqr(margin * ratio / c.most_ratio())};
    return sentences_of_open(c, v.name);
}

/// Names the technique in the first of its sentences, if several techniques are combined.
void name_technique(const CheckCase& check_case, const CheckAt& c, Sentences& sentences) {
    const int techniques = check_case.adapter->techniques();
    if (techniques < 2 || sentences.empty()) return;
    const std::string name = check_case.adapter->technique_name(c.technique);
    Sentence& first = sentences.front();
    first.technique = c.technique + 1;
    first.text =
        fmt::format("Sampler {} of {}{}: {}", first.technique, techniques, name.empty() ? "" : ", " + name, first.text);
}

/// Faults of the sampler as a whole are reported with its first w_o, but have places of their own.
void add_faults_of_sampler(const CheckOutcome& outcome, const Traits& traits, Verdict& v) {
    const bool is_wrong = v.state == State::wrong;
    for (const SmallFault& f : outcome.small) {
        if (info(f.family).verdict != v.name) continue;
        add_fault(f, traits, v);
        v.sentences.push_back(sentence_of(f, traits));
        if (!is_wrong) v.place = f.wo ? "w_o = " + direction_text(*f.wo) : "pairs of directions";
    }
}

/// Whether the sampler draws at another w_o.
bool draws_elsewhere(const CheckOutcome& outcome) {
    return std::ranges::any_of(outcome.checks, [](const std::vector<CheckAt>& techniques) {
        return std::ranges::any_of(techniques, [](const CheckAt& c) { return !c.nothing_drawn || c.draws_elsewhere; });
    });
}

/// A verdict at a w_o where nothing is drawn and p is 0 everywhere: nothing was tested. It is skipped if the sampler
/// has nothing to draw there or draws elsewhere.
void note_nothing_drawn(const CheckAt& c, bool has_draws_elsewhere, bool has_f, Verdict& v) {
    if (v.name == "valid" || v.name == "physics" || v.state == State::wrong) return;
    const bool is_dark = has_f && c.integrals.light.lit.value == 0;
    v.state = has_draws_elsewhere || is_dark ? State::skipped : State::inconclusive;
    v.sentences = {{"not tested",
        fmt::format(
            "Not tested: none of {} samples is a direction, and p is 0 everywhere.", c.observations.checks.draws)}};
    v.next = {};
    if (v.state == State::inconclusive) v.next_step = "A sampler that draws directions.";
}

void withhold(const CheckAt& c, Verdict& v) {
    if (!c.is_withheld(v.name)) return;
    v.state = State::skipped;
    v.sentences = {{"withheld", "Not given, since too many of the answers are not numbers: see valid."}};
    v.next = {};
    v.next_step.clear();
}

/// Adds the cause to one verdict: a constant to `normalised`, another density to `density`, otherwise to the verdict of
/// the cause, or else to the first wrong verdict.
void place(const Cause& cause, std::vector<Verdict>& verdicts) {
    std::vector<std::string_view> names = {"density", "normalised"};
    if (!cause.verdict.empty()) names = {cause.verdict};
    else if (cause.factor == "constant") names = {"normalised", "density"};
    names.push_back("");
    for (std::string_view name : names)
        for (Verdict& v : verdicts) {
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
            v.arm = check_case.arm;
            v.check_case = check_case.text();
            v.name = name;
            if (v.check_case != without_wo) v.wo = {check_case.theta_deg, check_case.azimuth_deg};
            if (!kind.applies(*check_case.adapter)) {
                v.state = State::skipped;
                v.sentences = {{"needs", kind.needs}};
                out.push_back(std::move(v));
                continue;
            }
            for (const CheckAt& c : outcome.checks[k]) {
                Sentences sentences = decide_at(c, v);
                name_technique(check_case, c, sentences);
                std::ranges::move(sentences, std::back_inserter(v.sentences));
                if (kind.add) kind.add(c, v);
                v.seconds += c.seconds / static_cast<double>(verdict_names.size());
            }
            if (name == "tail") test_tail(check_case, outcome.tails[k], v);
            if (name == "mean") test_plain_mean(outcome.tails[k], v);
            for (const CheckAt& c : outcome.checks[k]) note_limits(*check_case.adapter, c, v);
            for (const CheckAt& c : outcome.checks[k]) withhold(c, v);
            if (!outcome.checks[k].empty() && std::ranges::all_of(outcome.checks[k], &CheckAt::nothing_drawn))
                note_nothing_drawn(outcome.checks[k][0], draws_elsewhere(outcome), check_case.adapter->has_f(), v);
            if (k == 0) add_faults_of_sampler(outcome, check_case.adapter->traits(), v);
            if (v.state == State::right && v.sentences.empty() && !outcome.checks[k].empty())
                v.sentences = sentences_of_right(outcome.checks[k][0], name);
            out.push_back(std::move(v));
        }
    }
    if (cause) place(*cause, out);
    return out;
}

}  // namespace crescent::check
