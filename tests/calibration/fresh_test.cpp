// Tests the fresh families without an engine, as families_test.cpp does the others.
#include <boost/math/distributions/chi_squared.hpp>
#include <gtest/gtest.h>

#include "tests/calibration/cases.h"
#include "tests/calibration/geometry.h"
#include "tests/calibration/measures.h"
#include "tests/calibration/streams.h"

namespace crescent::calibration {
namespace fresh_test {

TEST(FreshFamilies, DrawTheirDensityWhichIntegratesToOne) {
    for (std::size_t f = 0; f < fresh_names().size(); ++f)
        for (const Real real : {Real::f64, Real::f32}) {
            Rng d = rng_of({"fresh_test", f, real == Real::f32 ? 1u : 0u, "parameters"});
            const Sampler s = fresh_sampler(f, real, d);
            if (s.given) continue;
            SCOPED_TRACE(s.family + " (" + s.parameters + ")" + (real == Real::f32 ? " f32" : ""));
            const double side = s.wo == Traits::WoDomain::both && real == Real::f32 ? -1 : 1;
            const Vec3d wo = s.wo == Traits::WoDomain::none ? Vec3d{0, 0, 1} : unit(Vec3d{0.5, -0.3, 0.6 * side});
            const Fit fit = fit_of(s, wo, 1 << 15, f);
            EXPECT_LT(std::fabs(fit.sigmas), 5) << "integral " << fit.integral << ", drawn " << fit.drawn;
            EXPECT_GT(boost::math::cdf(complement(boost::math::chi_squared(fit.degrees), fit.chi2)), 1e-6)
                << fit.chi2 << " on " << fit.degrees;
            EXPECT_LT(share_of_other_pdf(s, wo, 1 << 12, f), s.real() == Real::f32 ? 2e-3 : 1e-9);
        }
}

// The mean weight of draws is the integral of f cos, plus the power of the delta parts.
TEST(FreshFamilies, WeightsAverageToTheReflectedShare) {
    for (std::size_t f = 0; f < fresh_names().size(); ++f)
        for (const Real real : {Real::f64, Real::f32}) {
            Rng d = rng_of({"fresh_test", 10 * f, 1, "parameters"});
            const Sampler s = fresh_sampler(f, real, d);
            if (!s.given) continue;
            const Vec3d wo = unit(Vec3d{0.5, -0.3, 0.6});
            constexpr int n = 1 << 17;
            double mean = 0, square = 0, delta = 0, integral = 0, integral_square = 0;
            for (int i = 0; i < n; ++i) {
                PrimarySample u(d.uniform(0, 1), d.uniform(0, 1));
                u[2] = d.uniform(0, 1);
                Draw draw;
                s.given->sample(0, wo, {&u, 1}, {&draw, 1});
                const double x = draw.pdf > 0 ? draw.weight.value() : 0;
                mean += x / n;
                square += x * x / n;
                delta += draw.delta > 0 ? 1.0 / n : 0;
                const Pair at{wo, d.direction(-1, 1)};
                double y = 0;
                s.given->f({&at, 1}, {&y, 1});
                y *= 4 * pi_of<double> * std::fabs(at.wi.z);
                integral += y / n;
                integral_square += y * y / n;
            }
            const double error = std::sqrt((square - mean * mean + integral_square - integral * integral) / n);
            EXPECT_NEAR(mean, integral, 5 * error) << s.family << " " << s.parameters;
            EXPECT_LE(delta + mean, 1) << s.family;
        }
}

}  // namespace fresh_test
}  // namespace crescent::calibration
