// Stage 1 looks at more and more draws. A difference at a look is tested again with as many fresh draws, on the same
// side. The normal law holds for a mean of n draws only if their skewness is small against sqrt(n): before that, and
// for a heavy tail, there is no verdict.
#include "check/numbers/number_check.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "check/constants.h"
#include "check/decide/check_at.h"
#include "check/estimate/stream.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent::check {

namespace {

constexpr std::uint32_t looks[] = {1u << 14, 1u << 16, 1u << 18, 1u << 20, 1u << 22};
constexpr double quick_seconds = 10, thorough_seconds = 120;
constexpr double target_bias = 5e-3;    // relative: a right verdict is given at once
constexpr double most_bias = 1e-2;      // a verdict that could hide more is inconclusive
constexpr double screening = 2e-3;      // level of one look at stage 1, of all channels
constexpr double confirming = 0.05;     // of stage 2: five looks reject a right estimator with a probability of 5e-4
constexpr double most_unusable = 1e-3;  // share of the values, for a mean
constexpr double least_roots = 12;      // sqrt(n) over the skewness, so that the normal law holds to 3 errors
constexpr std::size_t most_kept = 1u << 18;  // values for the tail

/// Sums of one channel about its first value.
struct Moments {
    double origin = 0, n = 0, first = 0, second = 0, third = 0, least = 0, most = 0;
    void add(double x) {
        if (n == 0) origin = least = most = x;
        const double d = x - origin;
        ++n;
        first += d;
        second += d * d;
        third += d * d * d;
        least = std::min(least, x);
        most = std::max(most, x);
    }
    double mean() const { return origin + first / n; }
    double variance() const { return std::max(second / n - sqr(first / n), 0.0) * n / std::max(n - 1, 1.0); }
    double error() const { return std::sqrt(variance() / n); }
    bool is_constant() const { return least == most; }
    double skewness() const {
        const double m = first / n, v = second / n - m * m;
        return v > 0 ? (third / n - 3 * m * second / n + 2 * m * m * m) / (v * std::sqrt(v)) : 0;
    }
    /// Whether the mean is nearly normal.
    bool is_settled() const { return std::fabs(skewness()) * least_roots <= std::sqrt(n); }
};

/// The draws of one estimator, in order.
class NumberDraws {
public:
    NumberDraws(const SamplerAdapter& estimator, StreamKey key)
        : estimator_(estimator), traits_(estimator.traits()), key_(key) {}

    std::array<Moments, 3> channels{};
    std::vector<double> values;  // of channel 0, or luminances; the first of them
    std::uint64_t unusable = 0, drawn = 0;
    PrimarySample first_unusable{};
    double seconds = 0;

    /// Draws until there are n.
    void extend(std::uint32_t n, ProgressMonitor& monitor) {
        std::vector<PrimarySample> u;
        std::vector<Draw> draws;
        const Stopwatch watch;
        while (drawn < n) {
            monitor.check();
            const auto from = static_cast<std::uint32_t>(drawn);
            u.resize(std::min<std::uint32_t>(batch_size, n - from));
            for (std::uint32_t i = 0; i < u.size(); ++i)
                u[i] = numbers_at(key_, from + i, std::max(traits_.numbers, 1), resolution_of(traits_));
            draws.assign(u.size(), {});
            estimator_.sample(0, {0, 0, 1}, u, draws);
            for (std::size_t i = 0; i < u.size(); ++i) add(u[i], draws[i]);
            drawn += u.size();
        }
        seconds += watch.seconds();
    }

private:
    const SamplerAdapter& estimator_;
    Traits traits_;
    StreamKey key_;

