// Small samplers with one fault each and the named cause, and faults for which no cause may be named.
#include "check/explain/causes.h"

#include <gtest/gtest.h>

#include "output/format.h"
#include "tests/support/explained.h"

namespace crescent::check {
namespace causes_test {

TEST(CheckCauses, NamesAConstantWithItsMeaning) {
    const Explained r = explained(made(cosine_draw, [](Vec3d o, Vec3d w) { return pi * cosine_pdf(o, w); }));
    expect_cause(r, "constant");
    EXPECT_NE(r.text().find("= pi"), std::string::npos) << r.text();
    EXPECT_NEAR(r.cause->exponent, pi, 0.01);
}

TEST(CheckCauses, NamesAMissingOrRepeatedFactor) {
    expect_cause(explained(made(cosine_draw, [](Vec3d, Vec3d w) { return w.z > 0 ? 1 / pi : 0; })), "cos theta_i");
    expect_cause(explained(made(cosine_draw, [](Vec3d o, Vec3d w) { return cosine_pdf(o, w) * w.z; })), "cos theta_i");
    const auto lobe = [](Vec3d o, const PrimarySample& u) { return power_draw(mirror(o), 20, u); };
    expect_cause(
        explained(made(lobe, [](Vec3d o, Vec3d w) { return 21 * power_pdf(mirror(o), 19, w) / 20; })), "w_i.R");
}

TEST(CheckCauses, NamesNoneForOtherFaults) {
    // A density with a bump, and one with an error of 5 % over an eighth of the sphere.
    const auto bump = [](Vec3d o, Vec3d w) { return cosine_pdf(o, w) * (1 + 0.3 * math::sincos(9 * w.x).sin); };
    const auto patch = [](Vec3d o, Vec3d w) { return cosine_pdf(o, w) * (w.x > 0 && w.y > 0 ? 1.05 : 1.0); };
    for (const decltype(FunctionSampler::p)& p : {decltype(FunctionSampler::p)(bump), {patch}}) {
        const Explained r = explained(made(cosine_draw, p));
        EXPECT_TRUE(r.wrong());
        EXPECT_FALSE(r.cause) << r.text();
    }
}

TEST(CheckCauses, AppearOnceWithTheirVerdict) {
    const Explained r =
        explained(made(cosine_draw, [](Vec3d o, Vec3d w) { return 2 * cosine_pdf(o, w); }), {{10, 0}, {60, 90}});
    int message = 0;
    for (const Verdict& v : r.verdicts())
        if (!v.cause.empty()) {
            ++message;
            EXPECT_EQ(v.name, "normalised");
        }
    EXPECT_EQ(message, 1);
}

TEST(CheckText, PrintsTheSignificantDigits) {
    EXPECT_EQ(with_error(0.975366, 0.0002), "0.9754 +- 0.0002");
    EXPECT_EQ(with_error(3.14163, 0.000123), "3.14163 +- 0.00012");
    EXPECT_EQ(with_error(42.4, 3), "42 +- 3");
    EXPECT_EQ(percent_with_error(0.1234, 0.004), "12.3 % +- 0.4 %");
}

}  // namespace causes_test
}  // namespace crescent::check
