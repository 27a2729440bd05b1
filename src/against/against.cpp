// Draws of both in A's bins: Pearson's two-sample chi-square over bins, rings and sectors, and again on fresh seeds
// before anything is said. f and variances are compared in same_f and ratio_of_variances. A and B draw from different
// streams.
#include "against/against.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numeric>
#include <tuple>

#include "against/against_f.h"
#include "against/against_variance.h"
#include "base/parallel.h"
#include "math/functions.h"
#include "simd/random.h"
#include "stats/p_values.h"
#include "subjects/asked_once.h"
#include "subjects/faults.h"
#include "subjects/named_side.h"
#include "trials/delta.h"
#include "trials/trial_context.h"
#include "verdicts/outcome.h"
#include "verdicts/verdict_kind.h"

namespace crescent::inline against {

namespace {

constexpr std::array compared_by = {"same_distribution", "same_f", "variance"};
constexpr std::uint32_t other_stream = 1u << 20;  // B draws from streams that no A draws from

/// Where both are known to draw: A's bins, and the directions of either one's delta parts.
struct Common {
    const Density& bins;
    std::vector<Vec3d> ways;
    bool nothing_below = false;  // without a pdf(w) a draw under the horizon of a surface that lets nothing through
};

Common common_of(const TrialContext& a, const TrialContext& b) {
    constexpr double alike = 1e-4;
    Common out{a.density(0), {}};
    out.nothing_below = !(a.traits.has_pdf && b.traits.has_pdf) && !a.whole() && !b.whole();
    for (const TrialContext* work : {&a, &b})
        for (const DeltaPart& part : delta_parts(*work, work->first(0)).parts)
            if (std::ranges::none_of(out.ways, [&](Vec3d w) { return length(w - part.wi) < alike; }))
                out.ways.push_back(part.wi);
    return out;
}

/// Of the directions that are known the nearest.
std::size_t way_of(std::span<const Vec3d> ways, Vec3d wi) {
    const auto off = [wi](Vec3d w) { return length(w - wi); };
    return static_cast<std::size_t>(std::ranges::min_element(ways, {}, off) - ways.begin());
}

/// Draws of every technique, by bins; what draws nothing is one more, and so is each direction of delta parts.
std::vector<double> count(const TrialContext& work, const Common& common, int round) {
    const Density& bins = common.bins;
    const std::size_t of_nothing = bins.mass.bins.size();
    std::vector<double> out(of_nothing + 1 + common.ways.size());
    for (int t = 0; t < work.subject.techniques(); ++t) {
        const SampleBatch fresh = round == 0 ? SampleBatch{} : work.draw(t, round);
        const SampleBatch& b = round == 0 ? work.first(t) : fresh;
        for (std::size_t i = 0; i < b.draws.size(); ++i) {
            const Draw& d = b.draws[i];
            if (d.delta > 0 && !common.ways.empty()) ++out[of_nothing + 1 + way_of(common.ways, d.wi)];
            else if (is_null_sample(d, b.pdf[i]) || (common.nothing_below && d.wi.z <= 0)) ++out[of_nothing];
            else ++out[bins.bin_of(bins.map.coordinates(d.wi))];
        }
    }
    return out;
}

double total(const std::vector<double>& v) {
    double sum = 0;
    for (double x : v) sum += x;
    return sum;
}

/// Pearson's chi-square of two samples (Press et al., Numerical Recipes, 14.3.2, unequal totals), neighbours pooled to
/// ten draws.
double two_sample_p(const std::vector<double>& a, const std::vector<double>& b) {
    const double na = total(a), nb = total(b);
    if (!(na > 0) || !(nb > 0)) return na == nb ? 1 : 0;
    const double up = std::sqrt(nb / na), down = std::sqrt(na / nb);
    double statistic = 0, degrees = -1, x = 0, y = 0, last_x = 0, last_y = 0;
    const auto term = [&](double p, double q) { return p + q > 0 ? sqr(up * p - down * q) / (p + q) : 0.0; };
    for (std::size_t i = 0; i < a.size(); ++i) {
        x += a[i];
        y += b[i];
        if (x + y < 10) continue;
        statistic += term(x, y);
        ++degrees;
        last_x = x, last_y = y;
        x = y = 0;
    }
    if (x + y > 0)
        statistic += term(last_x + x, last_y + y) - term(last_x, last_y);  // what is left joins the last pool
    return chi_squared_p(statistic, degrees);
}

/// Over all bins, over rings alone, over sectors alone; and over the delta parts and what is none of them.
std::vector<double> two_sample(const Common& common, const std::vector<double>& a, const std::vector<double>& b) {
    const Density& bins = common.bins;
    const std::size_t sectors = static_cast<std::size_t>(bins.sectors), rings = bins.rings.size() - 1;
    std::vector<double> ring_a(rings), ring_b(rings), sector_a(sectors), sector_b(sectors);
    for (std::size_t i = 0; i < rings * sectors; ++i) {
        ring_a[i / sectors] += a[i], ring_b[i / sectors] += b[i];
        sector_a[i % sectors] += a[i], sector_b[i % sectors] += b[i];
    }
    std::vector<double> out = {two_sample_p(a, b), two_sample_p(ring_a, ring_b), two_sample_p(sector_a, sector_b)};
    if (common.ways.empty()) return out;
    const auto parts = [&common](const std::vector<double>& all) {
        std::vector<double> each(all.end() - static_cast<std::ptrdiff_t>(common.ways.size()), all.end());
        each.push_back(total(all) - total(each));
        return each;
    };
    out.push_back(two_sample_p(parts(a), parts(b)));
    return out;
}

Verdict same_distribution(const TrialContext& a, const TrialContext& b, bool expect_same) {
    Verdict v = a.verdict("same_distribution", State::right, "");
    const Common common = common_of(a, b);
    const auto compared = [&](int round) {
        return two_sample(common, count(a, common, round), count(b, common, round));
    };
    const std::vector<double> p = compared(0);
    bool differ = false;
    std::optional<std::vector<double>> again;
    for (std::size_t k = 0; k < p.size(); ++k)
        differ = a.fails(p[k],
                     [&](int round) {
                         if (!again) again = compared(round);
                         return (*again)[k];
                     }) ||
            differ;
    v.evidence["same"] = !differ;
    v.evidence["p"] = p[0];
    v.evidence["p_rings"] = p[1];
    v.evidence["p_sectors"] = p[2];
    if (p.size() > 3) v.evidence["p_delta_parts"] = p[3];
    v.evidence["draws"] = {a.first(0).draws.size(), b.first(0).draws.size()};
    v.state = differ && expect_same ? State::wrong : State::right;
    v.say = fmt::format("{}: p = {:.3g}, rings {:.3g}, sectors {:.3g}{}.",
        differ ? "They draw from different distributions, and again on fresh seeds"
               : "No difference between their distributions is seen",
        p[0], p[1], p[2], p.size() > 3 ? fmt::format(", delta parts {:.3g}", p[3]) : "");
    return v;
}

/// Trials of the same w_o one after the other.
std::vector<std::size_t> by_direction(std::span<const Trial> trials) {
    std::vector<std::size_t> order(trials.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
        const Trial &x = trials[i], &y = trials[k];
        return std::tuple(x.theta_deg, x.azimuth_deg, i) < std::tuple(y.theta_deg, y.azimuth_deg, k);
    });
    return order;
}

/// What cannot be used at all is not compared.
std::optional<std::string> unusable(TrialContext& work, const char* who) {
    const Verdict v = kinds::valid.judge(work);
    if (v.state != State::wrong || v.evidence.contains("usable")) return {};
    return fmt::format("{} is not valid here: {}", who, v.say);
}

std::vector<Verdict> compare_one(
    const Side& one, const Side& other, const TestSettings& settings, bool expect_same, TestCounts& test_counts) {
    const Trial &ta = one.trial, &tb = other.trial;
    TrialContext a(ta, settings, test_counts, one.stream), b(tb, settings, test_counts, other.stream);
    std::vector<Verdict> out;
    std::optional<std::string> fault = unusable(a, "A");
    if (!fault) fault = unusable(b, "B");
    if (fault) {
        for (const char* name : compared_by) {
            out.push_back(a.verdict(name, State::inconclusive, *fault));
            out.back().settle = "A sampler that is valid: `crescent check` of it alone says more.";
        }
    } else {
        a.measure_density();
        b.measure_density();
        out = {same_distribution(a, b, expect_same), same_f(a, b, expect_same)};
        out.push_back(ratio_of_variances(a, b, out[1]));
    }
    for (Verdict& v : out) v.arm = ta.arm + " against " + tb.arm;
    return out;
}

/// Three tests of the distribution, and one of delta parts, two of means and variances, and what either is tested by
/// alone.
std::uint64_t tests_against(std::span<const Trial> a, std::span<const Trial> b) {
    const auto draws_parts = [](const Trial& t) { return t.subject->traits().delta; };
    const bool parts = std::ranges::any_of(a, draws_parts) || std::ranges::any_of(b, draws_parts);
    std::uint64_t tests = (parts ? 6 : 5) * a.size();
    for (const auto& trials : {a, b})
        for (const Trial& t : trials)
            for (const VerdictKind* kind : judged_alone())
                if (kind->tests) tests += kind->tests(t);
    return tests;
}

/// The three verdicts of a w_o at which a sampler broke off.
std::vector<Verdict> broken_off(const Trial& a, const Trial& b, const SubjectFault& fault) {
    const Cut cut = cut_by(fault);
    std::vector<Verdict> out;
    for (const char* name : compared_by) {
        Verdict v;
        v.arm = a.arm + " against " + b.arm;
        v.trial = a.text();
        v.name = name;
        v.state = cut.state;
        v.say = dynamic_cast<const SubjectGone*>(&fault) ? fmt::format("It could not be asked: {}.", fault.what())
                                                         : cut.first;
        if (v.state == State::inconclusive) v.settle = "More time (--patience), or a program that answers faster.";
        out.push_back(std::move(v));
    }
    return out;
}

/// What breaks off says which side it was. A subject stays one for all of its trials.
std::vector<Trial> named_trials(std::span<const Trial> trials, const std::string& side) {
    std::vector<Trial> out(trials.begin(), trials.end());
    std::map<std::shared_ptr<const JudgedSampler>, std::shared_ptr<const JudgedSampler>> named;
    for (Trial& t : out) {
        std::shared_ptr<const JudgedSampler>& one = named[t.subject];
        if (!one) one = named_side(t.subject, side);
        t.subject = one;
    }
    return out;
}

/// That of all: the worst of them.
State state_of(const std::vector<Verdict>& verdicts) {
    for (State s : {State::wrong, State::error, State::inconclusive})
        if (std::ranges::any_of(verdicts, [s](const Verdict& v) { return v.state == s; })) return s;
    return State::right;
}

}  // namespace

