// Skies by texels, portals, textured disk lights, and the tables of tests/known_samplers/correct.
#include <fmt/format.h>

#include "tests/calibration/skies.h"

namespace crescent::calibration {

namespace {

using Wo = Traits::WoDomain;
constexpr Broken of_tables[] = {Broken::transposed_table, Broken::shifted_table, Broken::mirrored_table};

/// Radiance of a sky: noise over a smooth gradient, and sometimes a sun of one to four texels.
struct Radiance {
    int rows, columns;
    std::vector<double> value;
    double sun;
    static Radiance drawn(Rng& d) {
        Radiance r;
        r.rows = d.whole(8, 96);
        r.columns = 2 * r.rows;
        const double noise = d.log(1.05, 8), gradient = d.uniform(0, 2), phase = d.uniform(0, 1);
        for (int i = 0; i < r.rows; ++i)
            for (int j = 0; j < r.columns; ++j)
                r.value.push_back(d.log(1, noise) *
                    (1.2 + gradient * (1 - double(i) / r.rows) +
                        std::sin(2 * pi_of<double> * (double(j) / r.columns + phase))));
        r.sun = d.whole(0, 1) ? d.uniform(0.05, 0.9) : 0;
        double all = 0;
        for (double v : r.value) all += v;
        const int i = d.whole(r.rows / 8, 7 * r.rows / 8), j = d.whole(0, r.columns - 1), texels = d.whole(1, 4);
        for (int k = 0; r.sun > 0 && k < texels; ++k)
            r.value[std::size_t((i + k / 2) * r.columns + (j + k % 2) % r.columns)] =
                all * r.sun / (1 - r.sun) / texels;
        return r;
    }
    std::string text() const { return fmt::format("{} x {}, sun {:.2f}", columns, rows, sun); }
    Radiance stretched(double by) const {
        Radiance r = *this;
        for (double& v : r.value) v = std::pow(v, by);
        return r;
    }
};

struct SkyByCdf {
    static constexpr auto name = "sky by rows and columns", parameter = "power of the radiance";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    static constexpr const auto& breaks = of_tables;
    Radiance sky;
    static SkyByCdf drawn(Rng& d) { return {Radiance::drawn(d)}; }
    std::string text() const { return sky.text(); }
    SkyByCdf stretched(double by) const { return {sky.stretched(by)}; }
    template <class F> Functions<F> in(Broken b) const { return sky_by_cdf<F>(sky.rows, sky.columns, sky.value, b); }
};

/// u[2] selects a texel, u[3] decides whether it is kept.
struct SkyByAlias {
    static constexpr auto name = "sky by alias table", parameter = "power of the radiance";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    static constexpr int numbers = 4;
    static constexpr const auto& breaks = of_tables;
    Radiance sky;
    static SkyByAlias drawn(Rng& d) { return {Radiance::drawn(d)}; }
    std::string text() const { return sky.text(); }
    SkyByAlias stretched(double by) const { return {sky.stretched(by)}; }
    template <class F> Functions<F> in(Broken b) const { return sky_by_alias<F>(sky.rows, sky.columns, sky.value, b); }
};

/// Bitterli, Novák and Jarosz 2015, "Portal-Masked Environment Map Sampling": uniform in the two angles of a window;
/// d(alpha) d(beta) / dw = w_z / ((1 - w_x^2) (1 - w_y^2)).
struct Portal {
    static constexpr auto name = "portal", parameter = "width in both angles";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    double a, b, da, db;
    Vec3d normal;
    static Portal drawn(Rng& d) {
        const double a = d.uniform(-1.2, 0.6), b = d.uniform(-1.2, 0.6), da = d.uniform(0.1, 0.7);
        const double db = d.uniform(0.1, 0.7);
        return {a, b, da, db, d.direction(-1, 1)};
    }
    std::string text() const { return fmt::format("angles {:.3f} + {:.3f}, {:.3f} + {:.3f}", a, da, b, db); }
    Portal stretched(double by) const { return {a, b, std::min(da * by, 1.5 - a), std::min(db * by, 1.5 - b), normal}; }
    template <class F> Functions<F> in(Broken) const {
        const Frame<F> frame = frame_about(cast<F>(normal));
        const F a0 = F(a), b0 = F(b), wa = F(da), wb = F(db), e = 3 * slack<F>;
        Functions<F> out;
        out.pdf = [=](Vec3<F>, Vec3<F> world) {
            const Vec3<F> w = frame.to_local(world);
            if (!(w.z > 0)) return F(0);
            const F alpha = std::atan2(w.x, w.z), beta = std::atan2(w.y, w.z);
            if (alpha < a0 - e || alpha > a0 + wa + e || beta < b0 - e || beta > b0 + wb + e) return F(0);
            return w.z / ((1 - sqr(w.x)) * (1 - sqr(w.y))) / (wa * wb);
        };
        out.sample = [=, pdf = out.pdf](Vec3<F> o, const F* u) {
            const Vec3<F> w = unit(Vec3<F>{std::tan(a0 + wa * u[0]), std::tan(b0 + wb * u[1]), 1});
            const Vec3<F> world = frame.to_world(w);
            return Drawn<F>{world, pdf(o, world)};
        };
        return out;
    }
};

/// A disk of texels overhead: selects a texel by its radiance, and a place in it; places outside the disk give no
/// sample.
struct TexturedDisk {
    static constexpr auto name = "textured disk", parameter = "power of the radiance";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::hemisphere;
    static constexpr int numbers = 3;
    static constexpr Broken breaks[] = {Broken::transposed_table, Broken::mirrored_table};
    static constexpr bool reciprocal = false;  // f is the light's shape
    int side;
    double height;
    std::vector<double> value;
    static TexturedDisk drawn(Rng& d) {
        TexturedDisk t{d.whole(4, 32), d.log(0.3, 4), {}};
        const double contrast = d.log(2, 50);
        for (int k = 0; k < sqr(t.side); ++k) t.value.push_back(d.log(1, contrast));
        return t;
    }
    std::string text() const { return fmt::format("{0} x {0} texels, height {1:.3f}", side, height); }
    TexturedDisk stretched(double by) const {
        TexturedDisk t = *this;
        for (double& v : t.value) v = std::pow(v, by);
        return t;
    }
    template <class F> Functions<F> in(Broken broken) const {
        std::vector<double> sums = {0};
        for (double v : value) sums.push_back(sums.back() + v);
        std::vector<F> cumulative, mass;
        for (std::size_t k = 0; k < sums.size(); ++k) cumulative.push_back(F(sums[k] / sums.back()));
        for (double v : value) mass.push_back(F(v / sums.back()));
        const int n = side;
        const F h = F(height), texel = 4 / F(n * n);
        Functions<F> out;
        out.pdf = [=](Vec3<F>, Vec3<F> w) {
            if (!(w.z > 0)) return F(0);
            const F x = w.x / w.z * h, y = w.y / w.z * h;
            if (!(x * x + y * y < 1)) return F(0);
            int i = std::clamp(int((y + 1) / 2 * F(n)), 0, n - 1), j = std::clamp(int((x + 1) / 2 * F(n)), 0, n - 1);
            if (broken == Broken::transposed_table) std::swap(i, j);
            if (broken == Broken::mirrored_table) j = n - 1 - j;
            return mass[std::size_t(i * n + j)] / texel * h * h / (w.z * w.z * w.z);
        };
        out.f = [h](Vec3<F>, Vec3<F> w) {
            return w.z > 0 && sqr(w.x / w.z * h) + sqr(w.y / w.z * h) < 1 ? F(0.3)
                                                                          : F(0);  // limits the reflected power
        };
        out.sample = [=, pdf = out.pdf](Vec3<F> o, const F* u) {
            const auto at = std::upper_bound(cumulative.begin(), cumulative.end(), u[2]) - cumulative.begin() - 1;
            const int k = int(std::clamp<std::ptrdiff_t>(at, 0, n * n - 1));
            const F x = 2 * (F(k % n) + u[0]) / F(n) - 1, y = 2 * (F(k / n) + u[1]) / F(n) - 1;
            const Vec3<F> w = unit(Vec3<F>{x, y, h});
            return Drawn<F>{w, pdf(o, w)};
        };
        return out;
    }
};

/// One of the families of tests/known_samplers/correct that no struct here repeats; it has no mismatch parameter.
template <int index> struct OfTable {
    static constexpr auto name = index == 0 ? "cells" : index == 1 ? "even texels" : "bilinear", parameter = "";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = index == 3 ? Domain::hemisphere : Domain::sphere;
    SyntheticSampler recipe;
    static OfTable drawn(Rng& d) { return {crescent::table_families()[index](d)}; }
    std::string text() const { return recipe.parameters; }
    OfTable stretched(double) const { return *this; }
    template <class F> Functions<F> in(Broken) const {
        Functions<double> out;
        out.pdf = recipe.pdf;
        out.sample = [draw = recipe.sample](Vec3d o, const double* u) {
            const Draw d = draw(o, PrimarySample(u[0], u[1]));
            return Drawn<double>{d.wi, d.pdf};
        };
        if constexpr (sizeof(F) == 8) return out;
        else return rounded(std::move(out));
    }
};

}  // namespace

std::vector<Family> table_families() {
    return {family_of<SkyByCdf>(), family_of<SkyByAlias>(), family_of<Portal>(), family_of<TexturedDisk>(),
        family_of<OfTable<0>>(), family_of<OfTable<1>>(), family_of<OfTable<3>>()};
}

}  // namespace crescent::calibration
