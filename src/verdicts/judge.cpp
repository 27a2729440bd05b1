#include "verdicts/judge.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/parallel.h"
#include "base/stopwatch.h"
#include "verdicts/asked_once.h"
#include "verdicts/diagnosis.h"
#include "verdicts/ordered.h"
#include "verdicts/outcome.h"

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

void skip_rest(const Trial& trial, Outcome& out, const std::string& why) {
    while (out.verdicts.size() + 1 < verdict_names.size())
        out.verdicts.push_back(skipped(trial, verdict_names[out.verdicts.size()], why));
}

void expect(const Trial& trial, Verdict& v) {
    const bool unmet = v.evidence.contains("unmet_share");
    const bool may_doubt = unmet || v.name == "tail" || v.name == "mean" || v.name == "efficiency";
    const bool must_be_wrong = trial.theory.wrong && *trial.theory.wrong == v.name;
    const bool infinite = trial.theory.tail_k && *trial.theory.tail_k >= 0.5;
    if (must_be_wrong) {
        v.expected = v.state == State::wrong;
        v.why_expected = trial.theory.why;
    } else if (infinite && (v.name == "tail" || v.name == "mean")) {
        v.expected = v.state == State::inconclusive;
        v.why_expected = trial.theory.why;
    } else if (!trial.theory.underflows.empty() && v.name == "support" && v.state == State::wrong) {
        v.expected = true;
        v.why_expected = trial.theory.underflows;
    } else {
        v.expected =
            v.state == State::right || v.state == State::skipped || (may_doubt && v.state == State::inconclusive);
    }
}

/// Another arm on a program's own BRDF: each draw costs a question, and a variance to 3 % ranks well enough.
TestSettings for_yardstick(const Trial& trial, TestSettings rigour) {
    if (trial.subject->serial()) rigour.draws = std::min<std::uint64_t>(rigour.draws, 4096);
    return rigour;
}

/// f goes on under the surface and was not followed there.
void own_up_to_one_half(const TrialContext& work, Verdict& v) {
    if (!work.below().transmits || work.whole() || v.state != State::right || (v.name != "physics" && v.name != "mean"))
        return;
    v.state = State::inconclusive;
    v.settle = "An f that returns 0 under the surface, or a sampler that draws there.";
    v.say = "f transmits, or does not return 0 under the surface; this is of the upper half only. " + v.say;
}

/// One verdict with the time that it took.
template <class Judge> void judge_next(TrialContext& work, Outcome& out, const ProgressMonitor& watch, Judge&& judge) {
    watch.check();
    const Stopwatch start;
    Verdict v = judge(work);
    own_up_to_one_half(work, v);
    v.seconds = start.seconds();
    out.verdicts.push_back(std::move(v));
}

void judge_in_order(TrialContext& work, std::size_t index, Outcome& out, const ProgressMonitor& watch) {
    judge_next(work, out, watch, judge_valid);
    if (out.verdicts[0].state == State::wrong && !out.verdicts[0].evidence.contains("usable"))
        return skip_rest(work.trial, out, "The sampler is not valid here.");
    work.measure_density();
    for (auto* verdict : {+[](TrialContext& w) { return judge_support(w); },
             +[](TrialContext& w) { return judge_normalised(w); }, +[](TrialContext& w) { return judge_density(w); },
             +[](TrialContext& w) { return judge_identity(w); }, +[](TrialContext& w) { return judge_physics(w); },
             +[](TrialContext& w) { return judge_tail(w); }, +[](TrialContext& w) { return judge_mean(w); }})
        judge_next(work, out, watch, verdict);
    diagnose(work, out.verdicts);
    if (work.subject.has_f() && work.weighs()) out.efficiency = measure_efficiency(work, index);
}

}  // namespace

void settle(Judgement& j) {
    bool wrong = !j.unmet.empty(), error = false, doubt = false;
    j.as_expected = j.unmet.empty();
    for (const Verdict& v : j.verdicts) {
        if (v.waived) continue;
        wrong = wrong || v.state == State::wrong;
        error = error || v.state == State::error;
        doubt = doubt || v.state == State::inconclusive;
        j.as_expected = j.as_expected && v.expected;
    }
    j.state = wrong ? State::wrong : error ? State::error : doubt ? State::inconclusive : State::right;
}

namespace {

/// A program that broke off while it was asked for an arm to rank against: said where it is ranked, at the same w_o.
void blame_yardsticks(std::span<const Trial> trials, std::span<const Outcome> outcomes, std::vector<Verdict>& ranks) {
    std::size_t judged = 0;
    for (std::size_t i = 0; i < trials.size(); ++i) {
        const std::optional<Cut>& cut = outcomes[i].cut;
        if (!trials[i].baseline) judged = i;
        else if (cut && cut->state == State::error && !cut->evidence.empty())
            ranks[judged].state = State::error, ranks[judged].say = cut->first;
    }
}

/// Which verdicts of a trial there was no time for.
void note_left_out(const Trial& trial, const Outcome& out, Judgement& j) {
    if (!out.cut || out.cut->state == State::error) return;
    LeftOut left{trial.arm, trial.text(), {}, out.cut->first};
    for (std::size_t k = out.verdicts.size(); k < verdict_names.size(); ++k)
        left.verdicts.emplace_back(verdict_names[k]);
    j.left_out.push_back(std::move(left));
}

}  // namespace

