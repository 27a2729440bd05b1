// Gauss-Legendre quadrature of n points: exact for polynomials of degree 2n - 1. Nodes are the zeros of P_n by Newton's
// method from cos(pi (k + 3/4)/(n + 1/2)), weights 2/((1 - x^2) P_n'(x)^2) (Abramowitz & Stegun 25.4.29, 22.16.6).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "math/functions.h"

namespace crescent::math {

template <unsigned n> class Gauss {
public:
    static constexpr std::size_t half = (n + 1) / 2;

    /// The nodes in [0, 1), ascending, and their weights; -x has the weight of x.
    static const std::array<double, half>& abscissa() { return rule().x; }
    static const std::array<double, half>& weights() { return rule().w; }

    /// Returns the integral of f over [a, b].
    template <class Function> static auto integrate(Function&& f, double a, double b) {
        const double middle = 0.5 * (a + b), radius = 0.5 * (b - a);
        const Rule& r = rule();
        std::size_t k = n % 2;
        auto sum = k ? r.w[0] * f(middle) : r.w[0] * (f(middle - radius * r.x[0]) + f(middle + radius * r.x[0]));
        if (!k) k = 1;
        for (; k < half; ++k) sum += r.w[k] * (f(middle - radius * r.x[k]) + f(middle + radius * r.x[k]));
        return sum * radius;
    }

private:
    struct Rule {
        std::array<double, half> x, w;
    };

    static Rule make() {
        Rule rule{};
        for (std::size_t k = 0; k < half; ++k) {
            const double angle = 3.14159265358979323846 * (static_cast<double>(k) + 0.75) / (n + 0.5);
            double x = n % 2 && k == half - 1 ? 0 : cos(angle), slope = 0;
            for (int step = 0; step < 8; ++step) {
                double previous = 1, current = x;
                for (unsigned j = 2; j <= n; ++j) {
                    const double next = ((2 * j - 1) * x * current - (j - 1) * previous) / j;
                    previous = current;
                    current = next;
                }
                slope = n * (x * current - previous) / (x * x - 1);
                if (x != 0) x -= current / slope;
            }
            rule.x[half - 1 - k] = x;
            rule.w[half - 1 - k] = 2 / ((1 - x * x) * slope * slope);
        }
        return rule;
    }
    static const Rule& rule() {
        static const Rule instance = make();
        return instance;
    }
};

}  // namespace crescent::math

// ---- Integrals over an interval by two rules at once: Kronrod's, and the Gauss rule among its nodes (Piessens et al.
// 1983, QUADPACK); their difference bounds the error of the finer one, with a large margin if the integrand is smooth.

namespace crescent {

/// Nodes from the middle outwards; every second one, from the middle on, is also Gauss's.
template <std::size_t n> struct KronrodRule {
    std::array<double, n> x, kronrod;
    std::array<double, (n + 1) / 2> gauss;
};

inline constexpr KronrodRule<4> kronrod_7 = {
    {0.0, 0.434243749346802558002071502844628, 0.774596669241483377035853079956480,
        0.960491268708020283423507092629080},
    {0.450916538658474142345110087045571, 0.401397414775962222905051818618432, 0.268488089868333440728569280666710,
        0.104656226026467265193823857192073},
    {8.0 / 9, 5.0 / 9}};

inline constexpr KronrodRule<8> kronrod_15 = {
    {0.0, 0.207784955007898467600689403773245, 0.405845151377397166906606412076961, 0.586087235467691130294144691693013,
        0.741531185599394439863864773280788, 0.864864423359769072789712788640926, 0.949107912342758524526189684047851,
        0.991455371120812639206854697526329},
    {0.209482141084727828012999174891714, 0.204432940075298892414161999234649, 0.190350578064785409913256402421014,
        0.169004726639267902826583426598550, 0.140653259715525918745189590510238, 0.104790010322250183839876322541518,
        0.063092092629978553290700663189204, 0.022935322010529224963732008058970},
    {0.417959183673469387755102040816327, 0.381830050505118944950369775488975, 0.279705391489276667901467771423780,
        0.129484966168869693270611432679082}};

template <class V> struct TwoRules {
    V fine, difference;  // Kronrod's integral; that minus Gauss's
    V spread;            // Gauss's minus the middle point's
};

/// f returns any V with V + V, V - V and double * V.
template <std::size_t n, class F> auto by_two_rules(const KronrodRule<n>& rule, const F& f, double lo, double hi) {
    const double middle = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
    const auto first = f(middle);
    auto fine = rule.kronrod[0] * first, coarse = rule.gauss[0] * first;
    for (std::size_t k = 1; k < n; ++k) {
        const auto pair_sum = f(middle - half * rule.x[k]) + f(middle + half * rule.x[k]);
        fine = fine + rule.kronrod[k] * pair_sum;
        if (k % 2 == 0) coarse = coarse + rule.gauss[k / 2] * pair_sum;
    }
    return TwoRules<decltype(first + first)>{half * fine, half * (fine - coarse), half * (coarse - 2.0 * first)};
}

}  // namespace crescent
