// A sky as renderers interpolate it: p bilinear between points of a map in theta and phi, drawn by hierarchical warping
// (Clarberg, Jarosz, Akenine-Moller & Jensen 2005, "Wavelet Importance Sampling") down to a cell and then by the
// inverse of its two linear densities, all in single precision. If a cell's sides are nearly equal, that inverse is a
// difference of nearly equal numbers and loses most of its digits; across a cell's edge the warp has a kink. The
// sampler is correct.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "math/simd/scalar.h"
#include "tests/known_samplers/correct/renderers.h"

namespace crescent {

namespace {

struct SmoothSky {
    int cells;                               // per direction, a power of two; points are one more
    std::vector<float> points;               // by row; p in the unit square
    std::vector<std::vector<float>> levels;  // masses of cells, of four cells, of sixteen, ...

    SmoothSky(int n, std::vector<float> values) : cells(n), points(std::move(values)) {
        std::vector<float> mass;
        double all = 0;
        for (int i = 0; i < cells; ++i)
            for (int j = 0; j < cells; ++j) {
                mass.push_back(0.25f * (at(i, j) + at(i + 1, j) + at(i, j + 1) + at(i + 1, j + 1)));
                all += static_cast<double>(mass.back());
            }
        const auto each = static_cast<float>(cells * cells / all);
        for (float& v : points) v *= each;
        levels.push_back(std::move(mass));
        for (int k = 1; cells >> k > 0; ++k) {
            std::vector<float> sums;
            for (int i = 0; i < cells >> k; ++i)
                for (int j = 0; j < cells >> k; ++j)
                    sums.push_back(below(k, 2 * i, 2 * j) + below(k, 2 * i, 2 * j + 1) + below(k, 2 * i + 1, 2 * j) +
                        below(k, 2 * i + 1, 2 * j + 1));
            levels.push_back(std::move(sums));
        }
    }
    float at(int i, int j) const { return points[static_cast<std::size_t>(i * (cells + 1) + j)]; }
    /// Returns the mass of a cell one level finer than k.
    float below(int k, int i, int j) const {
        return levels[static_cast<std::size_t>(k) - 1][static_cast<std::size_t>(i * (cells >> (k - 1)) + j)];
    }

    /// Returns true for the second of two; u is stretched for reuse.
    static bool second(float& u, float first, float other) {
        u *= first + other;
        if (u < first) return u /= first, false;
        return u = std::min((u - first) / other, 0x1.fffffep-1f), true;
    }
    /// Inverts a density that is linear from a to b.
    static float linear(float a, float b, float u) {
        if (!(std::fabs(a - b) > 1e-4f * (a + b))) return u;
        return (a - std::sqrt(a * a + u * (b * b - a * a))) / (a - b);
    }
    static float between(float a, float b, float t) { return a + t * (b - a); }

    Vec2<float> place(float u, float v) const {  // u: along a row; v: down the rows
        int i = 0, j = 0;
        for (int k = static_cast<int>(levels.size()) - 1; k > 0; --k) {
            i *= 2;
            j *= 2;
            const float a = below(k, i, j), b = below(k, i, j + 1), c = below(k, i + 1, j), d = below(k, i + 1, j + 1);
            if (second(v, a + b, c + d)) {
                j += second(u, c, d);
                ++i;
            } else j += second(u, a, b);
        }
        const float y = linear(at(i, j) + at(i, j + 1), at(i + 1, j) + at(i + 1, j + 1), v);
        const float x = linear(between(at(i, j), at(i + 1, j), y), between(at(i, j + 1), at(i + 1, j + 1), y), u);
        return {(static_cast<float>(j) + x) / static_cast<float>(cells),
            (static_cast<float>(i) + y) / static_cast<float>(cells)};
    }
    /// 1/sr at a place of the map.
    double density(Vec2<float> map) const {
        const float x = map.x * static_cast<float>(cells), y = map.y * static_cast<float>(cells);
        const int j = std::clamp(static_cast<int>(x), 0, cells - 1), i = std::clamp(static_cast<int>(y), 0, cells - 1);
        const float s = x - static_cast<float>(j), t = y - static_cast<float>(i);
        const float p = between(between(at(i, j), at(i, j + 1), s), between(at(i + 1, j), at(i + 1, j + 1), s), t);
        const double sin = math::sin(pi * static_cast<double>(map.y));
        return sin > 0 ? static_cast<double>(p) / (2 * pi * pi * sin) : 0;
    }
    Draw sample(const PrimarySample& u) const {
        const Vec2<float> map = place(static_cast<float>(u.x), static_cast<float>(u.y));
        const double theta = pi * static_cast<double>(map.y), phi = 2 * pi * static_cast<double>(map.x);
        const auto single = [](double v) { return static_cast<double>(static_cast<float>(v)); };
        const double sin = math::sin(theta);
        return {{single(sin * math::cos(phi)), single(sin * math::sin(phi)), single(math::cos(theta))}, density(map)};
    }
    double pdf(Vec3d w) const {
        const double turns = math::atan2(w.y, w.x) / (2 * pi), theta = math::atan2(math::hypot(w.x, w.y), w.z);
        return density({static_cast<float>(turns < 0 ? turns + 1 : turns), static_cast<float>(theta / pi)});
    }
};

}  // namespace

SyntheticSampler smooth_sky(int cells, double sun) {
    std::vector<float> values;
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j <= cells; ++j) {  // the last column is the first
            const double y = (i - 0.3 * cells) / 2, x = (j % cells - 0.3 * cells) / 2;
            values.push_back(
                static_cast<float>((1 + sun * math::exp(-(x * x + y * y))) * (math::sin(pi * i / cells) + 1e-3)));
        }
    const auto sky = std::make_shared<const SmoothSky>(cells, std::move(values));
    SyntheticSampler r{
        "smooth sky in single precision", fmt::format("{} x {}, sun {:g}", cells, cells, sun), {}, {}, {}};
    r.traits.wo = Traits::WoDomain::none;
    r.sample = [sky](Vec3d, const PrimarySample& u) { return sky->sample(u); };
    r.pdf = [sky](Vec3d, Vec3d wi) { return sky->pdf(wi); };
    return r;
}

}  // namespace crescent