Cut cut_by(const SubjectFault& fault) {
    if (dynamic_cast<const SubjectTooSlow*>(&fault)) return {State::inconclusive, fault.what(), fault.what(), {}};
    const std::string rest = "It could not be asked: the sampler broke off before.";
    if (dynamic_cast<const SubjectGone*>(&fault)) return {State::error, rest, rest, {}};
    return {
        State::error, fmt::format("The sampler broke off: {}.", fault.what()), rest, {{"first_fault", fault.what()}}};
}

void fill_up(const Trial& trial, Outcome& out) {
    if (!out.cut) return;
    for (bool first = true; out.verdicts.size() < verdict_names.size(); first = false) {
        Verdict v = skipped(trial, verdict_names[out.verdicts.size()], first ? out.cut->first : out.cut->rest);
        v.state = out.cut->state;
        if (v.state == State::inconclusive) v.settle = "More time (--patience), or a program that answers faster.";
        if (first) v.evidence = out.cut->evidence;
        out.verdicts.push_back(std::move(v));
    }
}

Outcome judge_one(
    const Trial& trial, std::size_t index, const TestSettings& rigour, TestCounts& tally, ProgressMonitor& watch) {
    Outcome out;
    Trial kept = trial;
    if (trial.subject->serial()) kept.subject = asked_once(trial.subject);
    try {
        if (trial.baseline) {
            out.efficiency = measure_efficiency(
                TrialContext(kept, for_yardstick(trial, rigour), tally, static_cast<std::uint32_t>(index)), index);
            return out;
        }
        TrialContext work(kept, rigour, tally, static_cast<std::uint32_t>(index));
        judge_in_order(work, index, out, watch);
        out.maps = std::move(work.maps);
        out.pictures = std::move(work.pictures);
    } catch (const SubjectFault& fault) { out.cut = cut_by(fault); }
    return out;
}

std::string_view word(State state) {
    switch (state) {
        case State::right: return "right";
        case State::wrong: return "wrong";
        case State::inconclusive: return "inconclusive";
        case State::skipped: return "skipped";
        case State::error: return "error";
    }
    return "";
}

/// Per technique four p-values of the density and one of the share that draws nothing; then the furnace and the mean.
std::uint64_t count_tests(std::span<const Trial> trials) {
    std::uint64_t tests = 0;
    for (const Trial& t : trials)
        if (!t.baseline)
            tests += 5 * static_cast<std::uint64_t>(t.subject->techniques()) + (t.subject->has_f() ? 2 : 0) +
                (t.subject->traits().delta ? 1 : 0);
    return tests;
}

Judgement judge(std::span<const Trial> trials, const TestSettings& given, ProgressMonitor& watch) {
    TestSettings rigour = given;
    rigour.share(count_tests(trials));
    TestCounts tally;
    watch.begin("verdicts", static_cast<double>(trials.size()));
    const bool serial = std::any_of(trials.begin(), trials.end(), [](const Trial& t) { return t.subject->serial(); });
    std::vector<Outcome> outcomes(trials.size());
    if (serial) {
        outcomes = judge_in_turn(trials, rigour, tally, watch);
    } else {
        parallel_for(std::size_t{0}, trials.size(), [&](std::size_t i) {
            watch.check();
            outcomes[i] = judge_one(trials[i], i, rigour, tally, watch);
            watch.advance(1);
        });
    }
    Judgement out;
    out.alpha = rigour.alpha;
    out.tests = tally.tests;
    out.screened = tally.screened;
    out.confirmed = tally.confirmed;
    std::vector<Efficiency> efficiencies;
    for (const Outcome& o : outcomes)
        if (o.efficiency) efficiencies.push_back(*o.efficiency);
    measure_costs(trials, rigour, efficiencies, watch);  // the call does nothing else by now
    std::vector<Verdict> ranks = judge_efficiency(trials, efficiencies);
    blame_yardsticks(trials, outcomes, ranks);
    for (std::size_t i = 0; i < trials.size(); ++i) {
        if (trials[i].baseline) continue;
        note_left_out(trials[i], outcomes[i], out);
        if (!outcomes[i].cut) outcomes[i].verdicts.push_back(std::move(ranks[i]));
        fill_up(trials[i], outcomes[i]);
        out.questions = std::max(out.questions, trials[i].subject->spending().answers);
        for (Verdict& v : outcomes[i].verdicts) {
            expect(trials[i], v);
            out.verdicts.push_back(std::move(v));
        }
        std::move(outcomes[i].maps.begin(), outcomes[i].maps.end(), std::back_inserter(out.maps));
        std::move(outcomes[i].pictures.begin(), outcomes[i].pictures.end(), std::back_inserter(out.weights));
    }
    settle(out);
    return out;
}

}  // namespace crescent::inline verdicts