    void add(const PrimarySample& u, const Draw& d) {
        const double y = d.weight.value_or(std::nan(""));
        const std::array<double, 3> by_channel = traits_.channels == 3
            ? std::array<double, 3>{d.weights.x, d.weights.y, d.weights.z}
            : std::array<double, 3>{y, y, y};
        if (!std::ranges::all_of(by_channel, [](double v) { return std::isfinite(v); })) {
            if (unusable++ == 0) first_unusable = u;
            return;
        }
        for (std::size_t c = 0; c < 3; ++c) channels[c].add(by_channel[c]);
        if (values.size() < most_kept) values.push_back(std::fabs(y));
    }
};

/// The difference of two means, or of a mean and a number, with its error.
struct MeanDifference {
    double value = 0, error = 0, expected = 0;
    double spread = 0;  // standard deviation of one value
    /// What sizes are relative to: the expected value, or the spread if 0 is expected.
    double unit() const { return std::max(expected != 0 ? std::fabs(expected) : spread, 1e-300); }
    const char* unit_words() const { return expected != 0 ? "" : " of the standard deviation of a value"; }
    /// Differences up to this are rounding.
    double rounding() const { return 64 * ulp * std::max(std::fabs(expected), std::fabs(expected + value)); }
    double errors() const { return error > 0 ? value / error : value == 0 ? 0 : std::copysign(1e300, value); }
};

struct Decision {
    State state = State::inconclusive;
    MeanDifference difference{};
    int channel = 0;
    double hidden = 0;  // the relative bias that would have been found
};

class NumberCheck {
public:
    NumberCheck(const std::shared_ptr<const SamplerAdapter>& estimator, const ExpectedMean& expected,
        const TestSettings& settings, ProgressMonitor& monitor)
        : a_(*estimator, key(settings.seed, 1, 0)),
          expected_(expected),
          settings_(settings),
          monitor_(monitor),
          estimator_(estimator) {
        if (expected.estimator) b_.emplace(*expected.estimator, key(settings.seed, 1, 1));
    }

    CheckResult run() {
        const Stopwatch watch;
        monitor_.begin("draws", std::size(looks));
        for (std::size_t k = 0; k < std::size(looks); ++k) {
            a_.extend(looks[k], monitor_);
            if (b_) b_->extend(looks[k], monitor_);
            ++made_;
            const bool last =
                k + 1 == std::size(looks) || watch.seconds() > (settings_.full ? thorough_seconds : quick_seconds) / 4;
            look(k, last);
            monitor_.advance(1);
            const bool decided = decision_.state == State::wrong || a_.unusable > 0 ||
                (decision_.state == State::right && decision_.hidden <= target_bias && !settings_.full);
            if (decided || last) break;
        }
        return result();
    }

private:
    NumberDraws a_;
    std::optional<NumberDraws> b_;
    const ExpectedMean& expected_;
    const TestSettings& settings_;
    ProgressMonitor& monitor_;
    std::shared_ptr<const SamplerAdapter> estimator_;
    Decision decision_;
    std::uint64_t made_ = 0, confirmed_ = 0;

    static StreamKey key(std::uint32_t seed, std::uint8_t stage, std::uint8_t side) {
        return {.seed = seed, .technique = side, .stage = stage, .purpose = Purpose::draws};
    }
    int channels() const { return estimator_->traits().channels == 3 ? 3 : 1; }

    MeanDifference difference(const NumberDraws& a, const NumberDraws* b, int channel) const {
        const auto c = static_cast<std::size_t>(channel);
        const Moments& x = a.channels[c];
        const double spread = std::sqrt(x.variance());
        if (!b) return {x.mean() - (*expected_.value)[c], x.error(), (*expected_.value)[c], spread};
        const Moments& y = b->channels[c];
        return {x.mean() - y.mean(), math::hypot(x.error(), y.error()), y.mean(), spread};
    }
    static bool settled(const NumberDraws& draws, int channel) {
        return draws.channels[static_cast<std::size_t>(channel)].is_settled();
    }
    bool heavy() const {
        const WeightTail tail = tail_of_weights(a_.values);
        const bool other = b_ && (tail_of_weights(b_->values).heavy() || tail_of_weights(b_->values).open());
        return tail.heavy() || tail.open() || other;
    }

