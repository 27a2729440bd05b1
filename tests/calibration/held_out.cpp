// Held-out families: they are used to measure an engine, never to tune it.
#include <fmt/format.h>

#include "tests/calibration/axial.h"
#include "tests/calibration/microfacets.h"

namespace crescent::calibration {

namespace {

using Wo = Traits::WoDomain;

/// Slopes by Student's t: Ribardière, Bringier, Meneveaux and Simonot 2017, "STD: Student's t-Distribution of Slopes
/// for Microfacet Based BSDFs". P(slope) = (1 + r^2 / ((g - 1) a^2))^-g / (pi a^2), D = P / cos^4.
struct StudentSlopes {
    static constexpr auto name = "Student-t slopes", parameter = "roughness";
    static constexpr Wo wo = Wo::upper;
    static constexpr Domain domain = Domain::sphere;
    static constexpr bool halfway = true;
    double alpha, gamma;
    static StudentSlopes drawn(Rng& d) { return {d.log(0.05, 0.7), d.uniform(1.6, 6)}; }
    std::string text() const { return fmt::format("alpha {:.4g}, gamma {:.3f}", alpha, gamma); }
    StudentSlopes stretched(double by) const { return {alpha * by, gamma}; }
    template <class F> Functions<F> in(Broken) const {
        const F a = F(alpha), g = F(gamma);
        return by_normals<F>(
            [a, g](F u1, F u2) {
                const F r = a * std::sqrt((g - 1) * std::expm1(-std::log1p(-u1) / (g - 1))), phi = 2 * pi_of<F> * u2;
                return unit(Vec3<F>{r * std::cos(phi), r * std::sin(phi), 1});
            },
            [a, g](Vec3<F> m) {
                if (!(m.z > 0)) return F(0);
                const F r2 = (sqr(m.x) + sqr(m.y)) / sqr(m.z);
                return std::pow(1 + r2 / ((g - 1) * a * a), -g) / (pi_of<F> * a * a * sqr(sqr(m.z)));
            });
    }
};

/// Heitz, Dupuy, Hill and Neubelt 2016, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines".
struct TransformedCosine {
    static constexpr auto name = "linearly transformed cosine", parameter = "width";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    double xx, yy, xz, zx;  // M = [xx 0 xz; 0 yy 0; zx 0 1]
    static TransformedCosine drawn(Rng& d) {
        const double xx = d.log(0.05, 1.5), yy = d.log(0.05, 1.5), xz = d.uniform(-0.8, 0.8);
        return {xx, yy, xz, xx * d.uniform(-0.5, 0.5)};  // so that the determinant stays positive
    }
    std::string text() const { return fmt::format("{:.3f} {:.3f} {:.3f} {:.3f}", xx, yy, xz, zx); }
    TransformedCosine stretched(double by) const { return {xx * by, yy * by, xz, zx * by}; }
    template <class F> Functions<F> in(Broken) const {
        const F a = F(xx), b = F(yy), c = F(xz), e = F(zx), minor = a - c * e;  // det M = b minor
        Functions<F> out;
        out.pdf = [=](Vec3<F>, Vec3<F> w) {
            const Vec3<F> v{(w.x - c * w.z) / minor, w.y / b, (a * w.z - e * w.x) / minor};
            const F size2 = dot(v, v);
            return v.z > 0 ? v.z / (pi_of<F> * size2 * size2) / std::fabs(b * minor) : F(0);
        };
        out.sample = [=, pdf = out.pdf](Vec3<F> o, const F* u) {
            const Vec3<F> v = cosine_weighted(u[0], u[1]);
            const Vec3<F> w = unit(Vec3<F>{a * v.x + c * v.z, b * v.y, e * v.x + v.z});
            return Drawn<F>{w, pdf(o, w)};
        };
        return out;
    }
};

/// Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps".
struct SphericalCaps {
    static constexpr auto name = "GGX by spherical caps", parameter = "roughness";
    static constexpr Wo wo = Wo::upper;
    static constexpr Domain domain = Domain::sphere;
    static constexpr bool halfway = true;
    double ax, ay;
    static SphericalCaps drawn(Rng& d) { return {d.log(0.04, 1), d.log(0.04, 1)}; }
    std::string text() const { return fmt::format("alpha {:.4g} / {:.4g}", ax, ay); }
    SphericalCaps stretched(double by) const { return {ax * by, ay * by}; }
    template <class F> Functions<F> in(Broken) const {
        const Ggx2<F> g{F(ax), F(ay)};
        Functions<F> out = g.visible();
        out.sample = [g, pdf = out.pdf](Vec3<F> o, const F* u) {
            const Vec3<F> v = unit(Vec3<F>{g.ax * o.x, g.ay * o.y, o.z});
            const F z = (1 - u[1]) * (1 + v.z) - v.z, s = std::sqrt(std::clamp((1 - z) * (1 + z), F(0), F(1)));
            const Vec3<F> h = Vec3<F>{s * std::cos(2 * pi_of<F> * u[0]), s * std::sin(2 * pi_of<F> * u[0]), z} + v;
            const Vec3<F> i = reflected(o, unit(Vec3<F>{g.ax * h.x, g.ay * h.y, std::max(h.z, F(1e-6))}));
            return Drawn<F>{i, pdf(o, i)};
        };
        return out;
    }
};

/// The projected solid angle of a rectangle overhead, h^2 dA / r^4: columns of x by a table of their integrals, exact
/// within a column; y within a column by 40 bisections.
struct ProjectedRectangle {
    static constexpr auto name = "projected solid angle of a rectangle", parameter = "size";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::hemisphere;
    double x0, x1, y0, y1;  // in units of its height
    static ProjectedRectangle drawn(Rng& d) {
        const double x = d.uniform(-2, 1), y = d.uniform(-2, 1), wide = d.log(0.2, 2);
        return {x, x + wide, y, y + d.log(0.2, 2)};
    }
    std::string text() const { return fmt::format("[{:.3f}, {:.3f}] x [{:.3f}, {:.3f}]", x0, x1, y0, y1); }
    ProjectedRectangle stretched(double by) const { return {x0, x0 + (x1 - x0) * by, y0, y0 + (y1 - y0) * by}; }
    /// Integral of 1 / (c^2 + y^2)^2 up to y, c^2 = 1 + x^2.
    static double cumulative(double x, double y) {
        const double c2 = 1 + x * x, c = std::sqrt(c2);
        return (y / (c2 * (c2 + y * y)) + std::atan(y / c) / (c2 * c)) / 2;
    }
    Functions<double> exact() const {
        constexpr int n = 64;
        std::vector<double> sums = {0};
        const double width = (x1 - x0) / n;
        const ProjectedRectangle r = *this;
        const auto column = [r](double x) { return cumulative(x, r.y1) - cumulative(x, r.y0); };
        for (int k = 0; k < n; ++k) {  // Simpson's rule; any positive value gives a valid table
            const double a = x0 + k * width;
            sums.push_back(sums.back() + (column(a) + 4 * column(a + width / 2) + column(a + width)) / 6);
        }
        Functions<double> out;
        out.pdf = [=](Vec3d, Vec3d w) {
            if (!(w.z > 0)) return 0.0;
            const double x = w.x / w.z, y = w.y / w.z, e = 1e-12;
            if (x < r.x0 - e || x > r.x1 + e || y < r.y0 - e || y > r.y1 + e) return 0.0;
            const auto k = std::size_t(std::clamp(int((x - r.x0) / width), 0, n - 1));
            const double of_x = (sums[k + 1] - sums[k]) / sums.back() / width;
            const double of_y = 1 / sqr(1 + x * x + y * y) / column(x);
            return of_x * of_y / (w.z * w.z * w.z);
        };
        out.sample = [=, pdf = out.pdf](Vec3d o, const double* u) {
            const double at = u[0] * sums.back();
            const auto k = std::size_t(std::clamp<std::ptrdiff_t>(
                std::upper_bound(sums.begin(), sums.end(), at) - sums.begin() - 1, 0, n - 1));
            const double x = r.x0 + width * (double(k) + std::min((at - sums[k]) / (sums[k + 1] - sums[k]), 1.0));
            const double target = cumulative(x, r.y0) + u[1] * column(x);
            double low = r.y0, high = r.y1;
            for (int step = 0; step < 40; ++step) {
                const double middle = (low + high) / 2;
                (cumulative(x, middle) < target ? low : high) = middle;
            }
            const Vec3d w = unit(Vec3d{x, (low + high) / 2, 1});
            return Drawn<double>{w, pdf(o, w)};
        };
        return out;
    }
    template <class F> Functions<F> in(Broken) const {
        if constexpr (sizeof(F) == 8) return exact();
        else return rounded(exact());
    }
};

/// (1 + 3 a c + 5 b P2(c)) / (4 pi) about the forward direction; its cubic CDF is inverted by bisection.
struct Legendre {
    static constexpr auto name = "Legendre phase function", parameter = "both coefficients";
    static constexpr Wo wo = Wo::both;
    static constexpr Domain domain = Domain::sphere;
    double a, b;
    static Legendre drawn(Rng& d) { return {d.uniform(0.02, 0.18), d.uniform(0.01, 0.05)}; }
    std::string text() const { return fmt::format("{:.3f}, {:.3f}", a, b); }
    Legendre stretched(double by) const { return {a * by, b * by}; }
    template <class F> Functions<F> in(Broken) const {
        const F p = F(a), q = F(b);
        return single<F>(forward<F>(),
            {[p, q](F u) {
                 F low = 0, high = 2;  // of t = 1 - c; the CDF in t
                 for (int k = 0; k < (sizeof(F) == 4 ? 26 : 54); ++k) {
                     const F t = (low + high) / 2, c = 1 - t;
                     const F cumulative = t / 2 * (1 + 3 * p * (1 + c) / 2 + 5 * q * c * (1 + c) / 2);
                     (cumulative < u ? low : high) = t;
                 }
                 return (low + high) / 2;
             },
                [p, q](F t) {
                    const F c = 1 - t;
                    return (1 + 3 * p * c + 5 * q * (3 * c * c - 1) / 2) / (4 * pi_of<F>);
                }});
    }
};

/// Clarberg, Jarosz, Akenine-Möller and Jensen 2005, "Wavelet Importance Sampling": a square of 2^levels cells, warped
/// level by level and mapped to the sphere with equal area.
struct QuadTree {
    static constexpr auto name = "hierarchical warp", parameter = "power of the values";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    int levels;
    std::vector<double> value;  // of cells, row by row
    static QuadTree drawn(Rng& d) {
        QuadTree q{d.whole(2, 6), {}};
        const double contrast = d.log(2, 100);
        for (int k = 0; k < 1 << (2 * q.levels); ++k) q.value.push_back(d.log(1, contrast));
        return q;
    }
    std::string text() const { return fmt::format("{} levels", levels); }
    QuadTree stretched(double by) const {
        QuadTree q = *this;
        for (double& v : q.value) v = std::pow(v, by);
        return q;
    }
    /// Sums of each level, the coarsest (one cell) first.
    std::vector<std::vector<double>> pyramid() const {
        std::vector<std::vector<double>> all(std::size_t(levels) + 1);
        all.back() = value;
        for (int l = levels - 1; l >= 0; --l) {
            const int side = 1 << l;
            for (int k = 0; k < side * side; ++k) {
                const auto at = [&](int dy, int dx) {
                    return all[std::size_t(l) + 1][std::size_t((2 * (k / side) + dy) * 2 * side + 2 * (k % side) + dx)];
                };
                all[std::size_t(l)].push_back(at(0, 0) + at(0, 1) + at(1, 0) + at(1, 1));
            }
        }
        return all;
    }
    template <class F> Functions<F> in(Broken) const {
        const auto sums = std::make_shared<const std::vector<std::vector<double>>>(pyramid());
        const int n = 1 << levels, depth = levels;
        const double per_sr = n * n / (*sums)[0][0] / (4 * pi_of<double>);
        Functions<double> out;
        out.pdf = [=](Vec3d, Vec3d w) {
            const int i = std::clamp(int((1 - w.z) / 2 * n), 0, n - 1), j = std::clamp(int(turns_of(w) * n), 0, n - 1);
            return sums->back()[std::size_t(i * n + j)] * per_sr;
        };
        out.sample = [=, pdf = out.pdf](Vec3d o, const double* u) {
            double y = u[0], x = u[1];
            int i = 0, j = 0;
            for (int l = 1; l <= depth; ++l) {
                const auto& s = (*sums)[std::size_t(l)];
                i *= 2;
                j *= 2;
                const auto at = [&](int dy, int dx) { return s[std::size_t((i + dy) * (1 << l) + j + dx)]; };
                const double top = at(0, 0) + at(0, 1), upper = top / (top + at(1, 0) + at(1, 1));
                const int dy = y < upper ? 0 : 1;
                y = dy ? (y - upper) / (1 - upper) : y / upper;
                const double left = at(dy, 0) / (at(dy, 0) + at(dy, 1));
                const int dx = x < left ? 0 : 1;
                x = dx ? (x - left) / (1 - left) : x / left;
                i += dy;
                j += dx;
            }
            const double t = 2 * (i + y) / n, s = std::sqrt(std::max(t * (2 - t), 0.0));
            const double phi = 2 * pi_of<double> * (j + x) / n;
            const Vec3d w{s * std::cos(phi), s * std::sin(phi), 1 - t};
            return Drawn<double>{w, pdf(o, w)};
        };
        if constexpr (sizeof(F) == 8) return out;
        else return rounded(std::move(out));
    }
};

/// A normal distribution in the stereographic plane about an axis, with two widths; dA / dw = (1 + r^2 / 4)^2.
struct Stereographic {
    static constexpr auto name = "stereographic normal", parameter = "both widths";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    double sx, sy;
    Vec3d axis;
    static Stereographic drawn(Rng& d) {
        const double sx = d.log(0.02, 2), sy = d.log(0.02, 2);
        return {sx, sy, d.direction(-1, 1)};
    }
    std::string text() const { return fmt::format("widths {:.3f}, {:.3f}, axis z {:.3f}", sx, sy, axis.z); }
    Stereographic stretched(double by) const { return {sx * by, sy * by, axis}; }
    template <class F> Functions<F> in(Broken) const {
        const Frame<F> frame = frame_about(cast<F>(axis));
        const F a = F(sx), b = F(sy);
        Functions<F> out;
        out.pdf = [=](Vec3<F>, Vec3<F> world) {
            const Vec3<F> w = frame.to_local(world);
            const F k = 2 / std::max(1 + w.z, F(1e-12)), x = k * w.x, y = k * w.y;
            const F e = (sqr(x / a) + sqr(y / b)) / 2;
            return std::exp(-e) / (2 * pi_of<F> * a * b) * sqr(1 + (x * x + y * y) / 4);
        };
        out.sample = [=, pdf = out.pdf](Vec3<F> o, const F* u) {
            const F r = std::sqrt(-2 * std::log1p(-u[0])), phi = 2 * pi_of<F> * u[1];
            const F x = a * r * std::cos(phi), y = b * r * std::sin(phi), q = (x * x + y * y) / 4;
            const Vec3<F> w = frame.to_world(Vec3<F>{x / (1 + q), y / (1 + q), (1 - q) / (1 + q)});
            return Drawn<F>{w, pdf(o, w)};
        };
        return out;
    }
};

/// Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF": D = (2 + 1/a) sin^(1/a) / (2 pi).
struct Sheen {
    static constexpr auto name = "sheen by D", parameter = "roughness";
    static constexpr Wo wo = Wo::upper;
    static constexpr Domain domain = Domain::sphere;
    static constexpr bool halfway = true;
    double alpha;
    static Sheen drawn(Rng& d) { return {d.uniform(0.15, 1)}; }
    std::string text() const { return fmt::format("alpha {:.3f}", alpha); }
    Sheen stretched(double by) const { return {alpha * by}; }
    template <class F> Functions<F> in(Broken) const {
        const F k = 1 / F(alpha);
        return by_normals<F>(
            [k](F u1, F u2) {
                const F s = std::pow(u1, 1 / (2 + k)), phi = 2 * pi_of<F> * u2;
                return Vec3<F>{s * std::cos(phi), s * std::sin(phi), std::sqrt(std::max((1 - s) * (1 + s), F(0)))};
            },
            [k](Vec3<F> m) { return m.z > 0 ? (2 + k) * std::pow(std::hypot(m.x, m.y), k) / (2 * pi_of<F>) : F(0); });
    }
};

}  // namespace

std::vector<Family> held_out_families() {
    std::vector<Family> all = {family_of<StudentSlopes>(), family_of<TransformedCosine>(), family_of<SphericalCaps>(),
        family_of<ProjectedRectangle>(), family_of<Legendre>(), family_of<QuadTree>(), family_of<Stereographic>(),
        family_of<Sheen>()};
    for (Family& f : all) f.held_out = true;
    return all;
}

}  // namespace crescent::calibration
