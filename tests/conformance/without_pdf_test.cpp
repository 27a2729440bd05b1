// Samplers without pdf(w): random estimates are tested for their means, and draws to lights from several sides; if no
// comparison is possible, that is reported.
#include <cmath>
#include <gtest/gtest.h>

#include "check/check.h"
#include "check/report/html.h"
#include "check/report/print.h"
#include "check/report/summary.h"
#include "check/sources/cases.h"
#include "math/functions.h"
#include "tests/known_samplers/correct/right.h"
#include "tests/support/checked.h"
#include "tests/support/wellformed.h"

namespace crescent {
namespace without_pdf_test {

TestSettings limited() {
    TestSettings settings;
    settings.budget = check::CheckBudget::limited();
    return settings;
}

CheckResult checked(const SyntheticSampler& recipe, double theta = 45) {
    return checked_at(make_adapter(recipe), theta, limited());
}

Vec3d cosine(double u1, double u2) { return math::spherical(std::sqrt(u1), std::sqrt(1 - u1), 2 * pi * u2); }

/// Lambert of 0.5 whose f is a random walk's estimate, between 0.1 and 0.9; its weights are estimates too, `scale`
/// times the correct ones.
SyntheticSampler by_walk(double scale, bool own, int channels = 1) {
    SyntheticSampler r{"walk", "", {}, {}, {}};
    r.traits.has_pdf = false;
    r.traits.own_random = own;
    r.traits.numbers = 3;
    r.traits.channels = channels;
    const auto dice = std::make_shared<Rng>(7);
    r.pdf = [](Vec3d, Vec3d) { return 1.0; };
    const auto f = [dice](Vec3d, Vec3d i) { return i.z > 0 ? dice->uniform(0.1, 0.9) / pi : 0; };
    if (channels == 1) r.f = f;
    else
        r.f_channels = [f](Vec3d o, Vec3d i) {
            const double v = f(o, i);
            return Vec3d{v, v, v};
        };
    r.sample = [scale, own, dice, channels](Vec3d, const PrimarySample& u) {
        Draw d{cosine(u[0], u[1]), 1};
        const double w = 0.1 + 0.8 * (own ? dice->uniform(0, 1) : u[2]);
        d.weight = scale * w;
        if (channels == 3) {
            d.weights = {w, w, scale * w};
            d.weight = luminance(d.weights);
        }
        return d;
    };
    return r;
}

TEST(WithoutAPdf, EstimatesOfFAreHeldToTheirMeansAlone) {
    for (bool own : {false, true})
        for (int channels : {1, 3}) {
            const CheckResult right = checked(by_walk(1, own, channels));
            EXPECT_EQ(right.state, State::right) << own << channels << what_is_wrong(right);
            const CheckResult wrong = checked(by_walk(1.1, own, channels));
            EXPECT_EQ(wrong.state, State::wrong) << own << channels << what_is_wrong(wrong);
        }
}

/// Of two cosine draws one is kept, by f or by its root; the weight is the mean of both.
SyntheticSampler resampled(bool by_root) {
    SyntheticSampler r{"resampled", "", {}, {}, {}};
    r.traits.has_pdf = false;
    r.traits.numbers = 5;
    r.pdf = [](Vec3d, Vec3d) { return 1.0; };
    r.f = [](Vec3d o, Vec3d i) {
        if (!(i.z > 0)) return 0.0;
        return 0.1 / pi + 0.5 * 8 / (2 * pi) * math::pow(std::max(dot(i, {-o.x, -o.y, o.z}), 0.0), 6);
    };
    r.sample = [f = r.f, by_root](Vec3d o, const PrimarySample& u) {
        const Vec3d one = cosine(u[0], u[1]), two = cosine(u[2], u[3]);
        const double a = pi * f(o, one), b = pi * f(o, two);
        const double q = by_root ? std::sqrt(a) / (std::sqrt(a) + std::sqrt(b)) : a / (a + b);
        Draw d{u[4] < q ? one : two, 1};
        d.weight = 0.5 * (a + b);
        return d;
    };
    return r;
}

TEST(WithoutAPdf, DrawsThatContradictWeightsAreFound) {
    const CheckResult right = checked(resampled(false)), wrong = checked(resampled(true));
    EXPECT_EQ(right.state, State::right) << what_is_wrong(right);
    EXPECT_EQ(named(wrong, "mean").state, State::wrong) << named(wrong, "mean").message();
    EXPECT_EQ(named(wrong, "physics").state, State::right) << named(wrong, "physics").message();
}

TEST(WithoutAPdf, NorAWeightNothingIsCalledRight) {
    SyntheticSampler r{"bare", "", {}, {}, {}};
    r.traits.has_pdf = false;
    r.pdf = [](Vec3d, Vec3d) { return 1.0; };
    r.f = [](Vec3d, Vec3d i) { return i.z > 0 ? 0.5 / pi : 0; };
    r.sample = [](Vec3d, const PrimarySample& u) { return Draw{cosine(u[0], u[1]), 1}; };
    const CheckResult j = checked(r);
    EXPECT_EQ(j.state, State::inconclusive);
    const Verdict& v = named(j, "density");
    EXPECT_NE(v.message().find("could not be examined"), std::string::npos) << v.message();
    EXPECT_NE(v.next_step.find("weight=yes"), std::string::npos) << v.next_step;
}

/// (k+1)/(2 pi) cos^k about n, without a pdf, with a weight; `halves`: one number selects it or the cosine.
SyntheticSampler power_lobe(double k, bool halves) {
    SyntheticSampler r{"power", "", {}, {}, {}};
    r.traits.has_pdf = false;
    r.traits.numbers = halves ? 3 : 2;
    r.pdf = [](Vec3d, Vec3d) { return 1.0; };
    r.f = [](Vec3d, Vec3d i) { return i.z > 0 ? 0.5 / pi : 0; };
    r.sample = [=](Vec3d, const PrimarySample& u) {
        const bool by_cosine = halves && u[2] < 0.5;
        const double z = by_cosine ? std::sqrt(1 - u[0]) : math::pow(1 - u[0], 1 / (k + 1));
        const double lobe = (k + 1) / (2 * pi) * math::pow(z, k);
        Draw d{math::spherical(z, 2 * pi * u[1]), 1};
        d.weight = 0.5 / pi * z / (halves ? 0.5 * lobe + 0.5 * z / pi : lobe);
        return d;
    };
    return r;
}

CheckResult pictured(const SyntheticSampler& recipe) {
    TestSettings settings;
    settings.pictures = true;
    return checked_at(make_adapter(recipe), 45, settings);
}

TEST(WithoutAPdf, ThePeakIsStatedWithItsStandardError) {
    constexpr double k = 20, top = (k + 1) / (2 * pi);
    for (bool halves : {false, true}) {
        const CheckResult j = pictured(power_lobe(k, halves));
        const Verdict& v = named(j, "density");
        const double due = halves ? top / 2 + 0.5 / pi : top, peak = v.evidence["implied_peak"]["pdf"].get<double>(),
                     se = v.evidence["implied_peak"]["standard_error"].get<double>();
        EXPECT_GT(se, 0);
        EXPECT_LT(se, 0.15 * peak) << "a cell of a handful of draws";
        EXPECT_NEAR(peak, due, 0.05 * due + 4 * se) << v.message();
        EXPECT_NE(v.message().find(" +- "), std::string::npos) << v.message();
    }
}

/// Cells cover the sphere, and their contents sum to one.
TEST(WithoutAPdf, TheImpliedDensityIntegratesToOne) {
    const CheckResult j = pictured(power_lobe(20, true));
    double area = 0, mass = 0;
    for (const auto& row : named(j, "density").evidence["implied_bins"]["rows"]) {
        const auto at = [&](int k) { return row[static_cast<std::size_t>(k)].get<double>(); };
        const double solid_angle = (at(1) - at(0)) * (at(3) - at(2));
        area += solid_angle;
        mass += solid_angle * at(4);
    }
    EXPECT_NEAR(area, 4 * pi, 1e-9);
    EXPECT_NEAR(mass, 1, 1e-9);
}

/// The mean over each ring equals that of the lobe there, to five standard errors.
TEST(WithoutAPdf, TheImpliedDensityStandsByRings) {
    constexpr double k = 20;
    const CheckResult j = pictured(power_lobe(k, false));
    const auto rows = named(j, "density").evidence["implied_rings"]["rows"];
    EXPECT_EQ(rows.size(), 18u);
    for (const auto& row : rows) {
        const double high = math::cos(row[0].get<double>() * pi / 180),
                     low = math::cos(row[1].get<double>() * pi / 180);
        const double due = (math::pow(high, k + 1) - math::pow(std::max(low, 0.0), k + 1)) / (2 * pi * (high - low));
        EXPECT_NEAR(row[2].get<double>(), due, 5 * row[3].get<double>() + 1e-3) << row[0];
    }
}

TEST(WithoutAPdf, ReportHasOneMapAndATable) {
    const CheckResult j = pictured(power_lobe(20, false));
    const std::string page = verdict_html(j), text = verdict_table(j);
    EXPECT_EQ(testing::xml_error(page), "");
    EXPECT_EQ(page.find("<figcaption>Expected"), std::string::npos) << "a copy of what was observed";
    EXPECT_EQ(page.find("furthest off"), std::string::npos);
    EXPECT_EQ(page.find("<polyline class=\"rose-p\""), std::string::npos) << "p is not known";
    EXPECT_NE(page.find("<figcaption>Density of the draws"), std::string::npos);
    EXPECT_NE(page.find("implied density, mean over the ring"), std::string::npos);
    EXPECT_NE(text.find("The density that the draws imply"), std::string::npos) << text;
    EXPECT_NE(text.find("0 to 15"), std::string::npos) << text;
}

}  // namespace without_pdf_test
}  // namespace crescent
