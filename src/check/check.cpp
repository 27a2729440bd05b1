// Combines the outcomes of the engine into one result: verdicts in order, expected states, and skipped w_o.
#include "check/check.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

#include "check/constants.h"
#include "check/decide/check_sampler.h"
#include "check/decide/efficiency.h"
#include "check/decide/tail.h"
#include "check/explain/causes.h"
#include "check/report/pictures.h"
#include "check/report/verdicts.h"
#include "check/sources/check_case.h"
#include "check/sources/decorators.h"
#include "check/verdict.h"

namespace crescent {

// ---- The names of states, and the state of all verdicts of a call: wrong before error, error before inconclusive.

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

std::string text_of(const Sentences& sentences) {
    std::string out;
    for (const Sentence& sentence : sentences) out += (out.empty() ? "" : " ") + sentence.text;
    return out;
}

void note_first_failure(const std::string& what, Verdict& v) {
    v.first_failure = true;
    v.evidence["first_fault"] = what;
}

void set_state(CheckResult& j) {
    bool is_wrong = !j.unmet.empty(), has_error = false, has_doubt = false;
    j.as_expected = j.unmet.empty();
    for (const Verdict& v : j.verdicts) {
        if (v.waived) continue;
        is_wrong = is_wrong || v.state == State::wrong;
        has_error = has_error || v.state == State::error;
        has_doubt = has_doubt || v.state == State::inconclusive;
        j.as_expected = j.as_expected && v.expected;
    }
    j.state = is_wrong ? State::wrong : has_error ? State::error : has_doubt ? State::inconclusive : State::right;
}

namespace {

using check::CheckAt;
using check::CheckBudget;
using check::CheckOutcome;
using check::Cut;

/// Verdicts by case, in the order of the verdict list.
using VerdictsByCase = std::vector<std::vector<Verdict>>;

/// A heavy tail or an equal rank does not make a sampler wrong.
bool may_stay_open(const Verdict& v) {
    return v.name == "tail" || v.name == "mean" || v.name == "efficiency" || v.unmet_tail;
}

/// Sets whether the state is the expected one, for a right sampler or for a built-in arm.
void expect(const CheckCase& check_case, bool reaches_all, Verdict& v) {
    const bool is_infinite = check_case.theory.tail_k && *check_case.theory.tail_k >= check::heavy_index;
    if (check_case.theory.wrong && *check_case.theory.wrong == v.name) {
        v.expected = v.state == State::wrong;
        v.why_expected = check_case.theory.why;
    } else if (is_infinite && (v.name == "tail" || (v.state == State::inconclusive && may_stay_open(v)))) {
        // Where p is 0, the weights do not include the light that causes the tail.
        v.expected = v.state == State::inconclusive || !reaches_all;
        v.why_expected = check_case.theory.why;
    } else if (!check_case.theory.underflows.empty() && v.name == "support" && v.state == State::wrong) {
        v.expected = true;
        v.why_expected = check_case.theory.underflows;
    } else {
        v.expected = v.state == State::right || v.state == State::skipped ||
            (v.state == State::inconclusive && may_stay_open(v));
    }
}

/// Messages of the verdicts of a case that ended early: of the first verdict, and of the others.
struct AbortText {
    State state = State::error;
    const char* what = "";  // states the first text
    std::string first, remainder;
};

AbortText abort_text(const Cut& cut, const CheckCase& check_case, const TestSettings& settings) {
    const std::string remainder = "Not evaluated: the sampler failed before.";
    switch (cut.why) {
        case Cut::Why::fault:
            return {State::error, "failure", fmt::format("The sampler failed: {}.", cut.what), remainder};
        case Cut::Why::exited: return {State::error, "not evaluated", remainder, remainder};
        case Cut::Why::too_slow: break;
    }
    const double program_seconds = check_case.adapter->spending().allowed;
    const std::string message = program_seconds > 0
        ? fmt::format("Not examined: {:g} s are not enough for this program at every w_o.", program_seconds)
        : fmt::format("Not examined: {:g} s (TestSettings::seconds) are not enough for this sampler at every w_o.",
              settings.seconds);
    return {settings.accept_few ? State::skipped : State::inconclusive, "not evaluated", message, message};
}

/// Sets all verdicts of a case that ended early, except `valid` if the first draws were examined. Records what was
/// skipped.
void report_cut(const CheckCase& check_case, const Cut& cut, const TestSettings& settings,
    std::vector<Verdict>& verdicts, CheckResult& j) {
    const AbortText text = abort_text(cut, check_case, settings);
    SkippedCase skipped{.arm = check_case.arm, .check_case = check_case.text(), .verdicts = {}, .why = text.first};
    for (Verdict& v : verdicts) {
        if (cut.first_draws && v.name == verdict_names[0]) continue;
        const bool is_first = skipped.verdicts.empty();
        v.state = text.state;
        v.sentences = {is_first ? Sentence{text.what, text.first} : Sentence{"not evaluated", text.remainder}};
        v.evidence = nlohmann::ordered_json::object();
        if (is_first && cut.why == Cut::Why::fault) note_first_failure(cut.what, v);
        if (v.state == State::inconclusive) v.next.kind = NextStep::Kind::more_time;
        skipped.verdicts.push_back(v.name);
    }
    if (text.state != State::error) j.left_out.push_back(std::move(skipped));
}

/// Reports at the first w_o that the tests of the whole sampler ended early.
void report_whole_cut(const Cut& cut, const CheckCase& check_case, const TestSettings& settings, Verdict& valid) {
    if (valid.state != State::right) return;
    const AbortText text = abort_text(cut, check_case, settings);
    valid.state = text.state;
    valid.sentences = {{text.what, text.first}};
    if (cut.why == Cut::Why::fault) note_first_failure(cut.what, valid);
}

/// Upper bounds of the evaluations that no estimate includes. At each w_o: f at the draws of two baselines, seven timed
/// turns of 512 samples, the first draws, and a rose. For the whole call: corners and reciprocity.
constexpr std::size_t evaluations_extra = 16000, evaluations_for_all = 8000;

/// The cases with adapters limited to the remaining evaluations of a program, less those reserved for later steps.
std::vector<CheckCase> with_remaining_limits(std::span<const CheckCase> check_cases, const TestSettings& settings) {
    std::vector<CheckCase> out(check_cases.begin(), check_cases.end());
    const auto w_o =
        static_cast<std::size_t>(std::ranges::count_if(out, [](const CheckCase& t) { return !t.baseline; }));
    const std::size_t total = std::min(settings.questions * w_o, settings.questions_in_all) + settings.further_in_all;
    for (CheckCase& t : out)
        if (t.adapter->limited())
            t.adapter = limited_in_number(t.adapter, total - std::min(total, w_o * evaluations_extra));
    return out;
}

/// The cause of a wrong verdict, as far as the remaining evaluations allow.
std::optional<check::Cause> cause_of(
    std::span<const CheckCase> check_cases, const CheckOutcome& outcome, const TestSettings& settings) {
    if (!outcome.wrong()) return {};
    const std::vector<CheckCase> capped_cases = with_remaining_limits(check_cases, settings);
    try {
        return check::cause_of(capped_cases, outcome);
    } catch (const SamplerError&) { return {}; }  // the limit was reached or the program ended
}

/// Assigns the verdicts of one sampler to its cases.
void distribute(std::span<const CheckCase> check_cases, const CheckOutcome& outcome, const TestSettings& settings,
    VerdictsByCase& to, CheckResult& j) {
    const std::optional<check::Cause> cause = cause_of(check_cases, outcome, settings);
    std::vector<Verdict> verdicts = check::verdicts_of(check_cases, outcome, cause);
    auto next = verdicts.begin();
    for (std::size_t k = 0; k < outcome.check_cases.size(); ++k) {
        const std::size_t i = outcome.check_cases[k];
        std::vector<Verdict>& case_verdicts = to[i];
        std::move(next, next + verdict_names.size(), std::back_inserter(case_verdicts));
        next += verdict_names.size();
        if (outcome.cut[k]) report_cut(check_cases[i], *outcome.cut[k], settings, case_verdicts, j);
    }
    if (outcome.whole_cut)
        report_whole_cut(
            *outcome.whole_cut, check_cases[outcome.check_cases[0]], settings, to[outcome.check_cases[0]][0]);
}

/// A result without a single examined w_o is an error, also with accept_few.
void require_examined(std::span<const CheckOutcome> outcomes, CheckResult& j) {
    const auto is_examined = [](const CheckOutcome& o) {
        return std::ranges::any_of(o.cut, [](const std::optional<Cut>& cut) { return !cut; });
    };
    if (std::ranges::any_of(outcomes, is_examined)) return;
    for (const SkippedCase& skipped_case : j.left_out)
        for (Verdict& v : j.verdicts)
            if (v.check_case == skipped_case.check_case && v.arm == skipped_case.arm && v.state == State::skipped) {
                v.state = State::inconclusive;
                v.next.kind = NextStep::Kind::more_time;
            }
}

void count(const CheckOutcome& outcome, CheckResult& j) {
    for (const auto& techniques : outcome.checks)
        for (const CheckAt& c : techniques) {
            j.tests += c.answers.size();
            j.screened += c.findings.size() + c.suspected.size();
            j.confirmed += c.findings.size();
        }
    j.evaluations += outcome.evaluations;
}

/// Ranks the cases against each other. No other thread runs during the timing. Cases that ended early keep their state.
void rank(std::span<const CheckCase> check_cases, std::span<const CheckOutcome> outcomes,
    const check::CheckSettings& settings, const ProgressMonitor& monitor, VerdictsByCase& verdicts) {
    std::vector<check::Efficiency> variances = check::variances_of(check_cases, outcomes, settings, monitor);
    check::measure_costs(check_cases, settings.seed, variances, monitor);
    std::vector<Verdict> efficiency_verdicts = check::test_efficiency(check_cases, variances);
    for (const CheckOutcome& o : outcomes)
        for (std::size_t k = 0; k < o.check_cases.size(); ++k) {
            if (o.cut[k]) continue;
            const std::size_t i = o.check_cases[k];
            const auto v = std::ranges::find(verdicts[i], "efficiency", &Verdict::name);
            if (v == verdicts[i].end()) continue;
            efficiency_verdicts[i].wo = v->wo;
            efficiency_verdicts[i].seconds = v->seconds;
            *v = std::move(efficiency_verdicts[i]);
        }
}

/// Maps and weights by case. They are computed even if no output shows them, so that the queries to a program do not
/// depend on the output.
void draw_pictures(std::span<const CheckCase> check_cases, std::span<const CheckOutcome> outcomes,
    const TestSettings& settings, CheckResult& j) {
    std::vector<std::vector<BinHistogram>> maps(check_cases.size());
    std::vector<std::optional<WeightHistogram>> weights(check_cases.size());
    for (const CheckOutcome& o : outcomes)
        for (std::size_t k = 0; k < o.check_cases.size(); ++k) {
            const std::size_t i = o.check_cases[k];
            if (o.cut[k] || !(settings.pictures || check_cases[i].adapter->limited())) continue;
            for (const CheckAt& c : o.checks[k])
                if (std::optional<BinHistogram> map = check::bin_map(check_cases[i], c))
                    maps[i].push_back(std::move(*map));
            for (const CheckAt& c : o.checks[k])
                if (std::optional<LineHistogram> line = check::line_picture(check_cases[i], c);
                    line && settings.pictures)
                    j.lines.push_back(std::move(*line));
            if (!o.tails[k].has_weights) continue;
            weights[i] = check::weight_picture(check_cases[i], check::weights_of(o.checks[k]), o.tails[k]);
            try {
                if (!check_cases[i].adapter->traits().domain) check::add_rose(check_cases[i], *weights[i]);
            } catch (const SamplerError&) { weights[i]->rose_p.clear(); }  // the program ended
        }
    if (!settings.pictures) return;
    for (std::size_t i = 0; i < check_cases.size(); ++i) {
        std::ranges::move(maps[i], std::back_inserter(j.maps));
        if (weights[i]) j.weights.push_back(std::move(*weights[i]));
    }
}

/// Fewer evaluations do not give a useful verdict, so a call with more than 18 w_o uses more in all.
constexpr std::size_t least_evaluations = 200000;

}  // namespace

CheckBudget budget_of(const TestSettings& settings, bool is_limited, std::size_t w_o) {
    if (settings.budget) return *settings.budget;
    if (is_limited) {
        // One twelfth is reserved for tests of the whole sampler, for baselines and for causes.
        const std::size_t share = settings.questions_in_all / 12 * 11 / std::max<std::size_t>(w_o, 1);
        const std::size_t extra = evaluations_extra + evaluations_for_all / std::max<std::size_t>(w_o, 1);
        return CheckBudget::limited(static_cast<double>(
            std::min(settings.questions - std::min(settings.questions, extra), std::max(share, least_evaluations))));
    }
    return settings.full ? CheckBudget::thorough() : CheckBudget::quick();
}

CheckResult run_checks(std::span<const CheckCase> check_cases, const TestSettings& settings, ProgressMonitor& monitor) {
    const auto case_count =
        static_cast<std::size_t>(std::ranges::count_if(check_cases, [](const CheckCase& t) { return !t.baseline; }));
    check::CheckSettings engine_settings;
    engine_settings.budget = budget_of(settings, false, case_count);
    engine_settings.limited = budget_of(settings, true, case_count);
    engine_settings.further_in_all = settings.budget ? 0 : static_cast<double>(settings.further_in_all);
    engine_settings.seed = settings.seed;
    engine_settings.alpha = settings.alpha;
    engine_settings.keep_evidence = settings.pictures;
    monitor.begin("verdicts", static_cast<double>(case_count));
    CheckResult out;
    out.alpha = settings.alpha;
    const std::vector<CheckOutcome> outcomes = check::check_samplers(check_cases, engine_settings, monitor);
    VerdictsByCase verdicts(check_cases.size());
    std::vector<std::size_t> case_of;
    std::vector<bool> reaches_all(check_cases.size());
    for (const CheckOutcome& outcome : outcomes) {
        distribute(check_cases, outcome, settings, verdicts, out);
        count(outcome, out);
    }
    rank(check_cases, outcomes, engine_settings, monitor, verdicts);
    draw_pictures(check_cases, outcomes, settings, out);
    for (std::size_t i = 0; i < check_cases.size(); ++i) {
        if (check_cases[i].baseline) continue;
        out.questions = std::max(out.questions, check_cases[i].adapter->spending().answers);
        add_device(check_cases[i].arm, *check_cases[i].adapter, out.devices);
        reaches_all[i] = std::ranges::none_of(
            verdicts[i], [](const Verdict& v) { return v.name == "support" && v.state == State::wrong; });
        std::ranges::move(verdicts[i], std::back_inserter(out.verdicts));
        case_of.resize(out.verdicts.size(), i);
    }
    for (Verdict& v : out.verdicts) v.next.thorough = settings.full;
    if (settings.accept_few) require_examined(outcomes, out);
    for (std::size_t v = 0; v < out.verdicts.size(); ++v)
        expect(check_cases[case_of[v]], reaches_all[case_of[v]], out.verdicts[v]);
    set_state(out);
    return out;
}

}  // namespace crescent
