// At each w_o: unusable draws are left out, one tree is grown for both samplers, the first stage looks at the draws
// twice, and each difference that it finds is tested again with fresh draws of both. A and B draw from different
// streams.
#include "check/against.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numeric>
#include <tuple>

#include "base/parallel.h"
#include "check/against_draws.h"
#include "check/against_f.h"
#include "check/check.h"
#include "check/constants.h"
#include "check/decide/sizes.h"
#include "check/report/places.h"
#include "check/report/print.h"
#include "check/sources/check_case.h"
#include "check/sources/decorators.h"
#include "check/verdicts/statistics.h"
#include "output/format.h"

namespace crescent::check {

namespace {

constexpr std::array compared_by = {"same_distribution", "same_f", "variance"};
constexpr std::uint32_t streams_of_b = 1u << 15;  // B draws from streams that A never uses

/// The settings of the comparison at one w_o.
struct AgainstPlan {
    CheckBudget budget, single_budget;  // of both samplers together; of each alone
    Levels levels;
    std::uint32_t seed = 1;
    bool expect_same = false;
};

AgainstPlan plan_of(const TestSettings& settings, bool is_limited, bool expect_same, std::size_t cases) {
    AgainstPlan out;
    // The budget includes a check of each sampler alone, with one look. A sampler that fails that check is not ranked.
    TestSettings shared = settings;
    if (is_limited) shared.questions /= 2;
    out.budget = budget_of(shared, is_limited, cases);
    out.single_budget = CheckBudget::limited();
    if (is_limited && !settings.full) out.single_budget.looks = 1;
    out.seed = settings.seed;
    out.expect_same = expect_same;
    constexpr double families = 3 * static_cast<double>(Family::families);
    out.levels = levels_of(settings.alpha, static_cast<double>(cases) * families);
    return out;
}

class Comparison {
public:
    Comparison(const Side& side_a, const Side& side_b, const AgainstPlan& plan)
        : plan_(plan),
          a_{side_a.check_case, *side_b.check_case.adapter, key_of(side_a)},
          b_{side_b.check_case, *side_a.check_case.adapter, key_of(side_b)} {}

    std::vector<Verdict> run() {
        std::vector<Verdict> out;
        for (const char* name : compared_by) {
            Verdict v;
            v.arm = a_.check_case.arm + " against " + b_.check_case.arm;
            v.check_case = a_.check_case.text();
            v.name = name;
            out.push_back(std::move(v));
        }
        common_.emplace(common_plan(a_, b_, plan_.budget));
        find_differences();
        if (unusable(draws_a_) + unusable(draws_b_) > 0) {
            for (Verdict& v : out) note_unusable(v);
            return out;
        }
        note_distribution(out[0]);
        const CheckAt check_a = check_alone(a_), check_b = check_alone(b_);
        const AgainstCase c{.a = a_,
            .b = b_,
            .common = *common_,
            .draws_a = draws_a_,
            .draws_b = draws_b_,
            .check_a = check_a,
            .check_b = check_b,
            .f_draws = plan_.budget.f_draws(),
            .levels = plan_.levels,
            .expect_same = plan_.expect_same};
        compare_f(c, out[1]);
        compare_variances(c, out[1], out[2]);
        return out;
    }

private:
    const AgainstPlan& plan_;
    AgainstSide a_, b_;
    std::optional<CommonPlan> common_;
    SamplerDraws draws_a_, draws_b_;
    std::map<Family, Least> least_answers_;
    std::vector<Finding> findings_;  // significant at both stages

    StreamKey key_of(const Side& side) const {
        StreamKey key;
        key.seed = plan_.seed;
        key.place = static_cast<std::uint16_t>(side.stream);
        return key;
    }

    CheckAt check_alone(const AgainstSide& side) const {
        return check_sampler_at(*side.check_case.adapter, 0, side.check_case.wo,
            {side.check_case.light, side.key.place, plan_.levels}, plan_.single_budget, plan_.seed);
    }

