// A tail is heavy if the interval of its index is at or above 1/2, and open if the interval contains 1/2.
#include "check/decide/tail.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/decide/check_at.h"
#include "math/functions.h"

namespace crescent::check {

namespace {

std::size_t times_of_largest(std::span<const double> x) {
    if (x.empty()) return 0;
    const double threshold = *std::ranges::max_element(x) * (1 - alike_values);
    return static_cast<std::size_t>(std::ranges::count_if(x, [&](double v) { return v >= threshold; }));
}

bool is_of_few_values(std::span<const double> falling) {
    std::size_t values = 0;
    for (std::size_t i = 0; i < falling.size() && values <= few_values; ++values) {
        const double threshold = falling[i] * (1 - alike_values);
        while (i < falling.size() && falling[i] >= threshold) ++i;
    }
    return values <= few_values;
}

std::optional<Tail> fit_of(std::span<const double> x) {
    const std::size_t length = std::min(tail_length(x.size()) + 1, x.size());
    std::vector<double> largest(x.begin(), x.end());
    std::partial_sort(
        largest.begin(), largest.begin() + static_cast<std::ptrdiff_t>(length), largest.end(), std::greater<>());
    const std::span<const double> falling = std::span<const double>(largest).first(length);
    const std::optional<Tail> tail = fit_tail(falling);
    const auto may_be_heavy = [](const Tail& t) { return t.k + 2 * t.se >= heavy_index; };
    if (!tail || !may_be_heavy(*tail)) return tail;
    if (times_of_largest(falling) >= bound_drawn || is_of_few_values(falling)) return {};
    if (length <= deeper_part * deeper_least) return tail;
    const std::optional<Tail> upper = fit_tail(falling.first(1 + (length - 1) / deeper_part));
    return upper && !may_be_heavy(*upper) ? upper : tail;
}

/// Appends the points of one technique whose weights exceed the largest drawn; returns the integral over all points.
double find_unseen(const CheckAt& c, std::vector<WeightedPoint>& unseen) {
    const std::vector<double>& x = c.observations.weights;
    if (x.empty() || c.plan->estimates) return 0;
    const double largest = *std::ranges::max_element(x) * (1 + alike_weights);
    double integral = 0;
    for (const WeightedPoint& w : c.integrals.light.weighted_points) {
        integral += w.light;
        if (w.x > largest) unseen.push_back(w);
    }
    return integral;
}

void note_unseen(std::vector<WeightedPoint> unseen, WeightTail& to) {
    double square = 0;
    for (const WeightedPoint& w : unseen) {
        to.unseen += w.light;
        to.unseen_chance += w.chance;
        square += w.light * w.light;
    }
    to.unseen_error = std::sqrt(square);
    std::ranges::sort(unseen, std::greater<>(), &WeightedPoint::x);
    double light = 0;
    for (std::size_t i = 0; i < unseen.size() && light < to.unseen / 2; ++i) {
        light += unseen[i].light;
        to.half_chance += unseen[i].chance;
    }
}

double standard_error(const Spread& s) { return s.sd / std::sqrt(std::max(s.n, 1.0)); }

/// Number of draws whose mean has a standard error of 1 %.
double draws_for_1_percent(const Spread& s) {
    return s.mean > 0 ? std::max(s.sd * s.sd / (s.mean * s.mean) / 1e-4, 1.0) : 1;
}

/// Describes the fit to the largest weights, or why there is none.
void describe_fit(const WeightTail& t, const CheckCase& check_case, Verdict& v) {
    if (!t.fit) {
        v.evidence["times_largest"] = t.times_largest;
        v.sentences = {{"no tail",
            t.times_largest < bound_drawn || static_cast<double>(t.times_largest) == t.spread.n
                ? "The largest weights are alike: there is no tail."
                : fmt::format("The largest weight was drawn {} times: there is no tail.", t.times_largest)}};
        return;
    }
    v.evidence["k"] = t.fit->k;
    v.evidence["se"] = t.fit->se;
    v.evidence["exceedances"] = t.fit->exceedances;
    v.sentences = {{"tail index",
        fmt::format("k-hat = {:.3f} +- {:.3f} over the {} largest weights{}.", t.fit->k, t.fit->se, t.fit->exceedances,
            check_case.theory.tail_k ? fmt::format(" (theory: {:.3f})", *check_case.theory.tail_k) : "")}};
}

void describe_unseen(const WeightTail& t, Verdict& v) {
    const double share = t.unseen / t.integral;
    v.state = State::inconclusive;
    v.unmet_tail = true;
    v.evidence["unmet_share"] = share;
    v.evidence["unmet_share_error"] = t.unseen_error / t.integral;
    v.evidence["unmet_chance_of_a_draw"] = t.unseen_chance;
    v.evidence["largest_drawn_weight"] = t.spread.largest;
    v.evidence["unmet_half_chance"] = t.half_chance;
    v.sentences.push_back({"unseen tail",
        fmt::format(
            "Heavy tail that no draw met: {:.3g} +- {:.2g} % of f L cos comes from directions whose weight is "
            "larger than the largest of {:.0f} draws, {:.4g}, half of it from directions that p gives {:.2g} of "
            "a draw.",
            100 * share, 196 * t.unseen_error / t.integral, t.spread.n, t.spread.largest, t.half_chance)});
    const double times = t.half_chance > 0 ? 1 / (t.half_chance * t.spread.n) : 1e300;
    if (times <= within_reach) v.next = {NextStep::Kind::more_draws, std::max(times, 2.0)};
    else v.next.kind = NextStep::Kind::heavier_pdf;
}

bool has_lower_draws(const CheckAt& c) {
    if (!c.plan) return false;
    const std::vector<Leaf>& leaves = c.plan->tree.leaves();
    for (std::size_t l = 0; l < std::min(leaves.size(), c.observations.counts.size()); ++l)
        if (c.observations.counts[l] > 0 && c.plan->tree.rect(leaves[l]).t0 >= 1) return true;
    return false;
}

bool has_weights(std::span<const CheckAt> techniques) {
    return !techniques.empty() && std::ranges::all_of(techniques, [](const CheckAt& c) {
        return !c.observations.weights.empty() && c.observations.weightless == 0;
    });
}

}  // namespace

bool WeightTail::has_unseen() const {
    return integral > 0 &&
        unseen - 2 * unseen_error > unseen_errors * standard_error(spread) + detection_floor * integral &&
        spread.n * unseen_chance < -math::log(missed_by_chance);
}

std::vector<double> weights_of(std::span<const CheckAt> techniques) {
    std::vector<double> out;
    for (const CheckAt& c : techniques) {
        const std::vector<double>& x = c.observations.weights;
        if (out.empty()) out = x;
        else
            for (std::size_t i = 0; i < std::min(x.size(), out.size()); ++i) out[i] += x[i];
    }
    return out;
}

WeightTail tail_of_weights(std::span<const double> x) {
    WeightTail out;
    out.has_weights = !x.empty();
    out.spread = crescent::spread(x);
    double fourth = 0;
    for (double v : x) fourth += sqr(sqr(v - out.spread.mean)) / out.spread.n;
    const double variance = sqr(out.spread.sd);
    if (variance > 0) out.variance_error = std::sqrt(std::max(fourth / sqr(variance) - 1, 0.0) / out.spread.n);
    out.times_largest = times_of_largest(x);
    out.bounded = out.spread.n >= 1000 && out.spread.largest <= bounded_weight * out.spread.mean;
    out.fit = fit_of(x);
    return out;
}

WeightTail tail_of(std::span<const CheckAt> techniques) {
    if (!has_weights(techniques)) return {};
    WeightTail out = tail_of_weights(weights_of(techniques));
    std::vector<WeightedPoint> unseen;
    for (const CheckAt& c : techniques) out.integral += find_unseen(c, unseen);
    note_unseen(std::move(unseen), out);
    out.has_lower_draws = std::ranges::any_of(techniques, has_lower_draws);
    return out;
}

void test_tail(const CheckCase& check_case, const WeightTail& t, Verdict& v) {
    if (!t.has_weights) {
        v.state = State::skipped;
        v.sentences = {{"no weights", "There are no weights f L cos / p."}};
        return;
    }
    const double mean = t.spread.mean;
    v.evidence["draws"] = t.spread.n;
    v.evidence["relative_sd"] = mean > 0 ? t.spread.sd / mean : 0;
    v.evidence["largest_over_mean"] = mean > 0 ? t.spread.largest / mean : 0;
    if (check_case.theory.bounded) v.evidence["theory"] = "bounded";
    if (check_case.theory.tail_k) v.evidence["theory_k"] = *check_case.theory.tail_k;
    describe_fit(t, check_case, v);
    if (t.has_unseen()) {
        v.evidence["samples_for_1_percent"] = "not known";
        describe_unseen(t, v);
    } else if (t.heavy()) {
        v.state = State::inconclusive;
        v.evidence["samples_for_1_percent"] = "no finite answer";
        v.sentences.push_back({"heavy tail",
            "Heavy tail: the variance is infinite or appears to be, so no interval of the mean is valid."});
        v.next.kind = NextStep::Kind::heavier_pdf;
    } else if (t.open()) {
        v.state = State::inconclusive;
        v.evidence["samples_for_1_percent"] = "not known";
        v.sentences.push_back({"open tail",
            "Heavy tail or not: the interval of k contains 1/2, and from 1/2 on the variance is infinite."});
        // The tail of n draws has 3 sqrt(n) weights, so the error of k falls with the fourth root of n.
        const double tails = 4 * t.fit->se * t.fit->se / std::max(sqr(t.fit->k - heavy_index), 1e-4);
        v.next = {NextStep::Kind::more_draws, std::max(sqr(tails), 2.0)};
    } else {
        const double draws = draws_for_1_percent(t.spread);
        v.evidence["samples_for_1_percent"] = draws;
        if (t.bounded)
            v.sentences.push_back(
                {"largest weight", fmt::format("The largest weight is {:.3g} means.", t.spread.largest / mean)});
        v.sentences.push_back(
            {"finite variance", fmt::format("The variance is finite: about {:.3g} samples give 1 %.", draws)});
    }
}

void test_plain_mean(const WeightTail& t, Verdict& v) {
    if (!t.has_weights) return;
    v.evidence["draws"] = t.spread.n;
    v.evidence["mean"] = t.spread.mean;
    v.evidence["standard_error"] = standard_error(t.spread);
    if (t.integral > 0) v.evidence["quadrature"] = t.integral;
    if (v.state != State::right) return;
    if (t.has_unseen()) {
        v.sentences = {{"mean and integral",
            fmt::format(
                "The mean of {:.0f} weights is {:.6g}, the integral {:.6g}.", t.spread.n, t.spread.mean, t.integral)}};
        describe_unseen(t, v);
    } else if (t.heavy()) {
        v.state = State::inconclusive;
        v.sentences = {{"heavy tail", fmt::format("Heavy tail: k-hat = {:.3f} +- {:.3f}.", t.fit->k, t.fit->se)},
            {"mean without interval",
                fmt::format(
                    "Weights below the usual one agree with the integral; the plain mean of all, {:.6g}, has no "
                    "interval.",
                    t.spread.mean)}};
        v.next.kind = NextStep::Kind::heavier_pdf;
    }
}

}  // namespace crescent::check
