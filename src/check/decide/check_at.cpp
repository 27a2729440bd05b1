// Stage 1 looks at a part of its draws, then at all of them. A family below its level is tested again on the same tree
// with fresh draws and fresh points: the same member, with the same sign. The streams of the stages differ, so no
// number is used twice.
#include "check/decide/check_at.h"

#include <algorithm>
#include <limits>
#include <map>

#include "base/progress.h"
#include "check/constants.h"
#include "check/decide/delta_directions.h"
#include "check/decide/resolution.h"
#include "check/decide/sizes.h"
#include "check/decide/small_tests.h"
#include "check/decide/two_stages.h"
#include "check/estimate/both_ways.h"
#include "check/estimate/source.h"
#include "check/verdicts/counts.h"
#include "check/verdicts/light.h"
#include "check/verdicts/statistics.h"

namespace crescent::check {

namespace {

/// Both sides of (1) for one stage.
struct Stage {
    Integrals integrals;
    Observations observations;
    Look progress;

    /// The number of evaluations of f: at the points of the first pass and at the first draws, where f may also be
    /// compared with its reference value.
    static double cost_of_f(const Source& source, const Look& target, double draws) {
        if (!source.has_f()) return 0;
        return target.points + draws * (source.declaration.has_true_f ? 2 : 1);
    }
    void extend(Source& source, const Plan& plan, Look target, std::uint32_t f_draws, StreamKey key, int look_index) {
        target.points =
            std::max(target.points, progress.points + 2 * static_cast<std::uint32_t>(plan.tree.leaves().size()));
        target.independent = std::max(target.independent, progress.independent);
        key.purpose = Purpose::points;
        key.part = static_cast<std::uint16_t>(look_index);
        const bool uses_f = progress.points == 0 && f_draws > 0;  // only in the first pass
        integrate(source, plan, target.points - progress.points, uses_f, key, integrals);
        progress = target;
        key.part = 0;
        observe(source, plan, target, f_draws, key, integrals, observations);
    }
    Evidence evidence(const Source& source, const Plan& plan) const {
        return {.source = source, .plan = plan, .integrals = integrals, .observations = observations};
    }
};

VisitAll all_tests(const Evidence& e) {
    return [e](const Visit& visit) {
        test_distribution(e, visit);
        test_light(e, visit);
        test_counts(e, visit);
        test_deltas(e, visit);
    };
}

class Check {
public:
    Check(const SamplerAdapter& adapter, int technique, Vec3d wo, const CaseData& data, const CheckBudget& budget,
        std::uint32_t seed)
        : source_(adapter, technique, wo, data.light), budget_(budget), levels_(data.levels), reserved_(data.reserved) {
        key_.seed = seed;
        key_.place = data.place;
        key_.technique = static_cast<std::uint8_t>(technique);
        out_.wo = wo;
        out_.technique = technique;
        out_.traits = source_.traits;
    }

    CheckAt run() {
        const Stopwatch watch;
        StreamKey noise_key = key_;
        noise_key.purpose = Purpose::pairs;
        out_.scatter = look_for_noise(source_, noise_key);
        source_.estimates = out_.scatter.pdf();
        source_.f_estimates = out_.scatter.f();
        if (!source_.f_estimates) source_.unscaled = both_ways(source_.adapter, key_) != BothWays::not_known;
        out_.plan = std::make_shared<const Plan>(make_plan(source_, budget_, key_));
        out_.small = small_tests(source_, key_);
        for (int look_index = is_of_weights() ? budget_.looks - 1 : 0; look_index < budget_.looks; ++look_index) {
            if (decided_by(look_index)) break;
            if (look_index == 0 && !is_of_weights() && regrown()) look_index = -1;
        }
        for (int k = 0; k < further_looks && goes_on(); ++k) look_further(k);
        finish();
        out_.evaluations = source_.evaluations();
        out_.seconds = watch.seconds();
        return std::move(out_);
    }

private:
    Source source_;
    const CheckBudget& budget_;
    StreamKey key_;
    Levels levels_;
    double reserved_;
    CheckAt out_;
    Stage first_;
    std::map<Family, Least> least_answers_;  // of first_
    double confirmation_cost_ = 0;           // evaluations of second stages
    std::optional<ResolutionEffect> resolution_;

