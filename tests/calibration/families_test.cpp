// Tests the right families without an engine: the density integrates to one by Gauss-Legendre panels or by a mean over
// the family's own draws, and draws are distributed over bins as the density predicts.
#include <boost/math/distributions/chi_squared.hpp>
#include <gtest/gtest.h>

#include "tests/calibration/faults.h"
#include "tests/calibration/geometry.h"
#include "tests/calibration/measures.h"

namespace crescent::calibration {
namespace families_test {

/// Every family with one member, in both precisions, at one w_o.
class EveryFamily : public testing::TestWithParam<std::tuple<std::size_t, int>> {
protected:
    const Family& family = families()[std::get<0>(GetParam())];
    Real real = std::get<1>(GetParam()) ? Real::f32 : Real::f64;
    std::uint64_t seed = std::get<0>(GetParam()) * 2 + static_cast<std::uint64_t>(std::get<1>(GetParam()));
    Sampler sampler = [&] {
        Rng d = rng_of({"families_test", seed, 0, "parameters"});
        return sampler_of(family, family.member(d), real);
    }();
    Vec3d wo = family.wo == Traits::WoDomain::none ? Vec3d{0, 0, 1} : unit(Vec3d{0.5, -0.3, 0.6});
};

TEST_P(EveryFamily, DrawsFollowTheDensityAndTheDensityIntegratesToOne) {
    SCOPED_TRACE(family.name + " (" + sampler.parameters + ")");
    const Fit fit = fit_of(sampler, wo, 1 << 17, seed);
    EXPECT_LT(std::fabs(fit.sigmas), 5) << "integral " << fit.integral << ", drawn " << fit.drawn;
    EXPECT_GT(boost::math::cdf(complement(boost::math::chi_squared(fit.degrees), fit.chi2)), 1e-5)
        << fit.chi2 << " on " << fit.degrees;
}

TEST_P(EveryFamily, ADrawHasTheDensityOfItsDirection) {
    SCOPED_TRACE(family.name + " (" + sampler.parameters + ")");
    EXPECT_LT(share_of_other_pdf(sampler, wo, 1 << 14, seed), real == Real::f32 ? 2e-3 : 1e-9);
}

INSTANTIATE_TEST_SUITE_P(
    All, EveryFamily, testing::Combine(testing::Range<std::size_t>(0, families().size()), testing::Values(0, 1)));

// The integral of p in single precision over the support in double is the mean of their ratio over draws in double.
TEST(Families, SinglePrecisionKeepsTheIntegralBelowTheDetectionFloor) {
    for (const Family& f : families()) {
        const Vec3d wo = f.wo == Traits::WoDomain::none ? Vec3d{0, 0, 1} : unit(Vec3d{0.5, -0.3, 0.6});
        for (std::uint64_t k = 0; k < 3; ++k) {
            Rng d = rng_of({"families_test", 100 + k, 0, f.name});
            const Member member = f.member(d);
            const Sampler in_double = sampler_of(f, member, Real::f64), in_float = sampler_of(f, member, Real::f32);
            const Draws draws = draws_of(in_double, wo, 1 << 13, k);
            double sum = 0, squares = 0, count = 0;
            for (std::size_t i = 0; i < draws.wi.size(); ++i) {
                if (!(draws.pdf[i] > 0)) continue;
                const double off = pdf_at(in_float, wo, draws.wi[i]) / pdf_at(in_double, wo, draws.wi[i]) - 1;
                sum += off;
                squares += off * off;
                ++count;
            }
            const double mean = sum / count, error = std::sqrt(squares) / count;
            EXPECT_LT(std::fabs(mean), 1e-4 + 4 * error) << f.name << " (" << member.text << "): " << error;
        }
    }
}

TEST(Families, AtLeastTwelveForTuningAndSixHeldOut) {
    const auto held_out = std::ranges::count_if(families(), [](const Family& f) { return f.held_out; });
    EXPECT_GE(held_out, 6);
    EXPECT_GE(static_cast<std::ptrdiff_t>(families().size()) - held_out, 12);
}

}  // namespace families_test
}  // namespace crescent::calibration
