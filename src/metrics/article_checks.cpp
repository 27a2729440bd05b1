// Tests what the article says of heavy tails: quantiles of furnaces by n and by the resolution of u, draws outside the
// Phong sampler's support, and how often a t-test rejects a correct mean. Seeds are the experiment's.
#include "metrics/article_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "base/vec.h"
#include "experiment/experiment.h"
#include "math/functions.h"
#include "math/simd/random.h"
#include "math/statistics.h"
#include "metrics/metrics.h"
#include "metrics/furnace.h"
#include "render/estimator.h"
#include "samplers/all.h"

namespace crescent {

namespace {

/// The case for the heavy tail: the control shape's material as luminances, seen from directly above.
struct FurnaceCase {
    Surface surface;
    double s = 0, rho_d = 0, rho_s = 0;
    std::uint32_t seed = 0;

    /// Returns the cosine with R for u.
    double cosine(double u) const { return math::exp(math::log(u) / (s + 1)); }
    /// Returns X of the combined furnace for u, R = n, where the angle about R does not matter: (cos/p) (rho_d/pi +
    /// rho_s lobe) with p = (s+1)/(2 pi) u/cos and lobe = (s+2)/(2 pi) u/cos.
    double weight(double u, double cos) const {
        const double diffuse = 2 * rho_d / (s + 1), lobe = rho_s * (s + 2) / (s + 1);
        return diffuse * (cos * cos / u) + lobe * cos;
    }
};

constexpr std::size_t replicates = 256;
const std::vector<std::uint64_t> furnace_sample_counts = {64, 256, 1024, 4096, 16384};

FurnaceQuantiles quantiles(std::string arithmetic, int bits, std::uint64_t n, const std::vector<double>& means) {
    return {.arithmetic = std::move(arithmetic),
        .u_bits = bits,
        .n = n,
        .q05 = quantile(means, 0.05),
        .q25 = quantile(means, 0.25),
        .median = quantile(means, 0.5),
        .q75 = quantile(means, 0.75),
        .q95 = quantile(means, 0.95)};
}

/// Calls work(points, first) for whole packs of `count` equal points, on all cores. Point i of the pack has the random
/// numbers of point first + i.
template <class Work> void for_each_pack(const Surface& surface, std::size_t count, const Work& work) {
    parallel_for(std::size_t{0}, (count + widest_pack - 1) / widest_pack, [&](std::size_t pack) {
        const std::size_t first = pack * widest_pack;
        ShadingPoints points = furnace_points(surface, std::min(widest_pack, count - first));
        for (std::uint32_t& pixel : points.pixel) pixel += static_cast<std::uint32_t>(first);
        work(std::as_const(points), first);
    });
}

void float_furnace(const FurnaceCase& adapter, const std::string& isa, ProgressMonitor& monitor, Evidence& out) {
    std::vector<std::vector<double>> means(furnace_sample_counts.size(), std::vector<double>(replicates));
    for_each_pack(adapter.surface, replicates, [&](const ShadingPoints& points, std::size_t first) {
        const std::vector<Moments> moments =
            estimate_points(points, "phong", furnace_sample_counts, adapter.seed, isa, &monitor.stop);
        for (std::size_t k = 0; k < moments.size(); ++k)
            for (std::size_t i = 0; i < points.count; ++i)
                means[k][first + i] = (adapter.rho_d / pi * moments[k].g[i] + adapter.rho_s * moments[k].g_lobe[i]) /
                    static_cast<double>(furnace_sample_counts[k]);
    });
    for (std::size_t k = 0; k < means.size(); ++k)
        out.furnace.push_back(quantiles("float32", 24, furnace_sample_counts[k], means[k]));
}

/// Resolutions of u in double precision that are compared.
constexpr std::array<int, 3> resolutions = {24, 32, 53};

/// u as an odd multiple of 2^-bits, from 64 random bits.
double unit_double(std::uint64_t h, int bits) {
    return static_cast<double>(h >> (64 - bits) | 1u) / static_cast<double>(std::uint64_t{1} << bits);
}

/// (1 + d)^k for many d. In u's last bits it needs a few terms of the series: the next one is below 1e-17.
struct PowerNear1 {
    double k, second = (k - 1) / 2, third = (k - 2) / 3, fourth = (k - 3) / 4, fifth = (k - 4) / 5;
    double operator()(double d) const {
        if (std::fabs(d) > 1e-3) return math::pow(1 + d, k);
        return 1 + k * d * (1 + second * d * (1 + third * d * (1 + fourth * d * (1 + fifth * d))));
    }
};

/// One draw of random bits and one cosine serve every resolution, because resolutions of a u differ by little.
void double_furnaces(const FurnaceCase& adapter, ProgressMonitor& monitor, Evidence& out) {
    using Means = std::vector<std::vector<double>>;  // [sample count][replicate]
    const PowerNear1 root = {1 / (adapter.s + 1)};
    std::array<Means, resolutions.size()> means;
    means.fill(Means(furnace_sample_counts.size(), std::vector<double>(replicates)));
    parallel_for(std::size_t{0}, replicates, [&](std::size_t r) {
        std::array<double, resolutions.size()> sums{};
        std::uint64_t j = 0;
        for (std::size_t sample_count = 0; sample_count < furnace_sample_counts.size() && !monitor.stop;
            ++sample_count) {
            for (; j < furnace_sample_counts[sample_count]; ++j) {
                const auto h =
                    draws<std::uint32_t>(static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(j), 0, adapter.seed);
                const std::uint64_t bits = std::uint64_t{h.x} << 32 | h.y;
                const double finest = unit_double(bits, resolutions.back()), cos = adapter.cosine(finest);
                const double inverse = 1 / finest;
                for (std::size_t i = 0; i < sums.size(); ++i) {
                    const double u = unit_double(bits, resolutions[i]);
                    sums[i] += adapter.weight(u, cos * root((u - finest) * inverse));
                }
            }
            for (std::size_t i = 0; i < sums.size(); ++i) means[i][sample_count][r] = sums[i] / static_cast<double>(j);
        }
    });
    for (std::size_t i = 0; i < resolutions.size(); ++i)
        for (std::size_t sample_count = 0; sample_count < furnace_sample_counts.size(); ++sample_count)
            out.furnace.push_back(
                quantiles("float64", resolutions[i], furnace_sample_counts[sample_count], means[i][sample_count]));
}

/// Draws with the cosine sampler and evaluates the Phong sampler's density: where it is 0, Lambert's light is lost.
LostSupport lost_support(const FurnaceCase& adapter, double theta_deg) {
    constexpr std::uint64_t n = 100'000;
    const double theta = theta_deg * pi / 180;
    ShadingPoint<double> shading_point{};
    shading_point.wo = {math::sin(theta), 0, math::cos(theta)};
    shading_point.s = adapter.s;
    const Cosine<double> cosine(shading_point);
    const Vec3<double> R = mirror(shading_point.wo);
    std::uint64_t lost = 0;
    for (std::uint64_t j = 0; j < n; ++j) {
        const Vec2<float> u = draw(adapter.seed, 0, j);
        const Vec3<double> wi =
            cosine.sample(shading_point.wo, {static_cast<double>(u.x), static_cast<double>(u.y)}).wi;
        lost += dot(wi, R) <= 0;  // the support of the Phong pdf, for any value of its power
    }
    const double p = static_cast<double>(lost) / static_cast<double>(n);
    return {.theta_R_deg = theta_deg,
        .measured = p,
        .se = std::sqrt(p * (1 - p) / static_cast<double>(n)),
        .theory = (1 - math::cos(theta)) / 2};
}

/// Repeats a t-test of the Phong sampler on a Lambert surface against the known mean.
FalseRejection false_rejection(
    const FurnaceCase& adapter, double s, double alpha, const std::string& isa, ProgressMonitor& monitor) {
    constexpr std::uint64_t n = 100'000;
    constexpr int runs = 128;
    Surface lambert = adapter.surface;
    lambert.rho_d = {1, 1, 1};
    lambert.rho_s = 0;
    lambert.s = s;
    FalseRejection out{.s = s, .k = (s - 1) / (s + 1), .n = n, .runs = runs, .rejected = 0, .low = 0, .high = 0};
    std::vector<int> rejected(runs);
    const double bound = student_two_sided_quantile(static_cast<double>(n - 1), alpha);
    for_each_pack(lambert, runs, [&](const ShadingPoints& points, std::size_t first) {
        const Moments m = estimate_points(points, "phong", n, adapter.seed, isa, &monitor.stop);
        for (std::size_t i = 0; i < points.count; ++i) {
            const double mean = m.g[i] / pi / static_cast<double>(n), deviation = mean - 1;
            const double se = std::sqrt(m.spread[i] / static_cast<double>(n) / static_cast<double>(n - 1));
            rejected[first + i] = std::fabs(deviation) > bound * se;
        }
    });
    for (int r : rejected) out.rejected += r;
    const ShareInterval rate = binomial_interval(runs, out.rejected, 0.025);
    out.low = rate.low;
    out.high = rate.high;
    return out;
}

}  // namespace

Evidence measure_evidence(const Experiment& experiment, const std::string& isa, ProgressMonitor& monitor) {
    Evidence out;
    if (!experiment.note_evidence || !why_no_evidence(experiment).empty()) return out;
    FurnaceCase adapter;
    adapter.surface = furnace_surface(experiment, evidence_shape(experiment)->material, false);
    adapter.s = out.s = adapter.surface.s;
    adapter.rho_d = out.rho_d = luminance(adapter.surface.rho_d);
    adapter.rho_s = out.rho_s = adapter.surface.rho_s;
    adapter.seed = experiment.seed;
    out.expected = out.rho_d + out.rho_s;
    float_furnace(adapter, isa, monitor, out);
    double_furnaces(adapter, monitor, out);
    for (int bits : resolutions) {
        const double k = (adapter.s - 1) / (adapter.s + 1);
        out.caps.push_back({bits, out.rho_s + out.rho_d * (1 - math::exp2(-bits * (1 - k)))});
    }
    out.lost.resize(11);  // from 0 to 75 degrees
    parallel_for(std::size_t{0}, out.lost.size(),
        [&](std::size_t k) { out.lost[k] = lost_support(adapter, 7.5 * static_cast<double>(k)); });
    constexpr std::array exponents = {2.0, 3.0, 8.0, 32.0, 128.0};
    out.rejections.resize(exponents.size());
    parallel_for(std::size_t{0}, exponents.size(),
        [&](std::size_t k) { out.rejections[k] = false_rejection(adapter, exponents[k], out.alpha, isa, monitor); });
    monitor.check();
    return out;
}

}  // namespace crescent
