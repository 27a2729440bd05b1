// About 16 blocks with up to 512 pixels each, 32 KiB for a render of any size. Products of residuals are summed over a
// block, and the sums of blocks are assumed to be independent: the test remains valid for noise that is correlated over
// a few pixels, because blocks are large in comparison. A residual of K renders is at most sqrt(K - 1) standard
// deviations, so bright events cannot decide the test. If K and L renders share m seeds, subtracting the means changes
// the covariance of the residuals of renders with a shared seed to 1 - 1/K - 1/L + m/(K L) of that of their noise, and
// that of other pairs to m/(K L) of it: less than half from K = L = 3 on.
#include "compare/shared_seeds.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/errors.h"
#include "compare/noise.h"
#include "compare/wording.h"
#include "math/simd/random.h"
#include "math/statistics.h"

namespace crescent {

namespace {

constexpr double blocks_wanted = 16;
constexpr std::size_t pixels_a_block = 512;
constexpr std::size_t blocks_least = 8;  // fewer blocks cannot reach this level

/// Adds up to pixels_a_block pixels of a block, evenly spaced.
void take_block(const RenderStats& stats, const Box& box, SeedSamples& to) {
    const std::size_t count = static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height());
    const std::size_t sample_count = std::min(count, pixels_a_block);
    for (std::size_t k = 0; k < sample_count; ++k) {
        const std::size_t index = k * count / sample_count, across = static_cast<std::size_t>(box.width());
        const auto i = (static_cast<std::size_t>(box.y0) + index / across) * static_cast<std::size_t>(stats.width) +
            static_cast<std::size_t>(box.x0) + index % across;
        if (!stats.bad[i]) to.pixels.push_back(static_cast<std::uint32_t>(i));
    }
    to.ends.push_back(to.pixels.size());
}

struct Correlation {
    double r = 0;
    bool is_significant = false;
};

/// The quantiles of Student's t for means of n values at one level; each is computed once.
class MeanLimits {
public:
    explicit MeanLimits(double level) : level_(level) {}
    double of(std::size_t n) {
        if (n >= limits_.size()) limits_.resize(n + 1, 0);
        if (limits_[n] == 0) limits_[n] = student_quantile(1 - level_, static_cast<double>(n - 1));
        return limits_[n];
    }

private:
    double level_;
    std::vector<double> limits_;  // 0: not yet known
};

/// Returns the correlation of two renders' residuals, and whether it is above 0 at the level of the limits.
Correlation correlation(
    const std::vector<float>& a, const std::vector<float>& b, const SeedSamples& samples, MeanLimits& limits) {
    std::vector<double> blocks;
    double product = 0, squares_a = 0, squares_b = 0;
    for (std::size_t block = 0, k = 0; block < samples.ends.size(); ++block) {
        double sum = 0;
        for (; k < samples.ends[block]; ++k) {
            const double x = static_cast<double>(a[k]), y = static_cast<double>(b[k]);
            sum += x * y;
            squares_a += x * x;
            squares_b += y * y;
        }
        product += sum;
        if (sum != 0) blocks.push_back(sum);
    }
    if (!(squares_a > 0) || !(squares_b > 0)) return {};
    const double r = product / std::sqrt(squares_a * squares_b);
    if (blocks.size() < blocks_least) return {r, false};
    const MeanInterval mean = mean_and_error(blocks);
    return {r, mean.mean > limits.of(blocks.size()) * mean.se};
}

using Correlations = std::vector<std::vector<double>>;  // [render of a][render of b]

/// Tests whether the renders with the same numbers in their names share seeds: by a permutation test, which is exact
/// for any noise, also in few pixels, because independent renders of one side can be exchanged. The probability of a
/// false alarm is 1/4001 + 1/K!.
bool shares_seeds(const Correlations& r, const std::vector<RenderPair>& pairs) {
    constexpr std::size_t pairs_least = 7, permutations = 4000;
    if (pairs.size() < pairs_least) return false;
    std::vector<std::size_t> order(pairs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto sum = [&] {
        double out = 0;
        for (std::size_t k = 0; k < pairs.size(); ++k) out += r[pairs[k].first][pairs[order[k]].second];
        return out;
    };
    const double stated_sum = sum();
    std::uint32_t state = 0x5eed;
    for (std::size_t n = 0; n < permutations; ++n) {
        for (std::size_t k = order.size() - 1; k > 0; --k) {  // Fisher and Yates
            state = seed_of(state, static_cast<std::uint32_t>(k));
            std::swap(order[k], order[state % (k + 1)]);
        }
        if (!std::is_sorted(order.begin(), order.end()) && sum() >= stated_sum) return false;
    }
    return true;
}

/// Returns the pairs of renders with the same numbers in their names; none unless every render has a partner.
std::vector<RenderPair> named_pairs(const ArmStats& a, const ArmStats& b) {
    try {
        return pairs_of(a, b);
    } catch (const InputError&) { return {}; }
}

/// Returns the deviations of one render of each pair from the mean of those renders, in the units of the renders, one
/// row per pair.
std::vector<std::vector<double>> deviations(const ArmStats& arm, const SeedSamples& samples,
    const std::vector<SeedPair>& pairs, std::size_t SeedPair::* render) {
    std::vector<std::vector<double>> out(pairs.size(), std::vector<double>(samples.pixels.size()));
    for (std::size_t i = 0; i < samples.pixels.size(); ++i) {
        const double sd = std::sqrt(arm.film.variance(samples.pixels[i]));
        double mean = 0;
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            out[k][i] = sd * static_cast<double>(arm.sampled[pairs[k].*render][i]);
            mean += out[k][i] / static_cast<double>(pairs.size());
        }
        for (auto& row : out) row[i] -= mean;
    }
    return out;
}

/// Estimates the correlations of the noise of pairs from deviations from the mean of the paired renders only, each
/// pixel weighted by its variance on both sides.
void estimate_correlations(
    const ArmStats& a, const ArmStats& b, const SeedSamples& samples, std::vector<SeedPair>& pairs) {
    const auto deviations_a = deviations(a, samples, pairs, &SeedPair::a),
               deviations_b = deviations(b, samples, pairs, &SeedPair::b);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        double product = 0, squares_a = 0, squares_b = 0;
        for (std::size_t i = 0; i < samples.pixels.size(); ++i) {
            const double variance = a.film.variance(samples.pixels[i]) + b.film.variance(samples.pixels[i]);
            if (!(variance > 0)) continue;
            product += deviations_a[k][i] * deviations_b[k][i] / variance;
            squares_a += deviations_a[k][i] * deviations_a[k][i] / variance;
            squares_b += deviations_b[k][i] * deviations_b[k][i] / variance;
        }
        if (squares_a > 0 && squares_b > 0) pairs[k].correlation = product / std::sqrt(squares_a * squares_b);
    }
}

}  // namespace

