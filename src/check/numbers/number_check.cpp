// Stage 1 looks at more and more draws. A difference at a look is tested again with as many fresh draws, on the same
// side. The normal law holds for a mean of n draws only if their skewness is small against sqrt(n): before that, and
// for a heavy tail, there is no verdict.
#include "check/numbers/number_check.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "check/constants.h"
#include "check/decide/tail.h"
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
constexpr std::size_t most_values = 1u << 18;  // values for the tail

/// Sums of one channel about its first value.
struct Moments {
    double origin = 0, n = 0, first = 0, second = 0, third = 0, least_value = 0, greatest_value = 0;
    void add(double x) {
        if (n == 0) origin = least_value = greatest_value = x;
        const double d = x - origin;
        ++n;
        first += d;
        second += d * d;
        third += d * d * d;
        least_value = std::min(least_value, x);
        greatest_value = std::max(greatest_value, x);
    }
    double mean() const { return origin + first / n; }
    double variance() const { return std::max(second / n - sqr(first / n), 0.0) * n / std::max(n - 1, 1.0); }
    double error() const { return std::sqrt(variance() / n); }
    bool is_constant() const { return least_value == greatest_value; }
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
    std::uint64_t unusable_count = 0, draw_count = 0;
    PrimarySample first_unusable{};
    double seconds = 0;

    /// Draws until there are n.
    void extend(std::uint32_t n, ProgressMonitor& monitor) {
        std::vector<PrimarySample> u;
        std::vector<Draw> draws;
        const Stopwatch watch;
        while (draw_count < n) {
            monitor.check();
            const auto from = static_cast<std::uint32_t>(draw_count);
            u.resize(std::min<std::uint32_t>(batch_size, n - from));
            for (std::uint32_t i = 0; i < u.size(); ++i)
                u[i] = numbers_at(key_, from + i, std::max(traits_.numbers, 1), resolution_of(traits_));
            draws.assign(u.size(), {});
            estimator_.sample(0, {0, 0, 1}, u, draws);
            for (std::size_t i = 0; i < u.size(); ++i) add(u[i], draws[i]);
            draw_count += u.size();
        }
        seconds += watch.seconds();
    }

private:
    const SamplerAdapter& estimator_;
    Traits traits_;
    StreamKey key_;

    void add(const PrimarySample& u, const Draw& d) {
        const double y = d.weight.value_or(std::nan(""));
        const std::array<double, 3> channel_values = traits_.channels == 3
            ? std::array<double, 3>{d.weights.x, d.weights.y, d.weights.z}
            : std::array<double, 3>{y, y, y};
        if (!std::ranges::all_of(channel_values, [](double v) { return std::isfinite(v); })) {
            if (unusable_count++ == 0) first_unusable = u;
            return;
        }
        for (std::size_t c = 0; c < 3; ++c) channels[c].add(channel_values[c]);
        if (values.size() < most_values) values.push_back(std::fabs(y));
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
            ++look_count_;
            const bool is_last =
                k + 1 == std::size(looks) || watch.seconds() > (settings_.full ? thorough_seconds : quick_seconds) / 4;
            look(k, is_last);
            monitor_.advance(1);
            const bool is_decided = decision_.state == State::wrong || a_.unusable_count > 0 ||
                (decision_.state == State::right && decision_.hidden <= target_bias && !settings_.full);
            if (is_decided || is_last) break;
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
    std::uint64_t look_count_ = 0, confirmed_count_ = 0;

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
        const bool is_other_heavy = b_ && (tail_of_weights(b_->values).heavy() || tail_of_weights(b_->values).open());
        return tail.heavy() || tail.open() || is_other_heavy;
    }

    void look(std::size_t k, bool is_last) {
        decision_ = {};
        if (a_.channels[0].n < 2) return;
        const bool is_heavy = heavy();
        decision_.state = is_heavy ? State::inconclusive : State::right;
        for (int c = 0; c < channels(); ++c) {
            const MeanDifference d = difference(a_, b_ ? &*b_ : nullptr, c);
            const bool is_constant = d.error == 0;  // a rare value may not have been drawn yet
            const bool is_lawful = is_constant ? is_last : !is_heavy && settled(a_, c) && (!b_ || settled(*b_, c));
            const double size = size_of(d);
            if (c == 0 || size > decision_.hidden) {
                decision_.hidden = size;
                decision_.difference = d;
                decision_.channel = c;
            }
            if (!is_lawful) {
                decision_.state = State::inconclusive;
                continue;
            }
            if (std::fabs(d.value) <= d.rounding()) continue;
            if (normal_two_sided(d.errors()) > screening / channels()) continue;
            if (!is_confirmed(k, c, d)) continue;
            ++confirmed_count_;
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
        out.tests = look_count_ * static_cast<std::uint64_t>(channels());
        out.confirmed = out.screened = confirmed_count_;
        out.evaluations = out.questions = a_.draw_count + (b_ ? b_->draw_count : 0);
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
        set_state(out);
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
        v.evidence["draws"] = a_.draw_count;
        v.evidence["unusable"] = a_.unusable_count;
        v.sentences = {{"usable", fmt::format("{} values can be used.", a_.draw_count - a_.unusable_count)},
            {"detectable",
                fmt::format(
                    "NaN in one of {:.2g} draws would have been found.", static_cast<double>(a_.draw_count) / 3)}};
        if (a_.unusable_count == 0) return;
        v.state = State::wrong;
        v.size = static_cast<double>(a_.unusable_count) / static_cast<double>(a_.draw_count);
        std::string u;
        for (int k = 0; k < estimator_->traits().numbers; ++k)
            u += fmt::format("{}{:.6g}", k ? ", " : "", a_.first_unusable[k]);
        v.sentences = {{"not finite",
            fmt::format("{} of {} values are not finite, first at u = ({}).", a_.unusable_count, a_.draw_count, u)}};
    }

    void set_mean(Verdict& v) const {
        const Decision& d = decision_;
        const Moments& x = a_.channels[static_cast<std::size_t>(d.channel)];
        v.state = d.state;
        v.evidence = {{"draws", a_.draw_count}, {"mean", x.n > 0 ? x.mean() : 0},
            {"standard_error", x.n > 0 ? x.error() : 0}, {"expected", d.difference.expected}};
        if (x.n < 2 || static_cast<double>(a_.unusable_count) > most_unusable * static_cast<double>(a_.draw_count)) {
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
