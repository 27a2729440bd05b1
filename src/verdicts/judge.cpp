// Each trial by itself on any thread, unless its sampler is serial: valid first, then the densities are integrated,
// then the other verdicts in the list's order. What compares trials, or pools them, comes when all are there. A sampler
// that breaks off leaves its other trials standing.
#include "verdicts/judge.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/parallel.h"
#include "base/stopwatch.h"
#include "diagnosis/diagnosis.h"
#include "subjects/asked_once.h"
#include "subjects/faults.h"
#include "trials/contrasts.h"
#include "verdicts/efficiency.h"
#include "verdicts/outcome.h"
#include "verdicts/verdict_kind.h"

namespace crescent::inline verdicts {

namespace {

Verdict skipped(const Trial& trial, std::string_view name, std::string say) {
    Verdict v;
    v.arm = trial.arm;
    v.trial = trial.text();
    v.name = name;
    v.state = State::skipped;
    v.say = std::move(say);
    return v;
}

/// Of the verdicts on one trial, those from the second on.
void skip_rest(const Trial& trial, Outcome& out, const std::string& why) {
    for (std::size_t k = 1; k < verdict_kinds.size(); ++k)
        if (verdict_kinds[k]->judge) out.verdicts.push_back(skipped(trial, verdict_names[k], why));
}

/// Whether it is what is expected of a right sampler, or of a built-in arm here.
void expect(const Trial& trial, const VerdictKind& kind, Verdict& v) {
    const bool may_stay_open = kind.may_stay_open || v.evidence.contains("unmet_share");
    const bool must_be_wrong = trial.theory.wrong && *trial.theory.wrong == v.name;
    const bool infinite = trial.theory.tail_k && *trial.theory.tail_k >= 0.5;
    if (must_be_wrong) {
        v.expected = v.state == State::wrong;
        v.why_expected = trial.theory.why;
    } else if (infinite && kind.needs_variance) {
        v.expected = v.state == State::inconclusive;
        v.why_expected = trial.theory.why;
    } else if (!trial.theory.underflows.empty() && v.name == "support" && v.state == State::wrong) {
        v.expected = true;
        v.why_expected = trial.theory.underflows;
    } else {
        v.expected =
            v.state == State::right || v.state == State::skipped || (may_stay_open && v.state == State::inconclusive);
    }
}

/// Another arm on a program's own BRDF: each draw costs a question, and a variance to 3 % ranks well enough.
TestSettings settings_of_baseline(const Trial& trial, TestSettings settings) {
    if (trial.subject->limited()) settings.draws = std::min<std::uint64_t>(settings.draws, 4096);
    return settings;
}

/// f goes on under the surface and was not followed there.
void limit_to_upper_half(const TrialContext& work, const VerdictKind& kind, Verdict& v) {
    if (!work.below().transmits || work.whole() || v.state != State::right || !kind.of_all_light) return;
    v.state = State::inconclusive;
    v.settle = "An f that returns 0 under the surface, or a sampler that draws there.";
    v.say = "f transmits, or does not return 0 under the surface; this is of the upper half only. " + v.say;
}

/// A test failed beyond chance, and questions ran out before fresh draws could confirm it.
void leave_unconfirmed_open(const TrialContext& work, Verdict& v) {
    if (v.state != State::right || !(work.unconfirmed() < 1)) return;
    v.state = State::inconclusive;
    v.evidence["p_unconfirmed"] = work.unconfirmed();
    v.settle = work.settings.full ? "This w_o alone (--wo), with more questions."
                                  : "--full, or this w_o alone (--wo), with more questions.";
    v.say = fmt::format("A test failed with p = {:.2g}, and too few questions were left to confirm it on fresh draws. ",
                work.unconfirmed()) +
        v.say;
}

/// One verdict with the time that it took.
void judge_next(TrialContext& work, Outcome& out, const VerdictKind& kind, const ProgressMonitor& monitor) {
    monitor.check();
    const Stopwatch start;
    work.begin_verdict();
    Verdict v = kind.judge(work);
    limit_to_upper_half(work, kind, v);
    leave_unconfirmed_open(work, v);
    v.seconds = start.seconds();
    out.verdicts.push_back(std::move(v));
}

void judge_in_order(TrialContext& work, std::size_t index, Outcome& out, const ProgressMonitor& monitor) {
    judge_next(work, out, *verdict_kinds[0], monitor);
    if (out.verdicts[0].state == State::wrong && !out.verdicts[0].evidence.contains("usable"))
        return skip_rest(work.trial, out, "The sampler is not valid here.");
    work.measure_density();
    for (const VerdictKind* kind : std::span(verdict_kinds).subspan(1))
        if (kind->judge) judge_next(work, out, *kind, monitor);
    diagnose(work, out.verdicts);
    out.contrasted = contrasted(work);
    if (work.subject.has_f() && work.weighs()) out.efficiency = measure_efficiency(work, index);
}

}  // namespace

namespace {

using Compared = std::vector<std::vector<Verdict>>;  // by verdict, none of those that are of one trial; by trial

/// A program that broke off while it was asked for an arm to rank against: said where it is ranked, at the same w_o.
void blame_baselines(std::span<const Trial> trials, std::span<const Outcome> outcomes, Compared& compared) {
    std::size_t judged = 0;
    for (std::size_t i = 0; i < trials.size(); ++i) {
        const std::optional<Cut>& cut = outcomes[i].cut;
        if (!trials[i].baseline) judged = i;
        else if (cut && cut->state == State::error && !cut->evidence.empty())
            for (std::vector<Verdict>& of_kind : compared)
                if (!of_kind.empty()) of_kind[judged].state = State::error, of_kind[judged].say = cut->first;
    }
}

Verdict missing(const Trial& trial, std::string_view name, const Cut& cut, bool first) {
    Verdict v = skipped(trial, name, first ? cut.first : cut.rest);
    v.state = cut.state;
    if (v.state == State::inconclusive) v.settle = "More time (--patience), or a program that answers faster.";
    if (first) v.evidence = cut.evidence;
    return v;
}

/// Every verdict of the trial at `index`, in the order of the list. Where it ended early, those that are missing say
/// why, and what there was no time for is noted.
void complete(const Trial& trial, Outcome& out, Compared& compared, std::size_t index, Judgement& j) {
    std::vector<Verdict> given = std::move(out.verdicts);
    LeftOut left{trial.arm, trial.text(), {}, out.cut ? out.cut->first : ""};
    out.verdicts.clear();
    auto next = given.begin();
    for (std::size_t k = 0; k < verdict_kinds.size(); ++k) {
        if (verdict_kinds[k]->judge && next != given.end()) {
            out.verdicts.push_back(std::move(*next++));
        } else if (!out.cut) {
            out.verdicts.push_back(std::move(compared[k][index]));
        } else {
            out.verdicts.push_back(missing(trial, verdict_names[k], *out.cut, left.verdicts.empty()));
            left.verdicts.emplace_back(verdict_names[k]);
        }
        expect(trial, *verdict_kinds[k], out.verdicts.back());
    }
    if (out.cut && out.cut->state != State::error) j.left_out.push_back(std::move(left));
}

}  // namespace

Cut cut_by(const SubjectFault& fault) {
    const auto nothing = nlohmann::ordered_json::object();
    if (dynamic_cast<const SubjectTooSlow*>(&fault)) return {State::inconclusive, fault.what(), fault.what(), nothing};
    const std::string rest = "It could not be asked: the sampler broke off before.";
    if (dynamic_cast<const SubjectGone*>(&fault)) return {State::error, rest, rest, nothing};
    return {
        State::error, fmt::format("The sampler broke off: {}.", fault.what()), rest, {{"first_fault", fault.what()}}};
}

Outcome judge_one(const Trial& trial, std::size_t index, const TestSettings& settings, TestCounts& test_counts,
    ProgressMonitor& monitor) {
    Outcome out;
    Trial kept = trial;
    if (trial.subject->limited()) kept.subject = asked_once(trial.subject);
    try {
        if (trial.baseline) {
            out.efficiency = measure_efficiency(TrialContext(kept, settings_of_baseline(trial, settings), test_counts,
                                                    static_cast<std::uint32_t>(index)),
                index);
            return out;
        }
        TrialContext work(kept, settings, test_counts, static_cast<std::uint32_t>(index));
        judge_in_order(work, index, out, monitor);
        out.maps = std::move(work.maps);
        out.pictures = std::move(work.pictures);
    } catch (const SubjectFault& fault) { out.cut = cut_by(fault); }
    return out;
}

std::uint64_t count_tests(std::span<const Trial> trials) {
    std::uint64_t tests = 0;
    for (const Trial& t : trials)
        for (const VerdictKind* kind : verdict_kinds)
            if (!t.baseline && kind->tests) tests += kind->tests(t);
    return tests;
}

namespace {

std::vector<Outcome> judge_all(
    std::span<const Trial> trials, const TestSettings& settings, TestCounts& test_counts, ProgressMonitor& monitor) {
    if (std::any_of(trials.begin(), trials.end(), [](const Trial& t) { return t.subject->serial(); }))
        return judge_in_turn(trials, settings, test_counts, monitor);
    const auto count = std::ranges::count_if(trials, [](const Trial& t) { return !t.baseline; });
    TestSettings shared = settings;
    shared.questions = even_share(settings, static_cast<std::size_t>(count));
    std::vector<Outcome> outcomes(trials.size());
    parallel_for(std::size_t{0}, trials.size(), [&](std::size_t i) {
        monitor.check();
        outcomes[i] = judge_one(trials[i], i, shared, test_counts, monitor);
        monitor.advance(1);
    });
    return outcomes;
}

/// Trials against one another; the call does nothing else while it takes times.
Compared compare(std::span<const Trial> trials, std::span<const Outcome> outcomes, const TestSettings& settings,
    const ProgressMonitor& monitor) {
    std::vector<Efficiency> efficiencies;
    for (const Outcome& o : outcomes)
        if (o.efficiency) efficiencies.push_back(*o.efficiency);
    measure_costs(trials, settings, efficiencies, monitor);
    Compared out(verdict_kinds.size());
    for (std::size_t k = 0; k < verdict_kinds.size(); ++k)
        if (verdict_kinds[k]->compare) out[k] = verdict_kinds[k]->compare(trials, efficiencies);
    blame_baselines(trials, outcomes, out);
    return out;
}

}  // namespace

Judgement judge(std::span<const Trial> trials, const TestSettings& given, ProgressMonitor& monitor) {
    TestSettings settings = given;
    settings.share(count_tests(trials) + pooled_tests(trials));
    TestCounts test_counts;
    monitor.begin("verdicts", static_cast<double>(trials.size()));
    std::vector<Outcome> outcomes = judge_all(trials, settings, test_counts, monitor);
    judge_pooled(trials, outcomes, settings, test_counts, monitor);
    Judgement out;
    out.alpha = settings.alpha;
    out.tests = test_counts.tests;
    out.screened = test_counts.screened;
    out.confirmed = test_counts.confirmed;
    Compared compared = compare(trials, outcomes, settings, monitor);
    for (std::size_t i = 0; i < trials.size(); ++i) {
        if (trials[i].baseline) continue;
        complete(trials[i], outcomes[i], compared, i, out);
        out.questions = std::max(out.questions, trials[i].subject->spending().answers);
        const auto append = [](auto& to, auto& from) { std::ranges::move(from, std::back_inserter(to)); };
        append(out.verdicts, outcomes[i].verdicts);
        append(out.maps, outcomes[i].maps);
        append(out.weights, outcomes[i].pictures);
    }
    settle(out);
    return out;
}

}  // namespace crescent::inline verdicts
