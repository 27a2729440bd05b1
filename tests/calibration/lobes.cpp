// Lobes about fixed axes, about n and about the mirror direction: uniform, cosine, cosine powers, cones, rings, von
// Mises-Fisher, and mixtures of them.
#include <fmt/format.h>

#include "tests/calibration/axial.h"

namespace crescent::calibration {

namespace {

using Wo = Traits::WoDomain;

struct UniformSphere {
    static constexpr auto name = "uniform sphere", parameter = "";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    static UniformSphere drawn(Rng&) { return {}; }
    std::string text() const { return "-"; }
    UniformSphere stretched(double) const { return *this; }
    template <class F> Functions<F> in(Broken) const { return single<F>(fixed<F>({0, 0, 1}), cone_profile<F>(2)); }
};

struct UniformHemisphere {
    static constexpr auto name = "uniform hemisphere", parameter = "";
    static constexpr Wo wo = Wo::upper;
    static constexpr Domain domain = Domain::hemisphere;
    static UniformHemisphere drawn(Rng&) { return {}; }
    std::string text() const { return "-"; }
    UniformHemisphere stretched(double) const { return *this; }
    template <class F> Functions<F> in(Broken) const {
        Functions<F> out = single<F>(fixed<F>({0, 0, 1}), cone_profile<F>(1));
        out.f = [](Vec3<F> o, Vec3<F> i) { return o.z > 0 && i.z > 0 ? F(0.5) / pi_of<F> : F(0); };
        return out;
    }
};

struct Lambert {
    static constexpr auto name = "Lambert", parameter = "";
    static constexpr Wo wo = Wo::upper;
    static constexpr Domain domain = Domain::hemisphere;
    double albedo;
    static Lambert drawn(Rng& d) { return {d.uniform(0.1, 0.95)}; }
    std::string text() const { return fmt::format("albedo {:.3f}", albedo); }
    Lambert stretched(double) const { return *this; }
    template <class F> Functions<F> in(Broken) const {
        Functions<F> out;
        out.pdf = [](Vec3<F>, Vec3<F> i) { return std::max(i.z, F(0)) / pi_of<F>; };
        out.f = [a = F(albedo)](Vec3<F> o, Vec3<F> i) { return o.z > 0 && i.z > 0 ? a / pi_of<F> : F(0); };
        out.sample = [](Vec3<F>, const F* u) {
            const Vec3<F> i = cosine_weighted(u[0], u[1]);
            return Drawn<F>{i, i.z / pi_of<F>};
        };
        return out;
    }
};

/// Reflection and diffuse transmission; u[2] selects the side.
struct TwoSided {
    static constexpr auto name = "Lambert on both sides", parameter = "share that is transmitted";
    static constexpr Wo wo = Wo::both;
    static constexpr Domain domain = Domain::sphere;
    static constexpr int numbers = 3;
    double albedo, through;
    static TwoSided drawn(Rng& d) { return {d.uniform(0.1, 0.95), d.uniform(0.05, 0.6)}; }
    std::string text() const { return fmt::format("albedo {:.3f}, through {:.3f}", albedo, through); }
    TwoSided stretched(double by) const { return {albedo, through * by}; }
    template <class F> Functions<F> in(Broken) const {
        Functions<F> out;
        const auto share = [t = F(through)](Vec3<F> o, Vec3<F> i) { return o.z * i.z > 0 ? 1 - t : t; };
        out.pdf = [share](Vec3<F> o, Vec3<F> i) { return share(o, i) * std::fabs(i.z) / pi_of<F>; };
        out.f = [share, a = F(albedo)](Vec3<F> o, Vec3<F> i) { return share(o, i) * a / pi_of<F>; };
        out.sample = [t = F(through), pdf = out.pdf](Vec3<F> o, const F* u) {
            Vec3<F> i = cosine_weighted(u[0], u[1]);
            if ((o.z < 0) != (u[2] < t)) i = -i;
            return Drawn<F>{i, pdf(o, i)};
        };
        return out;
    }
};

/// About n: between a uniform hemisphere and a narrow lobe.
struct PowerCosine {
    static constexpr auto name = "power cosine", parameter = "exponent";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::hemisphere;
    double s;
    static PowerCosine drawn(Rng& d) { return {d.log(0.2, 500)}; }
    std::string text() const { return fmt::format("s {:.4g}", s); }
    PowerCosine stretched(double by) const { return {s * by}; }
    template <class F> Functions<F> in(Broken) const { return single<F>(fixed<F>({0, 0, 1}), power_profile<F>(F(s))); }
};

/// About the mirror direction; draws below the surface are kept, with f = 0.
struct Phong {
    static constexpr auto name = "Phong", parameter = "exponent";
    static constexpr Wo wo = Wo::upper;
    static constexpr Domain domain = Domain::sphere;
    double s, rho;
    static Phong drawn(Rng& d) { return {d.log(1, 2000), d.uniform(0.1, 0.9)}; }
    std::string text() const { return fmt::format("s {:.4g}", s); }
    Phong stretched(double by) const { return {s * by, rho}; }
    template <class F> Functions<F> in(Broken) const {
        Functions<F> out = single<F>(mirror_direction<F>(), power_profile<F>(F(s)));
        out.f = [s = F(s), rho = F(rho)](Vec3<F> o, Vec3<F> i) {
            const F t = versine(Vec3<F>{-o.x, -o.y, o.z}, i);
            return o.z > 0 && i.z > 0 && t < 1 ? rho * (s + 2) / (2 * pi_of<F>)*std::exp(s * std::log1p(-t)) : F(0);
        };
        return out;
    }
};

struct Cone {
    static constexpr auto name = "cone", parameter = "1 - cos of the half angle";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    double gap;
    Vec3d axis;
    static Cone drawn(Rng& d) { return {d.log(1e-4, 1), d.direction(-1, 1)}; }
    std::string text() const { return fmt::format("1 - cos {:.4g}, axis z {:.3f}", gap, axis.z); }
    Cone stretched(double by) const { return {gap * by, axis}; }
    template <class F> Functions<F> in(Broken) const { return single<F>(fixed<F>(axis), cone_profile<F>(F(gap))); }
};

/// Between two cones.
struct Ring {
    static constexpr auto name = "ring", parameter = "width in cos";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    double low, width;  // of t = 1 - cos
    Vec3d axis;
    static Ring drawn(Rng& d) { return {d.uniform(0.05, 1.2), d.log(0.02, 0.4), d.direction(-1, 1)}; }
    std::string text() const { return fmt::format("1 - cos {:.3f}, width {:.4g}", low, width); }
    Ring stretched(double by) const { return {low, width * by, axis}; }
    template <class F> Functions<F> in(Broken) const {
        const F a = F(low), w = F(width), e = F(1.5) * slack<F>;
        return single<F>(fixed<F>(axis),
            {[a, w](F u) { return a + w * u; },
                [a, w, e](F t) { return t >= a - e && t <= a + w + e ? 1 / (2 * pi_of<F> * w) : F(0); }});
    }
};

struct Fisher {
    static constexpr auto name = "von Mises-Fisher", parameter = "kappa";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    double k;
    Vec3d axis;
    static Fisher drawn(Rng& d) { return {d.log(0.5, 5000), d.direction(-1, 1)}; }
    std::string text() const { return fmt::format("kappa {:.4g}, axis z {:.3f}", k, axis.z); }
    Fisher stretched(double by) const { return {k * by, axis}; }
    template <class F> Functions<F> in(Broken) const { return single<F>(fixed<F>(axis), fisher_profile<F>(F(k))); }
};

constexpr Broken of_mixtures[] = {Broken::lobe_pdf, Broken::equal_weights, Broken::no_weights};

struct FisherMixture {
    static constexpr auto name = "von Mises-Fisher mixture", parameter = "kappa of all";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    static constexpr int numbers = 3;
    static constexpr const auto& breaks = of_mixtures;
    struct One {
        double weight, k;
        Vec3d axis;
    };
    std::vector<One> all;
    static FisherMixture drawn(Rng& d) {
        FisherMixture m;
        for (int n = d.whole(2, 5); n > 0; --n) {
            const double weight = d.log(0.1, 1), k = d.log(1, 3000);
            m.all.push_back({weight, k, d.direction(-1, 1)});
        }
        return m;
    }
    std::string text() const { return fmt::format("{} lobes, first kappa {:.4g}", all.size(), all[0].k); }
    FisherMixture stretched(double by) const {
        FisherMixture m = *this;
        for (One& l : m.all) l.k *= by;
        return m;
    }
    template <class F> Functions<F> in(Broken b) const {
        std::vector<Lobe<F>> lobes;
        for (const One& l : all) lobes.push_back({F(l.weight), fixed<F>(l.axis), fisher_profile<F>(F(l.k))});
        return mixture<F>(std::move(lobes), b);
    }
};

/// Cosine powers about axes such as those of a path guide.
struct FixedLobes {
    static constexpr auto name = "lobes about fixed axes", parameter = "exponent of all";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    static constexpr int numbers = 3;
    static constexpr const auto& breaks = of_mixtures;
    FisherMixture at;
    static FixedLobes drawn(Rng& d) { return {FisherMixture::drawn(d)}; }
    std::string text() const { return fmt::format("{} lobes, first exponent {:.4g}", at.all.size(), at.all[0].k); }
    FixedLobes stretched(double by) const { return {at.stretched(by)}; }
    template <class F> Functions<F> in(Broken b) const {
        std::vector<Lobe<F>> lobes;
        for (const auto& l : at.all) lobes.push_back({F(l.weight), fixed<F>(l.axis), power_profile<F>(F(l.k))});
        return mixture<F>(std::move(lobes), b);
    }
};

/// Lambert and Phong.
struct Plastic {
    static constexpr auto name = "plastic", parameter = "exponent";
    static constexpr Wo wo = Wo::upper;
    static constexpr Domain domain = Domain::sphere;
    static constexpr int numbers = 3;
    static constexpr const auto& breaks = of_mixtures;
    double s, share;
    static Plastic drawn(Rng& d) { return {d.log(5, 2000), d.uniform(0.2, 0.8)}; }
    std::string text() const { return fmt::format("s {:.4g}, share of Lambert {:.3f}", s, share); }
    Plastic stretched(double by) const { return {s * by, share}; }
    template <class F> Functions<F> in(Broken b) const {
        Functions<F> out = mixture<F>({{F(share), fixed<F>({0, 0, 1}), power_profile<F>(1)},
                                          {F(1 - share), mirror_direction<F>(), power_profile<F>(F(s))}},
            b);
        out.f = [s = F(s), d = F(share)](Vec3<F> o, Vec3<F> i) {
            const F t = versine(Vec3<F>{-o.x, -o.y, o.z}, i);
            const F lobe = t < 1 ? (s + 2) / (2 * pi_of<F>)*std::exp(s * std::log1p(-t)) : F(0);
            return o.z > 0 && i.z > 0 ? F(0.9) * (d / pi_of<F> + (1 - d) * lobe) : F(0);
        };
        return out;
    }
};

}  // namespace

std::vector<Family> lobe_families() {
    return {family_of<UniformSphere>(), family_of<UniformHemisphere>(), family_of<Lambert>(), family_of<TwoSided>(),
        family_of<PowerCosine>(), family_of<Phong>(), family_of<Cone>(), family_of<Ring>(), family_of<Fisher>(),
        family_of<FisherMixture>(), family_of<FixedLobes>(), family_of<Plastic>()};
}

}  // namespace crescent::calibration