    void look(std::size_t k, bool last) {
        decision_ = {};
        if (a_.channels[0].n < 2) return;
        const bool no_law = heavy();
        decision_.state = no_law ? State::inconclusive : State::right;
        for (int c = 0; c < channels(); ++c) {
            const MeanDifference d = difference(a_, b_ ? &*b_ : nullptr, c);
            const bool constant = d.error == 0;  // a rare value may not have been drawn yet
            const bool lawful = constant ? last : !no_law && settled(a_, c) && (!b_ || settled(*b_, c));
            const double size = size_of(d);
            if (c == 0 || size > decision_.hidden) {
                decision_.hidden = size;
                decision_.difference = d;
                decision_.channel = c;
            }
            if (!lawful) {
                decision_.state = State::inconclusive;
                continue;
            }
            if (std::fabs(d.value) <= d.rounding()) continue;
            if (normal_two_sided(d.errors()) > screening / channels()) continue;
            if (!is_confirmed(k, c, d)) continue;
            ++confirmed_;
            decision_ = {.state = State::wrong, .difference = d, .channel = c, .hidden = size};
            return;
        }
        if (decision_.state == State::right && decision_.hidden > most_bias) decision_.state = State::inconclusive;
    }

    /// A bias of this relative size passes both stages with a probability of 90 %.
    static double size_of(const MeanDifference& d) {
        constexpr double errors = 3.09 + 1.3;  // of the screening level, and of 90 %
        return (errors * d.error + d.rounding()) / d.unit();
    }

    bool is_confirmed(std::size_t k, int channel, const MeanDifference& first) {
        NumberDraws a(*estimator_, key(settings_.seed, static_cast<std::uint8_t>(2 + k), 0));
        a.extend(looks[k], monitor_);
        std::optional<NumberDraws> b;
        if (expected_.estimator) {
            b.emplace(*expected_.estimator, key(settings_.seed, static_cast<std::uint8_t>(2 + k), 1));
            b->extend(looks[k], monitor_);
        }
        const MeanDifference second = difference(a, b ? &*b : nullptr, channel);
        return second.value * first.value > 0 && normal_two_sided(second.errors()) <= 2 * confirming;
    }

    // ---- Verdicts.

    CheckResult result() {
        CheckResult out;
        out.alpha = settings_.alpha;
        out.tests = made_ * static_cast<std::uint64_t>(channels());
        out.confirmed = out.screened = confirmed_;
        out.evaluations = out.questions = a_.drawn + (b_ ? b_->drawn : 0);
        CheckCase check_case;
        check_case.arm = estimator_->name();
        check_case.adapter = estimator_;
        const WeightTail tail = tail_of_weights(a_.values);
        for (std::string_view name : verdict_names) {
            Verdict v;
            v.arm = check_case.arm;
            v.check_case = check_case.text();
            v.name = name;
            if (name == "valid") set_valid(v);
            else if (name == "tail" && a_.values.size() > 1) set_tail(check_case, tail, v);
            else if (name == "mean") set_mean(v);
            else if (name == "efficiency" && b_) set_efficiency(v);
            else {
                v.state = State::skipped;
                v.sentences = {
                    {"needs", name == "efficiency" ? "Needs another estimator." : "A number has no density."}};
            }
            v.expected = v.state == State::right || v.state == State::skipped ||
                (v.state == State::inconclusive && (name == "tail" || name == "mean"));
            out.verdicts.push_back(std::move(v));
        }
        next_step(out);
        return out;
    }

    static constexpr const char* bounded_values = "An estimator whose values have a finite variance.";

    static void set_tail(const CheckCase& check_case, const WeightTail& tail, Verdict& v) {
        test_tail(check_case, tail, v);
        if (v.next.kind != NextStep::Kind::heavier_pdf) return;
        v.next = {};
        v.next_step = bounded_values;
    }

    void set_valid(Verdict& v) const {
        v.evidence["draws"] = a_.drawn;
        v.evidence["unusable"] = a_.unusable;
        v.sentences = {{"usable", fmt::format("{} values can be used.", a_.drawn - a_.unusable)},
            {"detectable",
                fmt::format("NaN in one of {:.2g} draws would have been found.", static_cast<double>(a_.drawn) / 3)}};
        if (a_.unusable == 0) return;
        v.state = State::wrong;
        v.size = static_cast<double>(a_.unusable) / static_cast<double>(a_.drawn);
        std::string u;
        for (int k = 0; k < estimator_->traits().numbers; ++k)
            u += fmt::format("{}{:.6g}", k ? ", " : "", a_.first_unusable[k]);
        v.sentences = {{"not finite",
            fmt::format("{} of {} values are not finite, first at u = ({}).", a_.unusable, a_.drawn, u)}};
    }