    /// Only the weights of a sampler without density show a fault: those of all draws are used, and all points have f.
    bool is_of_weights() const { return source_.traits.reciprocal_weight; }
    std::uint32_t draws_with_weights() const {
        return is_of_weights() ? std::numeric_limits<std::uint32_t>::max() : budget_.f_draws();
    }
    double level_of(int look_index) const { return level_at(levels_, look_index, budget_.looks); }

    double remaining() const {
        return budget_.evaluations + confirmation_cost_ - static_cast<double>(source_.evaluations());
    }

    /// The size of this look: a part of all that stage 1 may still evaluate, including what it has evaluated.
    Look next(int look_index) const {
        const double limit = remaining() - budget_.cost_of_sizes() + first_.progress.cost();
        const std::uint32_t parts = 1u << 3 * (budget_.looks - 1 - look_index);
        Look last = look_of(limit);
        Look begin = last.divided_by(1u << 3 * (budget_.looks - 1));
        begin.points = std::max(begin.points, 2 * static_cast<std::uint32_t>(out_.plan->tree.leaves().size()));
        const double f_cost = Stage::cost_of_f(source_, begin, is_of_weights() ? begin.independent : budget_.f_draws());
        const double f_evaluations = first_.observations.weighted_draws + first_.integrals.light.points;
        last = look_of(limit - std::max(f_cost - f_evaluations, 0.0));
        return last.divided_by(parts);
    }

    bool decided_by(int look_index) { return look_at(next(look_index), look_index, level_of(look_index)); }

    /// The evaluations that stage 1 may have in all.
    double most_of_first_stage() const {
        const double limit = budget_.most_evaluations + confirmation_cost_ - static_cast<double>(source_.evaluations());
        return std::min(limit, evaluations_in_time()) - budget_.cost_of_sizes() + first_.progress.cost();
    }
    /// Half of the evaluations for which a program has time besides its other w_o. A program of 1 M evaluations per
    /// second has time for all.
    double evaluations_in_time() const {
        const QueryUsage usage = source_.adapter.spending();
        if (usage.allowed <= 0) return std::numeric_limits<double>::infinity();
        const double rate = static_cast<double>(usage.answers) / std::max(usage.seconds, 1e-9);
        return std::max((usage.allowed - usage.seconds) * rate - reserved_, 0.0) / 2;
    }
    /// The evaluations of stage 1 that the sizes require, a third more than in proportion to their squares.
    double requirement_of_first_stage() const {
        Sizes sizes = out_.sizes;
        if (out_.is_integral_open()) sizes.integral = error_in_reach(first_.integrals, first_.observations);
        return 4.0 / 3 * first_.progress.cost() * sqr(worst_ratio(sizes) / out_.most_ratio());
    }
    bool goes_on() const {
        if (!out_.inconclusive || out_.wrong() || source_.recorded()) return false;
        const double limit = most_of_first_stage();
        return limit > 1.5 * first_.progress.cost() && requirement_of_first_stage() < out_of_reach * limit;
    }
    void look_further(int k) {
        const double requirement = std::max(requirement_of_first_stage(), 1.5 * first_.progress.cost());
        // The tree was made for fewer points, which resolve less of p.
        if (k == 0 && out_.is_integral_open() && !is_of_weights()) {
            CheckBudget larger_budget = budget_;
            larger_budget.evaluations = most_of_first_stage();
            grow_again(larger_budget, StreamKey::further);
        }
        const double limit = most_of_first_stage();
        const Look target = look_of(k + 1 < further_looks ? std::min(requirement, limit) : limit);
        look_at(target, budget_.looks + k, levels_.first * early_look);
    }

    bool look_at(const Look& target, int look_index, double level) {
        first_.extend(source_, *out_.plan, target, draws_with_weights(), key_, look_index);
        out_.looks = look_index + 1;
        const Evidence e = first_.evidence(source_, *out_.plan);
        note_answers(e);
        const std::vector<Least> suspects =
            suspects_of(all_tests(e), least_answers_, level, e.observations.independent);
        if (!suspects.empty()) confirm(suspects, look_index);
        if (!out_.findings.empty()) return true;
        if (!budget_.stop_when_conclusive && look_index < budget_.looks - 1) return false;
        out_.sizes = sizes(e, level);
        out_.inconclusive = worst_ratio(out_.sizes) > out_.most_ratio();
        return budget_.stop_when_conclusive && !out_.inconclusive;
    }

