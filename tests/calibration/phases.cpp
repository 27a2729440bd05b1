// Phase functions and fibres, for w_o on both sides. Axis: the direction of light that is not scattered, -w_o.
#include <fmt/format.h>

#include "tests/calibration/axial.h"

namespace crescent::calibration {

namespace {

using Wo = Traits::WoDomain;

struct Greenstein {
    static constexpr auto name = "Henyey-Greenstein", parameter = "g";
    static constexpr Wo wo = Wo::both;
    static constexpr Domain domain = Domain::sphere;
    double g;
    static Greenstein drawn(Rng& d) {
        const double g = d.uniform(0.05, 0.95);
        return {d.whole(0, 2) == 0 ? -g : g};
    }
    std::string text() const { return fmt::format("g {:.3f}", g); }
    Greenstein stretched(double by) const { return {std::clamp(g * by, -0.999, 0.999)}; }
    template <class F> Functions<F> in(Broken) const { return single<F>(forward<F>(), greenstein_profile<F>(F(g))); }
};

struct TwoGreensteins {
    static constexpr auto name = "two Henyey-Greenstein lobes", parameter = "g of both";
    static constexpr Wo wo = Wo::both;
    static constexpr Domain domain = Domain::sphere;
    static constexpr int numbers = 3;
    static constexpr Broken breaks[] = {Broken::lobe_pdf, Broken::equal_weights, Broken::no_weights};
    double g1, g2, share;
    static TwoGreensteins drawn(Rng& d) { return {d.uniform(0.4, 0.95), -d.uniform(0.1, 0.6), d.uniform(0.55, 0.9)}; }
    std::string text() const { return fmt::format("g {:.3f} and {:.3f}, share {:.3f}", g1, g2, share); }
    TwoGreensteins stretched(double by) const { return {std::min(g1 * by, 0.999), std::max(g2 * by, -0.999), share}; }
    template <class F> Functions<F> in(Broken b) const {
        return mixture<F>({{F(share), forward<F>(), greenstein_profile<F>(F(g1))},
                              {F(1 - share), forward<F>(), greenstein_profile<F>(F(g2))}},
            b);
    }
};

/// 3 / (16 pi) (1 + cos^2): Frisvad 2011, "Importance Sampling the Rayleigh Phase Function".
struct Rayleigh {
    static constexpr auto name = "Rayleigh", parameter = "";
    static constexpr Wo wo = Wo::both;
    static constexpr Domain domain = Domain::sphere;
    static Rayleigh drawn(Rng&) { return {}; }
    std::string text() const { return "-"; }
    Rayleigh stretched(double) const { return *this; }
    template <class F> Functions<F> in(Broken) const {
        return single<F>(forward<F>(),
            {[](F u) {
                 const F k = 2 - 4 * u, c = std::cbrt(std::sqrt(k * k + 1) + std::fabs(k));
                 const F cos = k < 0 ? 1 / c - c : c - 1 / c;
                 return std::clamp(1 - cos, F(0), F(2));
             },
                [](F t) { return 3 / (16 * pi_of<F>)*(1 + sqr(1 - t)); }});
    }
};

/// A measured phase function: constant in bins of cos theta.
struct Tabulated {
    static constexpr auto name = "table in cos theta", parameter = "power of the table";
    static constexpr Wo wo = Wo::both;
    static constexpr Domain domain = Domain::sphere;
    static constexpr Broken breaks[] = {Broken::shifted_table, Broken::mirrored_table};
    std::vector<double> value;
    static Tabulated drawn(Rng& d) {
        Tabulated t;
        const double contrast = d.log(2, 200);
        const int bins = d.whole(8, 180);
        for (int k = 0; k < bins; ++k) t.value.push_back(d.log(1, 1.5) * std::pow(contrast, double(k) / bins));
        return t;
    }
    std::string text() const { return fmt::format("{} bins", value.size()); }
    Tabulated stretched(double by) const {
        Tabulated t = *this;
        for (double& v : t.value) v = std::pow(v, by);
        return t;
    }
    template <class F> Functions<F> in(Broken b) const {
        const int n = static_cast<int>(value.size());
        std::vector<double> sums = {0};
        for (double v : value) sums.push_back(sums.back() + v);
        std::vector<F> cumulative, density;  // t = 1 - cos in bins of 2 / n
        for (int k = 0; k < n; ++k) {
            cumulative.push_back(F(sums[static_cast<std::size_t>(k)] / sums.back()));
            density.push_back(F(value[static_cast<std::size_t>(k)] / sums.back() * n / (4 * pi_of<double>)));
        }
        cumulative.push_back(1);
        const auto bin = [n](F t) { return std::clamp(static_cast<int>(t / 2 * F(n)), 0, n - 1); };
        return single<F>(forward<F>(),
            {[cumulative, n](F u) {
                 const auto at = std::upper_bound(cumulative.begin(), cumulative.end(), u) - 1;
                 const auto k = std::min<std::ptrdiff_t>(at - cumulative.begin(), n - 1);
                 const F low = cumulative[std::size_t(k)], high = cumulative[std::size_t(k) + 1];
                 return 2 * (F(k) + std::min((u - low) / (high - low), F(1))) / F(n);
             },
                [density, bin, n, b](F t) {
                    int k = bin(t);
                    if (b == Broken::shifted_table) k = (k + 1) % n;
                    if (b == Broken::mirrored_table) k = n - 1 - k;
                    return density[std::size_t(k)];
                }});
    }
};

/// A logistic distribution truncated to [-half, half]: its value and its inverse. d'Eon 2013, "Importance Sampling for
/// Physically-Based Hair Fiber Models".
template <class F> struct CutLogistic {
    F s, half;
    F cdf(F x) const { return 1 / (1 + std::exp(-x / s)); }
    F density(F x) const {
        const F e = std::exp(-std::fabs(x) / s);
        return std::fabs(x) <= half ? e / (s * sqr(1 + e)) / (cdf(half) - cdf(-half)) : F(0);
    }
    F draw(F u) const {
        const F c = cdf(-half) + u * (cdf(half) - cdf(-half));
        return std::clamp(-s * std::log(1 / std::clamp(c, F(1e-30), 1 - slack<F> / 8) - 1), -half, half);
    }
};

/// A fibre along x: angle to its normal plane about that of the mirror cone, azimuth about that of w_o + pi.
struct Fibre {
    static constexpr auto name = "fibre", parameter = "width of both lobes";
    static constexpr Wo wo = Wo::both;
    static constexpr Domain domain = Domain::sphere;
    double along, across;
    static Fibre drawn(Rng& d) { return {d.log(0.02, 0.3), d.log(0.1, 1)}; }
    std::string text() const { return fmt::format("widths {:.3f}, {:.3f}", along, across); }
    Fibre stretched(double by) const { return {along * by, across * by}; }
    template <class F> Functions<F> in(Broken) const {
        // theta + the angle of the mirror cone may leave [-pi/2, pi/2]; such a draw is reflected at the end of the
        // interval.
        const CutLogistic<F> m{F(along), pi_of<F> / 2}, n{F(across), pi_of<F>};
        const auto azimuth = [](Vec3<F> w) { return std::atan2(w.z, w.y); };
        const auto elevation = [](Vec3<F> w) { return std::atan2(w.x, std::hypot(w.y, w.z)); };
        Functions<F> out;
        out.pdf = [=](Vec3<F> o, Vec3<F> i) {
            const F to = -elevation(o), ti = elevation(i), cos = std::hypot(i.y, i.z), end = pi_of<F>;
            F phi = azimuth(i) - azimuth(o) - pi_of<F>;
            phi -= 2 * pi_of<F> * std::round(phi / (2 * pi_of<F>));
            const F along_theta = m.density(ti - to) + m.density(end - ti - to) + m.density(-end - ti - to);
            return cos > 0 ? along_theta * n.density(phi) / cos : F(0);
        };
        out.sample = [=, pdf = out.pdf](Vec3<F> o, const F* u) {
            F theta = m.draw(u[0]) - elevation(o);
            if (theta > pi_of<F> / 2) theta = pi_of<F> - theta;
            if (theta < -pi_of<F> / 2) theta = -pi_of<F> - theta;
            const F phi = azimuth(o) + pi_of<F> + n.draw(u[1]), cos = std::cos(theta);
            const Vec3<F> i{std::sin(theta), cos * std::cos(phi), cos * std::sin(phi)};
            return Drawn<F>{i, pdf(o, i)};
        };
        return out;
    }
};

}  // namespace

std::vector<Family> phase_families() {
    return {family_of<Greenstein>(), family_of<TwoGreensteins>(), family_of<Rayleigh>(), family_of<Tabulated>(),
        family_of<Fibre>()};
}

}  // namespace crescent::calibration