Judgement judge_against(std::span<const Trial> a, std::span<const Trial> b, const TestSettings& given, bool expect_same,
    ProgressMonitor& monitor) {
    TestSettings settings = given;
    settings.share(tests_against(a, b));
    TestCounts test_counts;
    monitor.begin("two samplers", static_cast<double>(a.size()));
    std::vector<std::vector<Verdict>> all(a.size());
    const std::vector<Trial> of_a = named_trials(a, "A"), of_b = named_trials(b, "B");
    AskedByDirection asked_a, asked_b;  // kept by one thread, where either is serial
    const auto one = [&](std::size_t i) {
        monitor.check();
        try {
            const auto stream = static_cast<std::uint32_t>(i);
            all[i] = compare_one(asked_a.of(of_a[i], stream), asked_b.of(of_b[i], stream + other_stream), settings,
                expect_same, test_counts);
        } catch (const SubjectFault& fault) { all[i] = broken_off(a[i], b[i], fault); }
        monitor.advance(1);
    };
    bool serial = false;
    for (std::size_t i = 0; i < a.size(); ++i) serial = serial || a[i].subject->serial() || b[i].subject->serial();
    if (serial)
        for (std::size_t i : by_direction(a)) one(i);
    else parallel_for(std::size_t{0}, a.size(), one);
    Judgement out;
    out.alpha = settings.alpha;
    out.tests = test_counts.tests;
    out.screened = test_counts.screened;
    out.confirmed = test_counts.confirmed;
    for (std::size_t i = 0; i < a.size(); ++i) {
        out.questions = std::max(out.questions,
            a[i].subject->spending().answers + (a[i].subject == b[i].subject ? 0 : b[i].subject->spending().answers));
        for (Verdict& v : all[i]) out.verdicts.push_back(std::move(v));
    }
    out.state = state_of(out.verdicts);
    out.as_expected = out.state == State::right;
    return out;
}

std::string against_text(const Judgement& j) {
    std::string out, last;
    for (const Verdict& v : j.verdicts) {
        if (v.trial != last) out += fmt::format("{}{} [{}]\n", out.empty() ? "" : "\n", v.arm, v.trial);
        last = v.trial;
        out += fmt::format("  {:<18} {:<13} {}{}\n", v.name, word(v.state), v.say,
            v.settle.empty() ? "" : " What would settle it: " + v.settle);
    }
    const std::string asked = j.questions > 0 ? fmt::format("; {} questions were answered", j.questions) : "";
    return out +
        fmt::format(
            "\n{}; {} statistical tests share a family-wise error of {:g}{}\n", word(j.state), j.tests, j.alpha, asked);
}

}  // namespace crescent::inline against
