// Gauss-Legendre quadrature of n points: exact for polynomials of degree 2n - 1. Nodes are the zeros of P_n by Newton's
// method from cos(pi (k + 3/4)/(n + 1/2)), weights 2/((1 - x^2) P_n'(x)^2) (Abramowitz & Stegun 25.4.29, 22.16.6).
#pragma once

#include <array>
#include <cmath>

#include "math/functions.h"

namespace crescent::math {

template <unsigned n> class Gauss {
public:
    static constexpr std::size_t half = (n + 1) / 2;

    /// The nodes in [0, 1), rising, and their weights; -x weighs what x does.
    static const std::array<double, half>& abscissa() { return rule().x; }
    static const std::array<double, half>& weights() { return rule().w; }

    /// Integral of f over [a, b].
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
                double before = 1, here = x;
                for (unsigned j = 2; j <= n; ++j) {
                    const double next = ((2 * j - 1) * x * here - (j - 1) * before) / j;
                    before = here, here = next;
                }
                slope = n * (x * here - before) / (x * x - 1);
                if (x != 0) x -= here / slope;
            }
            rule.x[half - 1 - k] = x;
            rule.w[half - 1 - k] = 2 / ((1 - x * x) * slope * slope);
        }
        return rule;
    }
    static const Rule& rule() {
        static const Rule one = make();
        return one;
    }
};

}  // namespace crescent::math
