// All n draws of a site are fetched, then handed one after another to the scalar kernel as if an arm had drawn them. A
// draw is usable where its pdf is above 0 and |w_i|^2 is 1 to 2e-4; what is not becomes a NaN pdf, which kernels count
// as bad.
#include "estimator/outside.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#define CRESCENT_ISA scalar
#include "estimator/kernel_body.h"

namespace crescent::inline estimator {

namespace {

constexpr std::uint64_t longest_batch = 65536;

/// The arm of the kernels: hands out what was drawn, sample after sample.
template <class F> struct Prefetched {
    mutable const Drawn<F>* next;
    explicit Prefetched(const Drawn<F>* first) : next(first) {}
    Drawn<F> sample(Vec3<F> /*wo*/, Vec2<F> /*u*/) const { return *next++; }
};

Drawn<float> usable(const OutsideDraw& d) {
    if (d.pdf == 0) return {{0, 0, 1}, {0}};
    const double length2 = d.wi.x * d.wi.x + d.wi.y * d.wi.y + d.wi.z * d.wi.z;
    const bool good = std::fabs(length2 - 1) <= 2e-4 && d.pdf > 0;
    const float pdf = good ? static_cast<float>(d.pdf) : std::numeric_limits<float>::quiet_NaN();
    if (!good) return {{0, 0, 1}, {pdf}};
    return {{static_cast<float>(d.wi.x), static_cast<float>(d.wi.y), static_cast<float>(d.wi.z)}, {pdf}};
}

/// The random numbers of `n` samples of a pixel from `first` on, `count` a sample: the first two are those of every
/// arm, the rest come from blocks that no arm uses.
void numbers_of(std::uint32_t pixel, std::uint32_t seed, std::uint64_t first, std::uint64_t n, std::size_t count,
    std::vector<double>& u) {
    u.resize(n * count);
    for (std::uint64_t j = 0; j < n; ++j)
        for (std::size_t k = 0; k < count; k += 2) {
            const auto block = static_cast<std::uint32_t>(k == 0 ? 0 : k / 2 + 1);
            const Vec2<float> pair = crescent::draw(seed, pixel, first + j, block);
            u[j * count + k] = static_cast<double>(pair.x);
            if (k + 1 < count) u[j * count + k + 1] = static_cast<double>(pair.y);
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
    std::vector<double> u;
    std::vector<OutsideDraw> answers;
    std::vector<Drawn<float>> drawn(n);
    for (std::size_t i = 0; i < sites.count; ++i) {
        const Vec3<double> wo{double(sites.wox[i]), double(sites.woy[i]), double(sites.woz[i])};
        const OutsideSurface surface{
            double(sites.s[i]), double(sites.alpha[i]), double(sites.diffuse[i]), sites.rho_s_exact[i]};
        for (std::uint64_t first = 0; first < n; first += longest_batch) {
            if (call.stop && call.stop->load(std::memory_order_relaxed)) return;
            const std::uint64_t count = std::min(longest_batch, n - first);
            numbers_of(sites.pixel[i], call.seed, first, count, numbers, u);
            answers.resize(count);
            sampler.draw({wo, surface, u}, answers);
            std::ranges::transform(answers, drawn.begin() + static_cast<std::ptrdiff_t>(first), usable);
        }
        kernel(call, i, drawn.data());
    }
}

}  // namespace crescent::inline estimator