    AgainstEvidence evidence() const { return {a_, *common_, draws_a_, draws_b_}; }

    void find_differences() {
        for (int look_index = 0; look_index < plan_.budget.looks && findings_.empty(); ++look_index) {
            const Look target = plan_.budget.look(look_index);
            draw_on(a_, *common_, target, plan_.budget.f_draws(), draws_a_);
            draw_on(b_, *common_, target, plan_.budget.f_draws(), draws_b_);
            const AgainstEvidence first = evidence();
            least_answers_ = least_by_family<Answer>(first.tests());
            const double level = level_at(plan_.levels, look_index, plan_.budget.looks);
            const std::vector<Least> suspects =
                suspects_of(first.tests(), least_answers_, level, draws_a_.total.independent);
            if (!suspects.empty()) confirm(suspects, target, look_index);
        }
    }

    void confirm(const std::vector<Least>& suspects, const Look& target, int look_index) {
        const Look largest_look = plan_.budget.look(plan_.budget.looks - 1).divided_by(4);
        const Look retest_target = {0, std::max(target.independent, largest_look.independent),
            std::max(target.scrambled, largest_look.scrambled)};
        AgainstSide a = a_, b = b_;
        a.key.stage = b.key.stage = static_cast<std::uint8_t>(2 + look_index);
        SamplerDraws draws_a, draws_b;
        draw_on(a, *common_, retest_target, 0, draws_a);
        draw_on(b, *common_, retest_target, 0, draws_b);
        const AgainstEvidence second(a, *common_, draws_a, draws_b);
        for (const Least& suspect : suspects) {
            const Answer answer = retest(second.tests(), suspect.answer);
            if (answer.p < plan_.levels.second) findings_.push_back({suspect.answer, answer, suspect.members});
        }
    }

    static double unusable(const SamplerDraws& draws) { return static_cast<double>(draws.total.checks.unusable); }

    void note_unusable(Verdict& v) const {
        const bool is_a = unusable(draws_a_) > 0;
        v.state = State::inconclusive;
        v.sentences = {{"unusable draws",
            fmt::format("{:g} draws of {} cannot be used: {} is not valid here.", unusable(is_a ? draws_a_ : draws_b_),
                is_a ? "A" : "B", is_a ? "A" : "B")}};
        v.next_step = "A valid sampler; `crescent check` of it alone shows more.";
    }

    Traits traits() const { return a_.check_case.adapter->traits(); }

    /// Where the shares of the draws differ most, or what else the clearest finding says.
    std::string clearest_difference() const {
        if (const auto place = largest_difference(common_->plan, shares_of_draws(draws_b_.total), draws_a_.total))
            return fmt::format("Of the draws of A {} are {}, of those of B {}.",
                share_text(place->drawn_share, place->drawn_error), region_text(place->rect, traits()),
                share_text(place->claimed_share, place->claimed_error));
        const Finding& clearest = *std::ranges::min_element(
            findings_, {}, [](const Finding& f) { return std::fabs(f.second.sd / f.second.difference); });
        return sentence_of(clearest.second);
    }

