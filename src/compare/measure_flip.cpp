// FLIP of each arm's first render beside the reference: of radiance (HDR), and of the two photographs (LDR).
#include <array>

#include "compare/flip.h"
#include "compare/judge.h"
#include "color/tone.h"

namespace crescent::inline comparing {

namespace {

double mean_over(const std::vector<float>& map, const PixelSet& set) {
    double sum = 0;
    for (const std::uint32_t i : set.pixels) sum += static_cast<double>(map[i]);
    return sum / static_cast<double>(set.pixels.size());
}

/// Display-ready linear channels of a photograph, as plates show it, for LDR-FLIP.
std::array<std::vector<float>, 3> photograph(
    std::span<const float> r, std::span<const float> g, std::span<const float> b, double exposure) {
    std::array<std::vector<float>, 3> out;
    for (auto& plane : out) plane.resize(r.size());
    for (std::size_t i = 0; i < r.size(); ++i) {
        const auto shown = [&](float x) { return std::max(0.0, exposure * static_cast<double>(x)); };
        const Rgb rgb = neutral({shown(r[i]), shown(g[i]), shown(b[i])});
        for (std::size_t c = 0; c < 3; ++c) out[c][i] = static_cast<float>(rgb[c]);
    }
    return out;
}

/// FLIP filters: a value that is not finite would spread to its neighbours.
void blacken(Render& image, const std::vector<bool>& bad) {
    for (std::size_t i = 0; i < bad.size(); ++i)
        if (bad[i]) image.r[i] = image.g[i] = image.b[i] = 0;
}

}  // namespace

std::vector<Flips> measure_flip(const ComparePlan& plan, const Readings& all, std::size_t a, ProgressMonitor& monitor) {
    std::vector<Flips> out(all.regions.size());
    if (!all.reference || !plan.flip) return out;
    monitor.begin("FLIP", 1);
    Render ref = in_rec709(all, all.reference->film);
    Render test = in_rec709(all, all.source.read(all.arms[a].files[0].path, plan.arms[a].layer));
    for (Render* image : {&test, &ref}) blacken(*image, all.bad);
    const std::vector<float> hdr = hdr_flip({all.width, all.height, ref.r, ref.g, ref.b},
        {all.width, all.height, test.r, test.g, test.b}, plan.pixels_per_degree);
    const auto seen = photograph(test.r, test.g, test.b, plan.exposure),
               wanted = photograph(ref.r, ref.g, ref.b, plan.exposure);
    const std::vector<float> ldr = ldr_flip({all.width, all.height, wanted[0], wanted[1], wanted[2]},
        {all.width, all.height, seen[0], seen[1], seen[2]}, plan.pixels_per_degree);
    for (std::size_t r = 0; r < all.regions.size(); ++r)
        out[r] = {mean_over(hdr, all.regions[r]), mean_over(ldr, all.regions[r])};
    monitor.advance(1);
    return out;
}

}  // namespace crescent::inline comparing
