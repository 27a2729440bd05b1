// The first draws are kept, and so are their f and weights. What rounding allows is read off the digits of the
// directions: decimal, float or double.
#include "trials/trial_context.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"

namespace crescent::inline trials {

namespace {

bool multiples_of(std::span<const Draw> draws, double unit) {
    for (const Draw& d : draws)
        for (double v : {d.wi.x, d.wi.y, d.wi.z})
            if (std::fabs(v / unit - std::round(v / unit)) > 1e-6) return false;
    return true;
}

double rounding_of(std::span<const Draw> all, int bits) {
    if (bits > 0) return bits <= 24 ? 0x1p-24 : 0x1p-50;
    std::vector<Draw> draws;
    for (const Draw& d : all) {
        if (draws.size() == 256) break;
        if (d.pdf > 0 || d.delta > 0) draws.push_back(d);
    }
    for (int digits = 3; digits <= 8; ++digits)
        if (multiples_of(draws, math::pow(10.0, -digits))) return 0.5 * math::pow(10.0, -digits);
    for (const Draw& d : draws)
        for (double v : {d.wi.x, d.wi.y, d.wi.z})
            if (static_cast<double>(static_cast<float>(v)) != v) {
                return std::fabs(v - static_cast<double>(static_cast<float>(v))) < 2e-9 * std::fabs(v) ? 0x1p-24
                                                                                                       : 0x1p-50;
            }
    return 0x1p-24;
}

}  // namespace

TestSettings TestSettings::thorough() {
    TestSettings r;
    r.full = true;
    r.draws = std::uint64_t{1} << 19;
    r.rings = 30;
    r.sectors = 32;
    r.evaluations = 1000000;
    r.questions = 6000000;
    r.questions_in_all = 72000000;
    return r;
}

void TestSettings::share(std::uint64_t tests) {
    const double each = -math::expm1(math::log1p(-alpha) / static_cast<double>(std::max<std::uint64_t>(tests, 1)));
    screen = std::min(std::sqrt(10 * each), 0.05);
    confirm = std::min(each / screen, screen / 10);
}

TrialContext::TrialContext(const Trial& t, const TestSettings& r, TestCounts& counts, std::uint32_t index)
    : trial(t),
      settings(r),
      test_counts(counts),
      subject(*t.subject),
      traits(t.subject->traits()),
      index_(index),
      seed_(r.seed) {
    asked_before_ = subject.spending().answers;
    for (int k = 0; k < subject.techniques(); ++k) first_.push_back(draw(k, 0));
    direction_resolution_ = rounding_of(first_[0].draws, traits.bits);
    scatter_ = look_for_scatter(*this);
    for (SampleBatch& b : first_) count_nothing(b);
    look_below();
}

std::size_t TrialContext::affordable(std::size_t wanted, std::size_t keep) const {
    if (!subject.limited()) return wanted;
    constexpr std::size_t small_change = 80000;  // the warp, conditioning and the least of every integral
    const std::size_t asked =
        static_cast<std::size_t>(subject.spending().answers - asked_before_) + keep + small_change;
    return std::min(wanted, std::max<std::size_t>(settings.questions > asked ? settings.questions - asked : 0, 2000));
}

std::size_t TrialContext::left() const {
    const std::size_t asked = static_cast<std::size_t>(subject.spending().answers - asked_before_);
    return settings.questions > asked ? settings.questions - asked : 0;
}

std::size_t TrialContext::for_later() const {
    return std::min(settings.questions / (subject.has_f() ? 3 : 8), left() / 2);
}

std::vector<double> TrialContext::pdf(int technique, std::span<const Vec3d> wi, bool exact) const {
    std::vector<Pair> at(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) at[i] = {trial.wo, wi[i]};
    std::vector<double> out(wi.size(), 1.0);
    if (!traits.has_pdf) return out;  // not known; a draw has 1
    if (exact) subject.exact_pdf(technique, at, out);
    else subject.pdf(technique, at, out);
    return out;
}

std::vector<double> TrialContext::any_pdf(std::span<const Vec3d> wi) const {
    std::vector<double> sum(wi.size());
    for (int t = 0; t < subject.techniques(); ++t) {
        const std::vector<double> p = pdf(t, wi, true);
        for (std::size_t i = 0; i < p.size(); ++i) sum[i] += p[i];
    }
    return sum;
}

std::vector<double> TrialContext::f(std::span<const Vec3d> wi, bool truth) const {
    std::vector<Pair> at(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) at[i] = {trial.wo, wi[i]};
    std::vector<double> out(wi.size());
    if (truth) subject.true_f(at, out);
    else subject.f(at, out);
    return out;
}

std::vector<Vec3d> TrialContext::f_channels(std::span<const Vec3d> wi) const {
    std::vector<Pair> at(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) at[i] = {trial.wo, wi[i]};
    std::vector<Vec3d> out(wi.size());
    subject.f_channels(at, out);
    return out;
}

std::vector<double> TrialContext::f_of_channel(std::span<const Vec3d> wi, int channel) const {
    std::vector<double> out;
    for (Vec3d v : f_channels(wi)) out.push_back(channel == 0 ? v.x : channel == 1 ? v.y : v.z);
    return out;
}

bool TrialContext::weighs() const {
    if (!subject.has_drawn_f()) return false;
    const std::vector<Draw>& draws = first_[0].draws;
    return traits.has_pdf ||
        std::any_of(draws.begin(), draws.end(), [](const Draw& d) { return d.weight.has_value(); });
}

std::vector<double> TrialContext::weights(std::span<const SampleBatch> techniques, bool even) const {
    std::vector<double> x(techniques[0].draws.size());
    for (std::size_t t = 0; t < techniques.size(); ++t) {
        const SampleBatch& b = techniques[t];
        std::vector<Pair> at;
        for (const Draw& d : b.draws) at.push_back({trial.wo, d.pdf > 0 && counts(d.wi) ? d.wi : Vec3d{0, 0, 1}});
        std::vector<double> mis(at.size());
        subject.mis_weight(static_cast<int>(t), at, mis);
        const std::vector<double>& value = f_of_drawn(b);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const Draw& d = b.draws[i];
            if (!(d.pdf > 0 || d.delta > 0) || !counts(d.wi)) continue;
            const double of_one = d.weight ? *d.weight : value[i] * std::fabs(d.wi.z) / d.pdf;
            x[i] += mis[i] * of_one * (even ? 1 : light(d.wi));
        }
    }
    return x;
}

const std::vector<double>& TrialContext::first_weights(bool even) const {
    std::vector<double>& kept = first_weights_[even];
    if (kept.empty()) kept = weights(first_, even);
    return kept;
}

Verdict TrialContext::verdict(std::string_view name, State state, std::string say) const {
    Verdict v;
    v.arm = trial.arm;
    v.trial = trial.text();
    v.name = name;
    v.state = state;
    v.say = std::move(say);
    return v;
}

}  // namespace crescent::inline trials