    std::string sentence_of(const Answer& a) const {
        // The right side is the mean of both; replicates are compared with each other.
        const bool uses_sets =
            a.family == Family::mass_sets || a.family == Family::slope_sets || a.family == Family::centre_sets;
        const double pooled = draws_a_.total.independent + draws_b_.total.independent;
        const double per_visible = uses_sets ? 1 : pooled / draws_b_.total.independent;
        const double difference = a.difference * per_visible, half = half_width_95 * a.sd * per_visible;
        const double h = common_->plan.largest_h();
        switch (a.family) {
            case Family::mass:
            case Family::mass_sets:
                return fmt::format(
                    "A draws a direction at {:+.3g} +- {:.1g} more of its samples than B.", difference, half);
            case Family::delta_share:
                return fmt::format(
                    "The delta part towards {} takes {:+.3g} +- {:.1g} more of the samples of A than of B.",
                    direction_text(common_->delta_directions[static_cast<std::size_t>(a.member)]), difference, half);
            case Family::slope:
            case Family::slope_sets:
                return fmt::format(
                    "A is {} concentrated than B: the mean logarithm of their density differs by {:.3g} +- {:.1g}.",
                    difference > 0 ? "more" : "less", std::fabs(difference) / h, half / h);
            case Family::centre:
            case Family::centre_sets:
                if (traits().domain) return "The means of their draws differ.";
                return fmt::format("The mean direction of A is off that of B in {} by {:+.3g} +- {:.1g}.",
                    "xyz"[a.member], difference / h, half / h);
            case Family::node:
            case Family::node_sets: {
                const TreeNode& node = common_->plan.tree.nodes()[static_cast<std::size_t>(a.member)];
                return fmt::format("Draws of A and B divide differently {}.", region_text(node.rect, traits()));
            }
            case Family::band:
                return fmt::format(
                    "A has another share of its draws than B {}.", region_text(rect_of_band(a.member), traits()));
            default: return "Their draws differ in many small places.";
        }
    }

    void note_distribution(Verdict& v) const {
        const bool has_difference = !findings_.empty();
        v.same = !has_difference;
        v.evidence["same"] = !has_difference;
        const Observations &a = draws_a_.total, &b = draws_b_.total;
        v.evidence["draws"] = {a.independent + a.scrambled, b.independent + b.scrambled};
        for (const auto& [family, entry] : least_answers_) v.evidence["p"][std::string(info(family).name)] = entry.p();
        for (const Finding& f : findings_)
            v.evidence["tests"][std::string(info(f.first.family).name)] = {{"difference", f.second.difference},
                {"sd", f.second.sd}, {"p_first", f.first.p}, {"p_again", f.second.p}};
        v.state = has_difference && plan_.expect_same ? State::wrong : State::right;
        if (has_difference) {
            v.sentences = {{"different distributions", "They draw from different distributions."},
                {"clearest difference", clearest_difference()}};
            return;
        }
        const AgainstEvidence pooled_evidence = evidence();
        const DifferenceSizes sizes =
            sizes_between(pooled_evidence.evidence(), plan_.levels.first, common_->directions);
        v.sentences = {{"no difference", "No difference between their distributions was found."}};
        if (!sizes.part) return;
        v.evidence["would_have_found"]["part"] = *sizes.part;
        const bool has_distance = sizes.distance && !traits().domain;
        if (has_distance) v.evidence["would_have_found"]["distance"] = *sizes.distance;
        v.sentences.push_back({"detectable",
            fmt::format("A part of {:.2g} of the draws that one of them lacks would have been found{}.", *sizes.part,
                has_distance ? fmt::format(", and mean directions {:.2g} apart", *sizes.distance) : "")});
    }
};

/// Indices of the cases, grouped by w_o.
std::vector<std::size_t> by_direction(std::span<const CheckCase> check_cases) {
    std::vector<std::size_t> order(check_cases.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
        const CheckCase &x = check_cases[i], &y = check_cases[k];
        return std::tuple(x.theta_deg, x.azimuth_deg, i) < std::tuple(y.theta_deg, y.azimuth_deg, k);
    });
    return order;
}

/// The three verdicts at a w_o at which a sampler failed to answer.
std::vector<Verdict> failed_verdicts(const CheckCase& a, const CheckCase& b, const SamplerError& fault) {
    const bool is_slow = dynamic_cast<const SamplerTimeout*>(&fault);
    std::vector<Verdict> out;
    for (const char* name : compared_by) {
        Verdict v;
        v.arm = a.arm + " against " + b.arm;
        v.check_case = a.text();
        v.name = name;
        v.state = is_slow ? State::inconclusive : State::error;
        v.sentences = {{is_slow ? "too slow" : "failure",
            is_slow ? std::string(fault.what())
                : dynamic_cast<const SamplerExited*>(&fault)
                ? fmt::format("It could not be evaluated: {}.", fault.what())
                : fmt::format("The sampler failed: {}.", fault.what())}};
        if (is_slow) v.next.kind = NextStep::Kind::more_time;
        out.push_back(std::move(v));
    }
    return out;
}

/// The cases with adapters that name the side in each error. A sampler keeps one adapter for all of its cases.
std::vector<CheckCase> named_cases(std::span<const CheckCase> check_cases, const std::string& side) {
    std::vector<CheckCase> out(check_cases.begin(), check_cases.end());
    std::map<std::shared_ptr<const SamplerAdapter>, std::shared_ptr<const SamplerAdapter>> named_adapters;
    for (CheckCase& t : out) {
        std::shared_ptr<const SamplerAdapter>& adapter = named_adapters[t.adapter];
        if (!adapter) adapter = named_side(t.adapter, side);
        t.adapter = adapter;
    }
    return out;
}

/// The worst state of the verdicts.
State worst_state(const std::vector<Verdict>& verdicts) {
    for (State s : {State::wrong, State::error, State::inconclusive})
        if (std::ranges::any_of(verdicts, [s](const Verdict& v) { return v.state == s; })) return s;
    return State::right;
}

}  // namespace