    /// If p has regions that the tree does not resolve, builds the tree once more from all points and draws so far.
    /// These are then used for nothing else.
    bool regrown() {
        const Estimate& claim = first_.integrals.sums[mass];
        const double threshold = regrow_from * regrow_points / first_.integrals.points;
        const double error = std::sqrt(claim.variance + first_.integrals.unresolved.variance);
        if (key_.stage != 1 || !(error > threshold * std::max(claim.value, 1e-3))) return false;
        if (first_.integrals.heavy.empty() && first_.observations.excess_points.empty()) return false;
        grow_again(budget_, StreamKey::regrown);
        return true;
    }

    void grow_again(const CheckBudget& budget, std::uint8_t stage) {
        std::vector<DensityPoint> hints = first_.integrals.heavy;
        const std::vector<DensityPoint>& points = first_.observations.excess_points;
        hints.insert(hints.end(), points.begin(), points.end());
        key_.stage = stage;
        first_ = {};
        out_.plan = std::make_shared<const Plan>(make_plan(source_, budget, key_, std::move(hints)));
    }

    Sizes sizes(const Evidence& e, double level) {
        const bool has_draws = e.observations.checks.directions > 0 || e.integrals.sums[mass].value > 0;
        if (!has_draws) return {};  // only delta parts or no samples: no density that could hide a fault
        StreamKey key = key_;
        key.purpose = Purpose::pairs;
        return sizes_of(source_, e, level, budget_.size_draws(), key);
    }

    /// Repeats the tests on as many fresh draws and points. After an early look it uses twice as many: a clear fault is
    /// then explained from them, and the verdicts on f come from them too.
    void confirm(const std::vector<Least>& suspects, int look_index) {
        const bool is_early = look_index < budget_.looks - 1;
        const Look target = is_early ? first_.progress.times(2) : first_.progress;
        const bool tests_f = std::ranges::any_of(suspects, [](const Least& b) { return is_of_f(b.answer.family); });
        const double start = static_cast<double>(source_.evaluations());
        Stage second;
        StreamKey key = key_;
        key.stage = static_cast<std::uint8_t>(key_.stage + 1 + look_index);
        second.integrals.light.lost_leaves = first_.integrals.light.lost_leaves;
        second.extend(source_, *out_.plan, target, tests_f || is_early ? draws_with_weights() : 0, key, 0);
        Evidence e = second.evidence(source_, *out_.plan);
        e.fewest_draws *= std::min(1.0, second.observations.independent / first_.observations.independent);
        for (const Least& b : suspects) {
            const Answer answer = retest(all_tests(e), b.answer);
            if (answer.p < levels_.second && !is_of_resolution(answer, second.observations.independent))
                out_.findings.push_back({b.answer, answer, b.members});
            else out_.suspected.push_back(b.answer);
        }
        confirmation_cost_ += static_cast<double>(source_.evaluations()) - start;
        if (!out_.findings.empty() && second.progress.cost() > first_.progress.cost())
            use_second_stage(std::move(second));
    }

    /// Whether the resolution of the random numbers may cause this deviation.
    bool is_of_resolution(const Answer& a, double draws) {
        if (info(a.family).verdict != "density" || a.family == Family::delta_share) return false;
        if (!resolution_) resolution_ = resolution_effect(source_, *out_.plan, key_);
        if (!explains(*resolution_, a, draws)) return false;
        out_.moved_by_resolution = resolution_->share;
        return true;
    }

    void note_answers(const Evidence& e) { least_answers_ = least_by_family<Answer>(all_tests(e)); }

    /// Uses the second stage for the explanation, since it has more draws than the first.
    void use_second_stage(Stage&& second) {
        first_ = std::move(second);
        note_answers(first_.evidence(source_, *out_.plan));
    }

    /// Tests the directions of delta parts, which do not depend on chance.
    void test_delta_directions() {
        const Observations& o = first_.observations;
        if (o.deltas.empty() || o.deltas.scattered()) return;
        StreamKey key = key_;
        key.purpose = Purpose::light;
        key.part = 2;
        const std::vector<DeltaPart>& parts = o.deltas.parts(o.independent);
        std::optional<SmallFault> fault = refraction(source_, parts, key);
        if (!fault) fault = reverse_path(source_, parts, key);
        if (fault) out_.small.push_back(*fault);
    }

