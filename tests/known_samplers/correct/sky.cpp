// Skies: an environment light's texels, drawn by the sums of rows and columns (Pharr & Humphreys 2004) or by an alias
// table (Vose 1991, "A Linear Algorithm for Generating Random Numbers with a Given Distribution"), a texel uniform in
// theta and phi. They have no w_o.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "math/simd/scalar.h"
#include "tests/known_samplers/correct/renderers.h"

namespace crescent {

double turns_of(Vec3d w) {
    const double t = math::atan2(w.y, w.x) / (2 * pi);
    return t < 0 ? t + 1 : t;
}

namespace {

double theta_of(Vec3d w) { return math::atan2(math::hypot(w.x, w.y), w.z); }

std::pair<int, double> find(const double* sum, int count, double u) {
    u *= sum[count];
    const int k =
        static_cast<int>(std::clamp<std::ptrdiff_t>(std::upper_bound(sum, sum + count + 1, u) - sum - 1, 0, count - 1));
    return {k, std::clamp((u - sum[k]) / (sum[k + 1] - sum[k]), 0.0, 1 - 0x1p-53)};
}

void fill_alias(Sky& s) {
    const std::size_t n = s.mass.size();
    s.keep.assign(n, 1.0);
    s.other.assign(n, 0);
    std::vector<double> scaled;
    std::vector<std::size_t> low, high;
    for (std::size_t i = 0; i < n; ++i) {
        scaled.push_back(s.mass[i] * static_cast<double>(n));
        (scaled[i] < 1 ? low : high).push_back(i);
    }
    while (!low.empty() && !high.empty()) {
        const std::size_t l = low.back(), h = high.back();
        low.pop_back();
        s.keep[l] = scaled[l];
        s.other[l] = static_cast<int>(h);
        scaled[h] -= 1 - scaled[l];
        if (scaled[h] < 1) {
            high.pop_back();
            low.push_back(h);
        }
    }
}

}  // namespace

Sky::Sky(int m, int n, std::vector<double> radiance, bool alias)
    : rows(m), columns(n), mass(std::move(radiance)), by_alias(alias), row_sums{0} {
    double all = 0;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j)
            all += mass[static_cast<std::size_t>(i * columns + j)] *= math::sin(pi * (i + 0.5) / rows);
    for (double& v : mass) v /= all;
    for (int i = 0; i < rows; ++i) {
        sums.push_back(0);
        for (int j = 0; j < columns; ++j) sums.push_back(sums.back() + mass[static_cast<std::size_t>(i * columns + j)]);
        row_sums.push_back(row_sums.back() + sums.back());
    }
    if (by_alias) fill_alias(*this);
}

Sky::Spot Sky::spot(Vec2d u) const {
    if (!by_alias) {
        const auto [i, x] = find(row_sums.data(), rows, u.x);
        const auto [j, y] = find(sums.data() + static_cast<std::size_t>(i * (columns + 1)), columns, u.y);
        return {i, j, x, y};
    }
    const double cell = u.x * static_cast<double>(mass.size());
    std::size_t k = std::min(static_cast<std::size_t>(cell), mass.size() - 1);
    double v = cell - static_cast<double>(k);
    if (v < keep[k]) v /= keep[k];
    else {
        v = (v - keep[k]) / (1 - keep[k]);
        k = static_cast<std::size_t>(other[k]);
    }
    return {static_cast<int>(k) / columns, static_cast<int>(k) % columns, std::clamp(v, 0.0, 1 - 0x1p-53), u.y};
}

Draw Sky::at(const Spot& s) const {
    const double theta = pi * (s.i + s.x) / rows, phi = 2 * pi * (s.j + s.y) / columns, sin = math::sin(theta);
    if (!(sin > 0)) return {{0, 0, 1}, 0};  // a pole, where p is unbounded
    return {math::spherical(sin, math::cos(theta), phi),
        mass[static_cast<std::size_t>(s.i * columns + s.j)] * rows * columns / (2 * pi * pi * sin)};
}

Draw Sky::sample(const PrimarySample& u) const { return at(spot(u)); }

double Sky::pdf(Vec3d w) const {
    const double sin = math::hypot(w.x, w.y);
    if (!(sin > 0)) return 0;
    const int i = std::clamp(static_cast<int>(theta_of(w) / pi * rows), 0, rows - 1),
              j = std::clamp(static_cast<int>(turns_of(w) * columns), 0, columns - 1);
    return mass[static_cast<std::size_t>(i * columns + j)] * rows * columns / (2 * pi * pi * sin);
}

SyntheticSampler recipe_of(std::shared_ptr<const Sky> sky) {
    SyntheticSampler r{sky->by_alias ? "sky by alias table" : "sky by CDF",
        fmt::format("{} x {}", sky->columns, sky->rows), {}, {}, {}};
    r.traits.wo = Traits::WoDomain::none;
    r.sample = [sky](Vec3d, const PrimarySample& u) { return sky->sample(u); };
    r.pdf = [sky](Vec3d, Vec3d wi) { return sky->pdf(wi); };
    return r;
}

std::shared_ptr<const Sky> sky_with_sun(Rng& d, int rows, int columns, double sun, bool by_alias) {
    std::vector<double> radiance;
    for (int k = 0; k < rows * columns; ++k) radiance.push_back(d.log(0.3, 3));
    const int i = d.whole(0, rows - 1), j = d.whole(0, columns - 1);
    for (int k = 0; sun > 0 && k < 4; ++k)
        radiance[static_cast<std::size_t>(std::min(i + k / 2, rows - 1) * columns + (j + k % 2) % columns)] =
            sun * rows * columns;
    return std::make_shared<Sky>(rows, columns, std::move(radiance), by_alias);
}

namespace {

SyntheticSampler glass(Rng& d) {
    return recipe_of(RoughGlass{
        d.log(0.05, 0.6), d.whole(0, 1) ? d.uniform(1.1, 2) : 1 / d.uniform(1.1, 2), false, d.whole(0, 1) == 1});
}
SyntheticSampler glass_visible(Rng& d) {
    return recipe_of(RoughGlass{
        d.log(0.03, 0.8), d.whole(0, 1) ? d.uniform(1.1, 2) : 1 / d.uniform(1.1, 2), true, d.whole(0, 1) == 1});
}
SyntheticSampler still_glass(Rng& d) { return smooth_glass(d.uniform(1.1, 2)); }
SyntheticSampler coat(Rng& d) {
    return recipe_of(
        SmoothCoat{d.uniform(0.05, 0.6), d.uniform(0.1, 0.9), {d.uniform(0, 1), d.uniform(0, 1), d.uniform(0, 1)}});
}
SyntheticSampler layers(Rng& d) {
    return recipe_of(
        Layers{d.log(0.05, 0.7), d.uniform(0.2, 0.8), {d.uniform(0, 0.9), d.uniform(0, 0.9), d.uniform(0, 0.9)},
            {d.uniform(0.02, 0.1), d.uniform(0.02, 0.1), d.uniform(0.02, 0.1)}});
}
SyntheticSampler sky(Rng& d) {
    const int rows = d.whole(4, 64);
    return recipe_of(sky_with_sun(d, rows, 2 * rows, d.whole(0, 1), false));
}
SyntheticSampler sky_alias(Rng& d) {
    const int rows = d.whole(4, 64);
    return recipe_of(sky_with_sun(d, rows, 2 * rows, d.whole(0, 1), true));
}

}  // namespace

std::vector<SamplerFamily> renderer_families() {
    return {glass, glass_visible, still_glass, coat, layers, sky, sky_alias};
}

}  // namespace crescent
