// The draws of many sites are fetched in one batch, and then handed one after another to the scalar kernel as if an arm
// had drawn them. A draw that cannot be used becomes a NaN pdf, which kernels count as bad.
#include "estimator/outside.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#define CRESCENT_ISA scalar
#include "estimator/kernel_body.h"

namespace crescent::inline estimator {

namespace {

/// Rows that are fetched at once, which stay in a core's cache; a site of more samples is fetched in parts. The same
/// for any number of threads.
constexpr std::uint64_t longest_batch = 8192;

/// The arm of the kernels: hands out what was drawn, sample after sample.
template <class F> struct Prefetched {
    mutable const Drawn<F>* next;
    explicit Prefetched(const Drawn<F>* first) : next(first) {}
    Drawn<F> sample(Vec3<F> /*wo*/, Vec2<F> /*u*/) const { return *next++; }
};

/// Usable are a direction of unit length to 1e-4 and a pdf that is above 0 and finite also in single precision, in
/// which the estimate is made. pdf 0: nothing was drawn.
Drawn<float> usable(const Vec3<double>& wi, double p) {
    if (p == 0) return {{0, 0, 1}, {0}};
    const double length2 = wi.x * wi.x + wi.y * wi.y + wi.z * wi.z;
    const auto pdf = static_cast<float>(p);
    const bool good = std::fabs(length2 - 1) <= 2e-4 && pdf > 0 && pdf <= std::numeric_limits<float>::max();
    if (!good) return {{0, 0, 1}, {std::numeric_limits<float>::quiet_NaN()}};
    return {{static_cast<float>(wi.x), static_cast<float>(wi.y), static_cast<float>(wi.z)}, {pdf}};
}

/// Appends the random numbers of `n` samples of a pixel from `first` on, `count` a sample: the first two are those of
/// every arm, the rest come from blocks that no arm uses.
void add_numbers(std::uint32_t pixel, std::uint32_t seed, std::uint64_t first, std::uint64_t n, std::size_t count,
    std::vector<double>& u) {
    const std::size_t from = u.size();
    u.resize(from + n * count);
    for (std::size_t k = 0; k < count; k += 2) {
        const auto block = static_cast<std::uint32_t>(k == 0 ? 0 : k / 2 + 1);
        double* row = &u[from + k];
        const auto put = [&](std::uint32_t x, std::uint32_t y) {
            row[0] = static_cast<double>(unit_float<float>(x));
            if (k + 1 < count) row[1] = static_cast<double>(unit_float<float>(y));
            row += count;
        };
        for (std::uint64_t j = first; j < first + n;) {  // as crescent::draw(), two samples from one hash
            const auto h = draws<std::uint32_t>(pixel, static_cast<std::uint32_t>(j >> 1), block, seed);
            if (!(j & 1)) put(h.x, h.y), ++j;
            if (j < first + n) put(h.z, h.w), ++j;
        }
    }
}

using SiteKernel = void (*)(const KernelCall&, std::size_t at, const Drawn<float>* drawn);

template <class L> void estimate_site(const KernelCall& call, std::size_t at, const Drawn<float>* drawn) {
    scalar::LightRoom<float> room(*call.sites, call.memory);
    scalar::estimate_pack<Prefetched<float>, L, scalar::Lights<float>, float>(
        call, at, room, [&](const ShadingPoint<float>&) { return Prefetched<float>(drawn); });
}

/// [lobe + 1]
template <template <class> class... L> constexpr std::array<SiteKernel, sizeof...(L) + 1> kernels_on(LobeList<L...>) {
    return {estimate_site<NoLobe<float>>, estimate_site<L<float>>...};
}

}  // namespace

void estimate_outside(const OutsideSampler& sampler, const KernelCall& call) {
    const ShadingPoints& sites = *call.sites;
    const std::uint64_t n = call.rungs.back();
    const auto numbers = static_cast<std::size_t>(sampler.numbers());
    const SiteKernel kernel = kernels_on(Lobes{})[static_cast<std::size_t>(sites.lobe + 1)];
    const std::uint64_t sites_a_batch = std::max<std::uint64_t>(1, longest_batch / n);
    std::vector<OutsideRun> runs;
    std::vector<double> u, pdf;
    std::vector<Vec3<double>> wi;
    std::vector<Drawn<float>> drawn;
    for (std::size_t i = 0; i < sites.count; i += sites_a_batch) {
        const std::size_t end = std::min<std::size_t>(sites.count, i + sites_a_batch);
        drawn.clear();
        for (std::uint64_t first = 0; first < n; first += longest_batch) {
            if (call.stop && call.stop->load(std::memory_order_relaxed)) return;
            const std::uint64_t count = std::min(longest_batch, n - first);
            runs.clear(), u.clear();
            for (std::size_t at = i; at < end; ++at) {
                const Vec3<double> wo{double(sites.wox[at]), double(sites.woy[at]), double(sites.woz[at])};
                runs.push_back({wo,
                    {double(sites.s[at]), double(sites.alpha[at]), double(sites.diffuse[at]), sites.rho_s_exact[at]},
                    static_cast<std::size_t>(count)});
                add_numbers(sites.pixel[at], call.seed, first, count, numbers, u);
            }
            wi.resize(runs.size() * count), pdf.resize(wi.size());
            sampler.draw({runs, u}, {wi, pdf});
            for (std::size_t k = 0; k < wi.size(); ++k) drawn.push_back(usable(wi[k], pdf[k]));
        }
        for (std::size_t at = i; at < end; ++at) kernel(call, at, drawn.data() + (at - i) * n);
    }
}

}  // namespace crescent::inline estimator