    void set_mean(Verdict& v) const {
        const Decision& d = decision_;
        const Moments& x = a_.channels[static_cast<std::size_t>(d.channel)];
        v.state = d.state;
        v.evidence = {{"draws", a_.drawn}, {"mean", x.n > 0 ? x.mean() : 0},
            {"standard_error", x.n > 0 ? x.error() : 0}, {"expected", d.difference.expected}};
        if (x.n < 2 || static_cast<double>(a_.unusable) > most_unusable * static_cast<double>(a_.drawn)) {
            v.state = State::skipped;
            v.sentences = {{"withheld", "Not given, since too many of the values are not numbers: see valid."}};
            return;
        }
        const std::string channel = channels() == 3 ? fmt::format(" in channel {}", d.channel + 1) : "";
        const std::string mean = with_error(x.mean(), half_width_95 * x.error());
        const double bias = d.difference.value / d.difference.unit();
        v.evidence["bias"] = bias;
        if (d.state == State::inconclusive && heavy()) {
            v.sentences = {{"mean",
                               fmt::format("The values average to {:.5g}{}, {:.5g} expected.", x.mean(), channel,
                                   d.difference.expected)},
                {"heavy tail", "Their tail is heavy, so that no interval of the mean is valid."}};
            v.next_step = bounded_values;
            return;
        }
        v.sentences = {{"mean", fmt::format("The values average to {}{}.", mean, channel)},
            {"expected",
                fmt::format("Expected {:.7g}{}.", d.difference.expected,
                    b_ ? ", the mean of " + expected_.estimator->name() : "")}};
        if (d.state == State::wrong) {
            v.size = std::fabs(bias);
            v.sentences.push_back({"bias",
                fmt::format("That is {} too {}.",
                    percent_with_error(std::fabs(bias), half_width_95 * d.difference.error / d.difference.unit()) +
                        d.difference.unit_words(),
                    bias > 0 ? "large" : "small")});
        } else if (d.state == State::right) {
            v.hidden["bias"] = d.hidden;
            v.evidence["would_have_found"] = {{"bias", d.hidden}};
            v.sentences.push_back({"detectable",
                fmt::format("A bias of {:.2g} %{} would have been found.", 100 * d.hidden, d.difference.unit_words())});
        } else {
            v.sentences.push_back({"detectable",
                fmt::format(
                    "Only a bias of {:.2g} %{} would have been found.", 100 * d.hidden, d.difference.unit_words())});
            v.sentences.push_back({"required", fmt::format("Right requires at most {:g} %.", 100 * most_bias)});
            v.next = {NextStep::Kind::more_draws, std::max(sqr(d.hidden / (most_bias)), 4.0)};
        }
    }

    void set_efficiency(Verdict& v) const {
        const Moments &x = a_.channels[0], &y = b_->channels[0];
        if (!(x.variance() > 0 && y.variance() > 0)) {
            v.state = State::skipped;
            v.sentences = {{"no variance", "One of the estimators has no variance."}};
            return;
        }
        const double ratio = x.variance() / y.variance();
        v.evidence["variance_ratio"] = ratio;
        v.sentences = {
            {"variance", fmt::format("Its variance is {:.3g} times that of {}.", ratio, expected_.estimator->name())}};
        v.timed_message = fmt::format(" A draw takes {:.3g} times as long.", a_.seconds / b_->seconds);
    }
};

}  // namespace

CheckResult check_number(const std::shared_ptr<const SamplerAdapter>& estimator, const ExpectedMean& expected,
    const TestSettings& settings, ProgressMonitor& monitor) {
    CheckResult out = NumberCheck(estimator, expected, settings, monitor).run();
    for (const auto& sampler : {estimator, expected.estimator})
        if (sampler) add_device(sampler->name(), *sampler, out.devices);
    return out;
}

}  // namespace crescent::check