CheckResult compare_samplers(std::span<const CheckCase> a, std::span<const CheckCase> b, const TestSettings& settings,
    bool expect_same, ProgressMonitor& monitor) {
    monitor.begin("two samplers", static_cast<double>(a.size()));
    std::vector<std::vector<Verdict>> verdicts(a.size());
    const std::vector<CheckCase> cases_a = named_cases(a, "A"), cases_b = named_cases(b, "B");
    const auto either = [&](auto predicate) {
        return std::ranges::any_of(a, predicate) || std::ranges::any_of(b, predicate);
    };
    const bool is_serial = either([](const CheckCase& t) { return t.adapter->serial(); });
    const bool is_limited = either([](const CheckCase& t) { return t.adapter->limited(); });
    const AgainstPlan plan = plan_of(settings, is_limited, expect_same, a.size());
    PerDirectionCache cache_a, cache_b;  // used by one thread if either sampler is serial
    const auto compare = [&](std::size_t i) {
        monitor.check();
        try {
            const auto stream = static_cast<std::uint32_t>(i);
            const Side side_a = cache_a.of(cases_a[i], stream), side_b = cache_b.of(cases_b[i], stream + streams_of_b);
            verdicts[i] = Comparison(side_a, side_b, plan).run();
        } catch (const SamplerError& fault) { verdicts[i] = failed_verdicts(a[i], b[i], fault); }
        monitor.advance(1);
    };
    if (is_serial)
        for (std::size_t i : by_direction(a)) compare(i);
    else parallel_for(std::size_t{0}, a.size(), compare);
    CheckResult out;
    out.alpha = settings.alpha;
    for (std::size_t i = 0; i < a.size(); ++i) {
        out.questions = std::max(out.questions,
            a[i].adapter->spending().answers + (a[i].adapter == b[i].adapter ? 0 : b[i].adapter->spending().answers));
        for (const CheckCase* side : {&a[i], &b[i]}) add_device(side->arm, *side->adapter, out.devices);
        for (Verdict& v : verdicts[i]) out.verdicts.push_back(std::move(v));
    }
    out.state = worst_state(out.verdicts);
    out.as_expected = out.state == State::right;
    return out;
}

std::string against_text(const CheckResult& j) {
    std::string out, last;
    for (const Verdict& v : j.verdicts) {
        if (v.check_case != last) out += fmt::format("{}{} [{}]\n", out.empty() ? "" : "\n", v.arm, v.check_case);
        last = v.check_case;
        out += fmt::format("  {:<18} {:<13} {}{}\n", v.name, word(v.state), v.message(),
            next_step_text(v).empty() ? "" : " Next step: " + next_step_text(v));
    }
    return out +
        fmt::format(
            "\n{}{}\n", word(j.state), j.questions > 0 ? fmt::format("; {} questions were answered", j.questions) : "");
}

}  // namespace crescent::check
