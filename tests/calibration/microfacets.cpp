// Microfacet reflection through half vectors, rough glass, and a rough lobe over Lambert. Walter et al. 2007,
// "Microfacet Models for Refraction through Rough Surfaces".
#include "tests/calibration/microfacets.h"

#include <fmt/format.h>

#include "tests/known_samplers/correct/renderers.h"

namespace crescent::calibration {

namespace {

using Wo = Traits::WoDomain;

struct GgxVisible {
    static constexpr auto name = "GGX by visible normals", parameter = "roughness";
    static constexpr Wo wo = Wo::upper;
    static constexpr Domain domain = Domain::sphere;
    static constexpr bool halfway = true;
    double ax, ay;
    static GgxVisible drawn(Rng& d) {
        const double ax = d.log(0.03, 1);
        return {ax, d.whole(0, 1) ? ax : d.log(0.03, 1)};
    }
    std::string text() const { return fmt::format("alpha {:.4g} / {:.4g}", ax, ay); }
    GgxVisible stretched(double by) const { return {ax * by, ay * by}; }
    template <class F> Functions<F> in(Broken) const { return Ggx2<F>{F(ax), F(ay)}.visible(); }
};

struct GgxNormals {
    static constexpr auto name = "GGX by D", parameter = "roughness";
    static constexpr Wo wo = Wo::upper;
    static constexpr Domain domain = Domain::sphere;
    static constexpr bool halfway = true;
    GgxVisible at;
    static GgxNormals drawn(Rng& d) { return {GgxVisible::drawn(d)}; }
    std::string text() const { return at.text(); }
    GgxNormals stretched(double by) const { return {at.stretched(by)}; }
    template <class F> Functions<F> in(Broken) const {
        const Ggx2<F> g{F(at.ax), F(at.ay)};
        Functions<F> out = by_normals<F>(
            [g](F u1, F u2) {
                const F r = std::sqrt(u1 / (1 - u1)), phi = 2 * pi_of<F> * u2;
                return unit(Vec3<F>{g.ax * r * std::cos(phi), g.ay * r * std::sin(phi), 1});
            },
            [g](Vec3<F> m) { return g.D(m); });
        out.f = [g](Vec3<F> o, Vec3<F> i) { return g.f(o, i); };
        return out;
    }
};

struct Beckmann {
    static constexpr auto name = "Beckmann by D", parameter = "roughness";
    static constexpr Wo wo = Wo::upper;
    static constexpr Domain domain = Domain::sphere;
    static constexpr bool halfway = true;
    double ax, ay;
    static Beckmann drawn(Rng& d) {
        const double ax = d.log(0.04, 0.7);
        return {ax, d.whole(0, 1) ? ax : d.log(0.04, 0.7)};
    }
    std::string text() const { return fmt::format("alpha {:.4g} / {:.4g}", ax, ay); }
    Beckmann stretched(double by) const { return {ax * by, ay * by}; }
    template <class F> Functions<F> in(Broken) const {
        return by_normals<F>(
            [ax = F(ax), ay = F(ay)](F u1, F u2) {
                const F r = std::sqrt(-std::log1p(-u1)), phi = 2 * pi_of<F> * u2;
                return unit(Vec3<F>{ax * r * std::cos(phi), ay * r * std::sin(phi), 1});
            },
            [ax = F(ax), ay = F(ay)](Vec3<F> m) {
                if (!(m.z > 0)) return F(0);
                const F t = (sqr(m.x / ax) + sqr(m.y / ay)) / sqr(m.z);
                return std::exp(-t) / (pi_of<F> * ax * ay * sqr(sqr(m.z)));
            });
    }
};

/// D = (s + 2) / (2 pi) cos^s.
struct Blinn {
    static constexpr auto name = "Blinn-Phong", parameter = "exponent";
    static constexpr Wo wo = Wo::upper;
    static constexpr Domain domain = Domain::sphere;
    static constexpr bool halfway = true;
    double s;
    static Blinn drawn(Rng& d) { return {d.log(3, 2000)}; }
    std::string text() const { return fmt::format("s {:.4g}", s); }
    Blinn stretched(double by) const { return {s * by}; }
    template <class F> Functions<F> in(Broken) const {
        return by_normals<F>(
            [s = F(s)](F u1, F u2) {
                const F c = std::pow(1 - u1, 1 / (s + 2)), sin = std::sqrt(std::max((1 - c) * (1 + c), F(0)));
                return Vec3<F>{sin * std::cos(2 * pi_of<F> * u2), sin * std::sin(2 * pi_of<F> * u2), c};
            },
            [s = F(s)](
                Vec3<F> m) { return m.z > 0 ? (s + 2) / (2 * pi_of<F>)*std::pow(std::min(m.z, F(1)), s) : F(0); });
    }
};

struct RoughDielectric {
    static constexpr auto name = "rough dielectric", parameter = "roughness";
    static constexpr Wo wo = Wo::both;
    static constexpr Domain domain = Domain::sphere;
    static constexpr int numbers = 3;
    double alpha, eta;
    bool visible;
    static RoughDielectric drawn(Rng& d) {
        const double alpha = d.log(0.05, 0.8), eta = d.uniform(1.15, 2.2);
        return {alpha, eta, d.whole(0, 1) == 1};
    }
    std::string text() const {
        return fmt::format("alpha {:.4g}, eta {:.3f}{}", alpha, eta, visible ? ", visible normals" : "");
    }
    RoughDielectric stretched(double by) const { return {alpha * by, eta, visible}; }
    template <class F> Functions<F> in(Broken) const {
        const RoughGlass g{alpha, eta, visible};
        Functions<double> out;
        out.pdf = [g](Vec3d o, Vec3d i) { return g.pdf(o, i); };
        out.f = [g](Vec3d o, Vec3d i) { return g.f(o, i); };
        out.sample = [g](Vec3d o, const double* u) {
            PrimarySample v(u[0], u[1]);
            v[2] = u[2];
            const Draw d = g.sample(o, v);
            return Drawn<double>{d.wi, d.pdf};
        };
        if constexpr (sizeof(F) == 8) return out;
        else return rounded(std::move(out));
    }
};

/// A rough lobe over Lambert, selected with Schlick's Fresnel at w_o.
struct Layered {
    static constexpr auto name = "rough lobe over Lambert", parameter = "roughness";
    static constexpr Wo wo = Wo::upper;
    static constexpr Domain domain = Domain::sphere;
    static constexpr int numbers = 3;
    static constexpr Broken breaks[] = {Broken::lobe_pdf, Broken::equal_weights, Broken::no_weights};
    double alpha, f0, albedo;
    static Layered drawn(Rng& d) {
        const double alpha = d.log(0.05, 0.8), f0 = d.uniform(0.04, 0.5);
        return {alpha, f0, d.uniform(0.1, 0.9)};
    }
    std::string text() const { return fmt::format("alpha {:.4g}, f0 {:.3f}", alpha, f0); }
    Layered stretched(double by) const { return {alpha * by, f0, albedo}; }
    template <class F> Functions<F> in(Broken b) const {
        const Ggx2<F> g{F(alpha), F(alpha)};
        const auto share = [f0 = F(f0)](Vec3<F> o) {
            const F c = 1 - std::clamp(o.z, F(0), F(1));
            return F(0.1) + F(0.8) * (f0 + (1 - f0) * sqr(sqr(c)) * c);
        };
        Functions<F> out;
        out.f = [g, f0 = F(f0), a = F(albedo)](Vec3<F> o, Vec3<F> i) {
            return o.z > 0 && i.z > 0 ? f0 * g.f(o, i) + (1 - f0) * a / pi_of<F> : F(0);
        };
        out.pdf = [g, share, b](Vec3<F> o, Vec3<F> i) {
            const F p = g.visible_pdf(o, i), q = std::max(i.z, F(0)) / pi_of<F>, s = share(o);
            if (b == Broken::lobe_pdf) return std::max(p, q);
            if (b == Broken::equal_weights) return (p + q) / 2;
            return b == Broken::no_weights ? p + q : s * p + (1 - s) * q;
        };
        out.sample = [g, share, pdf = out.pdf](Vec3<F> o, const F* u) {
            const Vec3<F> i =
                u[2] < share(o) ? reflected(o, g.visible_normal(o, u[0], u[1])) : cosine_weighted(u[0], u[1]);
            return Drawn<F>{i, pdf(o, i)};
        };
        return out;
    }
};

}  // namespace

std::vector<Family> microfacet_families() {
    return {family_of<GgxVisible>(), family_of<GgxNormals>(), family_of<Beckmann>(), family_of<Blinn>(),
        family_of<RoughDielectric>(), family_of<Layered>()};
}

}  // namespace crescent::calibration
