// A sampler that returns no samples although f is not 0 does not pass, for any w_o and channels, with a pdf(w) or
// without.
#include <gtest/gtest.h>

#include "check/report/summary.h"
#include "tests/known_samplers/correct/right.h"
#include "tests/support/checked.h"

namespace crescent {
namespace empty_draws_test {

SyntheticSampler draws_nothing(Traits::WoDomain wo, bool has_pdf, int channels) {
    SyntheticSampler r{"nothing", "", {}, {}, {}};
    r.traits.wo = wo;
    r.traits.has_pdf = has_pdf;
    r.traits.channels = channels;
    const bool both = wo != Traits::WoDomain::upper;
    r.pdf = [=](Vec3d, Vec3d) { return has_pdf ? 0.0 : 1.0; };
    const auto f = [=](Vec3d, Vec3d i) { return both || i.z > 0 ? 0.2 / pi : 0.0; };
    if (channels == 1) r.f = f;
    else r.f_channels = [=](Vec3d o, Vec3d i) { return Vec3d{0, f(o, i), 0}; };
    r.sample = [](Vec3d, const PrimarySample&) { return Draw{}; };
    return r;
}

TEST(Nothing, DrawnWhereFIsNotZeroIsNotRight) {
    TestSettings settings;
    settings.budget = check::CheckBudget::limited();
    for (Traits::WoDomain wo : {Traits::WoDomain::upper, Traits::WoDomain::both, Traits::WoDomain::none})
        for (bool has_pdf : {true, false})
            for (int channels : {1, 3})
                for (double theta : {45.0, 135.0}) {
                    if (theta > 90 && wo != Traits::WoDomain::both) continue;
                    const CheckResult j =
                        checked_at(make_adapter(draws_nothing(wo, has_pdf, channels)), theta, settings);
                    EXPECT_EQ(j.state, State::wrong)
                        << static_cast<int>(wo) << has_pdf << channels << " " << theta << what_is_wrong(j);
                    EXPECT_EQ(named(j, has_pdf ? "support" : "mean").state, State::wrong)
                        << static_cast<int>(wo) << has_pdf << channels << " " << theta;
                }
}

}  // namespace empty_draws_test
}  // namespace crescent
