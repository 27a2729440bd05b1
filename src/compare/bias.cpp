// Do two sets of renders have the same expectation? Welch's t-test over renders, per region, tile and pixel, after
// Jung, Hanika & Dachsbacher 2020, "Detecting Bias in Monte Carlo Renderers using Welch's t-test", JCGT 9(2); with the
// chance of a false alarm shared out: half to the regions (Holm), half to the tiles (false discovery rate).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compare/judge.h"
#include "compare/schema.h"
#include "math/functions.h"
#include "report/numbers.h"

namespace crescent {

namespace {

using Values = std::vector<double>;
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

constexpr double lone_pixel = 0.5;  // a tile whose spread is half one pixel of one render is not judged by a t-test
constexpr double few_events = 8;    // so few of the largest errors seen may have been missed by chance

/// Mean and spread of the reference where it is one file: its own variance, if it says one, over independent pixels.
MeanInterval one_file(double mean, double variance, double pixels) {
    MeanInterval out = {mean, 0, 0, std::isnan(variance) ? 0 : std::sqrt(variance / pixels), 1};
    out.n = 1000000;  // its spread is known, not estimated
    return out;
}

class BiasTest {
public:
    BiasTest(const ComparePlan& plan, const Readings& all, const CompareResult& measured, std::size_t a, std::size_t b)
        : all_(all), a_(all.arms[a]), b_(b < all.arms.size() ? all.arms[b] : *all.reference), arm_(measured.arms[a]) {
        out_.a = plan.arms[a].name;
        out_.b = b < all.arms.size() ? plan.arms[b].name : "the reference";
        other_ = b < all.arms.size() ? &measured.arms[b] : nullptr;
        if (plan.pair && other_) pairs_ = pairs_of(a_, b_), out_.paired = true;
    }

    BiasResult judge(double alpha) {
        const RegionResult& frame = arm_.region(whole_frame);
        out_.dependent = frame.colour == NoiseColour::correlated;
        regions(alpha / 2);
        if (a_.files.size() >= 2) tiles(alpha / 2), pixels();
        say(alpha / 2);
        return std::move(out_);
    }

private:
    Welch test(const Values& a, const Values& b, double variance, double pixels) const {
        if (!pairs_.empty()) {
            Values differences;
            for (const auto& [i, j] : pairs_) differences.push_back(a[i] - b[j]);
            return paired_test(mean_interval(differences, confidence));
        }
        const MeanInterval ours = mean_interval(a, confidence);
        return welch_test(ours, b.size() > 1 ? mean_interval(b, confidence) : one_file(b[0], variance, pixels));
    }

    template <class Read> static Values over(const ArmReadings& arm, Read read) {
        Values out;
        for (std::size_t k = 0; k < arm.files.size(); ++k) out.push_back(read(arm, k));
        return out;
    }

    std::string why_not(std::size_t region) const {
        if (a_.files.size() < 2 || (other_ && b_.files.size() < 2)) return "two renders or more of each arm are needed";
        if (!pairs_.empty() && pairs_.size() < 2) return "two pairs or more are needed";
        for (const ArmResult* arm : {&arm_, other_})
            if (arm && arm->regions[region].heavy()) return fmt::format("heavy tail: {}", arm->name);
        return "";
    }

    void regions(double alpha) {
        Values p;
        for (std::size_t r = 0; r < all_.regions.size(); ++r) {
            const auto read = [&](const ArmReadings& arm, std::size_t k) { return arm.regions[k][r].y; };
            MeanTest t;
            const Values a = over(a_, read), b = over(b_, read);
            t.region = all_.regions[r].name;
            t.a = mean_interval(a, confidence).mean, t.b = mean_interval(b, confidence).mean;
            t.why = why_not(r);
            if (t.why.empty()) {
                const double error = reference_error_of_mean(r);
                t.welch = test(a, b, error, static_cast<double>(all_.regions[r].pixels.size()));
            }
            p.push_back(t.why.empty() ? t.welch.p : std::nan(""));
            out_.regions.push_back(std::move(t));
        }
        const std::vector<bool> differs = holm(p, alpha);
        for (std::size_t r = 0; r < p.size(); ++r) {
            MeanTest& t = out_.regions[r];
            t.differs = differs[r] && !by_chance(t.a - t.b, static_cast<double>(all_.regions[r].pixels.size()));
            if (t.why.empty())
                t.smallest =
                    detectable(t.welch, alpha / static_cast<double>(p.size())) / std::max(std::fabs(t.b), 1e-300);
        }
    }