    /// Whether no test had anything to test: no draws, and no density.
    bool is_nothing_drawn() const {
        const DrawChecks& c = first_.observations.checks;
        const bool lacks_density = !source_.has_density() || first_.integrals.sums[mass].value == 0;
        return c.draws > 0 && c.nothing == c.draws && lacks_density && source_.invalid().pdf == 0;
    }

    /// Whether the sampler draws at a w_o on either side.
    bool draws_elsewhere() const {
        if (source_.traits.wo == Traits::WoDomain::none || source_.recorded()) return false;
        const std::vector<PrimarySample> u = first_numbers(key_, 64, source_.traits);
        std::vector<Draw> draws(u.size());
        for (double theta : {40.0, 140.0}) {
            if (theta > 90 && source_.traits.wo != Traits::WoDomain::both) continue;
            source_.adapter.sample(source_.technique, tilt(theta, 25), u, draws);
            if (std::ranges::any_of(draws, [](const Draw& d) { return d.pdf > 0 || d.delta > 0; })) return true;
        }
        return false;
    }

    /// Removes what was found from answers that are not numbers, except for `valid`.
    void withhold_verdicts() {
        const auto is_withheld = [&](Family f) { return out_.is_withheld(info(f).verdict); };
        std::erase_if(out_.findings, [&](const Finding& f) { return is_withheld(f.first.family); });
        std::erase_if(out_.small, [&](const SmallFault& f) { return is_withheld(f.family); });
        std::erase_if(out_.answers, [&](const Answer& a) { return is_withheld(a.family); });
    }

    void finish() {
        test_delta_directions();
        out_.invalid = source_.invalid();
        out_.nothing_drawn = is_nothing_drawn();
        out_.draws_elsewhere = out_.nothing_drawn && draws_elsewhere();
        for (const auto& [family, entry] : least_answers_) {
            out_.answers.push_back(entry.answer);
            out_.answers.back().p = entry.p();
        }
        if (out_.wrong()) {
            out_.sizes = {};
            out_.inconclusive = false;
            if (source_.has_density()) out_.sizes.integral = error_of_integral(first_.integrals, first_.observations);
        }
        out_.integrals = std::move(first_.integrals);
        out_.observations = std::move(first_.observations);
        withhold_verdicts();
    }
};

/// The answers on which a verdict is built.
struct BuiltOn {
    std::string_view verdict;
    bool pdf, f, draws, weights;
};
constexpr BuiltOn built_on[] = {{"support", true, true, false, false}, {"normalised", true, false, true, false},
    {"density", true, false, true, false}, {"identity", true, true, true, true}, {"physics", false, true, false, false},
    {"tail", true, true, true, true}, {"mean", true, true, true, true}};

}  // namespace

bool CheckAt::is_withheld(std::string_view verdict) const {
    const auto exceeds_limit = [](std::uint64_t invalid, std::uint64_t evaluations) {
        return static_cast<double>(invalid) > most_invalid * static_cast<double>(evaluations);
    };
    const DrawChecks& c = observations.checks;
    for (const BuiltOn& b : built_on)
        if (b.verdict == verdict)
            return (b.pdf && exceeds_limit(invalid.pdf, invalid.pdf_evaluations)) ||
                (b.f && exceeds_limit(invalid.f, invalid.f_evaluations)) ||
                (b.draws && exceeds_limit(c.unusable, c.draws)) ||
                (b.weights && exceeds_limit(c.bad_weights, c.directions));
    return false;
}

double CheckAt::most_ratio() const { return scatter.pdf() ? inconclusive_of_estimates : inconclusive_at; }

bool CheckAt::is_integral_open() const { return sizes.integral && *sizes.integral > most_ratio() * target_constant; }

CheckAt check_sampler_at(const SamplerAdapter& adapter, int technique, Vec3d wo, const CaseData& data,
    const CheckBudget& budget, std::uint32_t seed) {
    return Check(adapter, technique, wo, data, budget, seed).run();
}

}  // namespace crescent::check