SeedSamples seed_samples(const RenderStats& stats) {
    const double side = std::sqrt(static_cast<double>(stats.width) * stats.height / blocks_wanted);
    const int size = std::max(2, static_cast<int>(side));
    SeedSamples out;
    for (int y = 0; y < stats.height; y += size)
        for (int x = 0; x < stats.width; x += size)
            take_block(stats, {x, y, std::min(stats.width, x + size) - 1, std::min(stats.height, y + size) - 1}, out);
    return out;
}

std::vector<float> residuals(const std::vector<float>& y, const MeanFilm& film, const SeedSamples& samples) {
    std::vector<float> out;
    for (const std::uint32_t i : samples.pixels) {
        const double variance = film.count > 1 ? film.variance(i) : 0;
        out.push_back(
            variance > 0 ? static_cast<float>((static_cast<double>(y[i]) - film.y()[i]) / std::sqrt(variance)) : 0);
    }
    return out;
}

std::vector<SeedPair> shared_seeds(const RenderStats& stats, const ArmStats& a, const ArmStats& b) {
    if (a.files.size() < 2 || b.files.size() < 2 || a.sampled.empty() || b.sampled.empty()) return {};
    const SeedSamples samples = seed_samples(stats);
    MeanLimits limits(shared_seed_level / static_cast<double>(a.files.size() * b.files.size()));
    std::vector<SeedPair> pairs;
    Correlations all_r(a.files.size(), std::vector<double>(b.files.size()));
    double largest = 0;
    for (std::size_t i = 0; i < a.files.size(); ++i)
        for (std::size_t j = 0; j < b.files.size(); ++j) {
            const Correlation c = correlation(a.sampled[i], b.sampled[j], samples, limits);
            all_r[i][j] = c.r;
            if (c.is_significant) {
                pairs.push_back({i, j, c.r});
                largest = std::max(largest, c.r);
            }
        }
    std::erase_if(pairs, [&](const SeedPair& p) { return p.correlation < largest / 2; });
    std::vector<std::size_t> partners_a(a.files.size()), partners_b(b.files.size());
    for (const SeedPair& p : pairs) {
        ++partners_a[p.a];
        ++partners_b[p.b];
    }
    std::erase_if(pairs, [&](const SeedPair& p) { return partners_a[p.a] > 1 || partners_b[p.b] > 1; });
    if (pairs.size() < std::min(a.files.size(), b.files.size()))
        if (const std::vector<RenderPair> name_pairs = named_pairs(a, b); shares_seeds(all_r, name_pairs)) {
            pairs.clear();
            for (const auto& [i, j] : name_pairs) pairs.push_back({i, j, all_r[i][j]});
        }
    if (pairs.size() > 1) estimate_correlations(a, b, samples, pairs);
    return pairs;
}

}  // namespace crescent