    /// Mean variance of a pixel of the other side where it is one file; NaN where nothing tells it.
    double reference_error_of_mean(std::size_t region) const {
        double sum = 0;
        for (const std::uint32_t i : all_.regions[region].pixels) sum += b_.film.variance(i);
        return sum / static_cast<double>(all_.regions[region].pixels.size());
    }

    void tiles(double alpha) {
        const std::size_t count = all_.tiles.count();
        out_.tile_p.assign(count, std::nan("")), out_.tile_difference.assign(count, std::nan(""));
        for (std::size_t t = 0; t < count; ++t) {
            const auto read = [&](const ArmReadings& arm, std::size_t k) { return arm.tiles[k][t].y; };
            const Values a = over(a_, read), b = over(b_, read);
            if (!std::isfinite(a[0]) || !std::isfinite(b[0])) continue;  // no finite pixel
            const Welch w = test(a, b, std::nan(""), 1);
            out_.tile_difference[t] = mean_interval(a, confidence).mean - mean_interval(b, confidence).mean;
            if (alone(a_, t) || (other_ && alone(b_, t))) ++out_.tiles_left_out;
            else out_.tile_p[t] = by_chance(out_.tile_difference[t], pixels_of(t)) ? 1 : w.p, ++out_.tiles_tested;
        }
        out_.tile_differs = discoveries(out_.tile_p, alpha, out_.dependent);
        out_.tiles_different =
            static_cast<std::size_t>(std::count(out_.tile_differs.begin(), out_.tile_differs.end(), true));
    }

    /// A t-test cannot see rare events that none of the renders met. A difference that a few errors of the largest size
    /// seen in the frame would make up may be such events, and is not told.
    bool by_chance(double difference, double pixels) const {
        double largest = 0;
        for (const ArmReadings* arm : {&a_, other_ ? &b_ : nullptr})
            if (arm && !arm->largest.back().empty())
                largest = std::max(largest, std::sqrt(static_cast<double>(arm->largest.back().front())));
        const std::size_t renders = other_ ? std::min(a_.files.size(), b_.files.size()) : a_.files.size();
        return std::fabs(difference) * pixels * static_cast<double>(renders) < few_events * largest;
    }

    double pixels_of(std::size_t tile) const {
        const int size = all_.tiles.size, column = static_cast<int>(tile) % all_.tiles.across,
                  row = static_cast<int>(tile) / all_.tiles.across;
        return static_cast<double>(std::min(size, all_.width - column * size)) *
            std::min(size, all_.height - row * size);
    }

    static bool alone(const ArmReadings& arm, std::size_t tile) {
        double sum = 0, largest = 0;
        for (const auto& render : arm.tiles)
            sum += render[tile].spread, largest = std::max(largest, render[tile].largest);
        return sum > 0 && largest > lone_pixel * sum;
    }

    /// Histogram of the p of every pixel: flat where nothing differs and the noise is near normal.
    void pixels() {
        if (!pairs_.empty() || b_.files.size() < 2) return;
        out_.pixel_p.assign(10, 0);
        const double ka = static_cast<double>(a_.files.size()), kb = static_cast<double>(b_.files.size());
        for (const std::uint32_t i : all_.regions.back().pixels) {
            const MeanInterval a{a_.film.y[i], 0, 0, std::sqrt(a_.film.variance(i) / ka), a_.files.size()};
            const MeanInterval b{b_.film.y[i], 0, 0, std::sqrt(b_.film.variance(i) / kb), b_.files.size()};
            const double p = welch_test(a, b).p;
            if (std::isfinite(p)) ++out_.pixel_p[std::min<std::size_t>(9, static_cast<std::size_t>(p * 10))];
        }
    }

    void say(double alpha) {
        std::vector<std::string> parts;
        for (const MeanTest& t : out_.regions)
            if (t.differs)
                parts.push_back(fmt::format("mean Y in {} is {} where {} has {} ({:+.2g} %, p = {:.2g})", t.region,
                    figures(t.a), out_.b, figures(t.b), 100 * (t.a / t.b - 1), t.welch.p));
        if (out_.tiles_different)
            parts.push_back(fmt::format("{} of {} tiles differ", out_.tiles_different, out_.tiles_tested));
        if (!parts.empty()) {
            out_.sentence = fmt::format("{} differs from {}: {}.", out_.a, out_.b, fmt::join(parts, "; "));
            return;
        }
        std::vector<std::string> seen, not_seen;
        for (const MeanTest& t : out_.regions) {
            if (t.why.empty()) seen.push_back(fmt::format("{} in {}", percent(t.smallest, 2), t.region));
            else not_seen.push_back(fmt::format("{}: {}", t.region, t.why));
        }
        out_.sentence = seen.empty() ? fmt::format("{} and {} could not be compared", out_.a, out_.b)
                                     : fmt::format(
                                           "No difference between {} and {} was found; one of {} of mean Y would have "
                                           "been, nine times out of ten (alpha {})",
                                           out_.a, out_.b, fmt::join(seen, ", "), figures(alpha, 2));
        if (!not_seen.empty()) out_.sentence += fmt::format("; not tested: {}", fmt::join(not_seen, "; "));
        out_.sentence += ".";
    }

    const Readings& all_;
    const ArmReadings &a_, &b_;
    const ArmResult& arm_;
    const ArmResult* other_ = nullptr;
    Pairs pairs_;
    BiasResult out_;
};

}  // namespace

bool BiasResult::differs() const {
    return tiles_different > 0 ||
        std::any_of(regions.begin(), regions.end(), [](const MeanTest& t) { return t.differs; });
}

BiasResult judge_bias(const ComparePlan& plan, const Readings& all, const CompareResult& measured, std::size_t a,
    std::size_t b, double alpha) {
    return BiasTest(plan, all, measured, a, b).judge(alpha);
}

namespace {

/// Numbers of a file's name that are not the same in all files of its arm: what tells its render.
std::vector<std::uint64_t> own_numbers(const ArmReadings& arm, std::size_t file) {
    std::vector<std::uint64_t> out;
    const auto& own = arm.files[file].numbers;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const bool varies = std::any_of(arm.files.begin(), arm.files.end(),
            [&](const RenderFile& f) { return f.numbers.size() != own.size() || f.numbers[i] != own[i]; });
        if (varies) out.push_back(own[i]);
    }
    return out.empty() ? own : out;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> pairs_of(const ArmReadings& a, const ArmReadings& b) {
    Pairs out;
    for (std::size_t i = 0; i < a.files.size(); ++i) {
        std::vector<std::size_t> partners;
        for (std::size_t j = 0; j < b.files.size(); ++j)
            if (own_numbers(a, i) == own_numbers(b, j)) partners.push_back(j);
        if (partners.size() != 1)
            throw InputError({a.files[i].path, 0, 0},
                fmt::format("--pair: expected one render of the other arm with the same number in its name, found {}",
                    partners.size()));
        out.emplace_back(i, partners[0]);
    }
    if (out.size() != b.files.size())
        throw InputError({b.files[0].path, 0, 0}, "--pair: expected as many renders of one arm as of the other");
    return out;
}

NoiseResult judge_noise(const ComparePlan& plan, const Readings& all, std::size_t a, std::size_t b, double alpha) {
    NoiseResult out{plan.arms[a].name, plan.arms[b].name, {}, {}};
    const auto spreads = [&](const ArmReadings& arm, std::size_t tile) {
        const double k = static_cast<double>(arm.files.size());
        Values each;
        for (const auto& render : arm.tiles) each.push_back(render[tile].spread * k / (k - 1));
        return mean_interval(each, confidence);
    };
    Values p;
    for (std::size_t t = 0; t < all.tiles.count(); ++t) {
        const MeanInterval va = spreads(all.arms[a], t), vb = spreads(all.arms[b], t);
        out.log2_ratio.push_back(
            va.mean > 0 && vb.mean > 0 ? math::log(va.mean / vb.mean) / std::numbers::ln2 : std::nan(""));
        p.push_back(std::isfinite(out.log2_ratio.back()) && va.n > 2 && vb.n > 2 ? welch_test(va, vb).p : std::nan(""));
    }
    out.told_apart = discoveries(p, alpha, false);
    return out;
}

}  // namespace crescent
