// Small samplers with one fault each and the named cause, and faults for which no cause may be named.
#include "check/explain/causes.h"

#include <gtest/gtest.h>

#include "check/explain/factors.h"
#include "check/explain/text.h"
#include "check/report/sentences.h"
#include "math/simd/frame.h"

namespace crescent::check {
namespace {

constexpr double pi = two_pi / 2;

using Sample = std::function<Vec3d(Vec3d wo, const PrimarySample& u)>;  // {} for no sample
using Density = std::function<double(Vec3d wo, Vec3d wi)>;

struct Made : SamplerAdapter {
    Sample draw;
    Density p;
    Density f_value;
    std::function<Vec3d(Vec3d wo, Vec3d wi)> weights;  // by channel
    Traits of;
    std::string name() const override { return "made"; }
    Traits traits() const override { return of; }
    void sample(int, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            const Vec3d w = draw(wo, u[i]);
            out[i] = dot(w, w) > 0 ? Draw{w, p(wo, w)} : Draw{{0, 0, 1}, 0};
            if (weights && out[i].pdf > 0) out[i].weights = weights(wo, w), out[i].weight = out[i].weights.x;
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = p(at[i].wo, at[i].wi);
    }
    bool has_f() const override { return static_cast<bool>(f_value); }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = f_value(at[i].wo, at[i].wi);
    }
};

Vec3d cosine_draw(Vec3d, const PrimarySample& u) {
    const math::SinCos phi = math::sincos(two_pi * u[1]);
    const double r = std::sqrt(u[0]);
    return {r * phi.cos, r * phi.sin, std::sqrt(1 - u[0])};
}
double cosine_pdf(Vec3d, Vec3d w) { return std::max(w.z, 0.0) / pi; }

/// cos^s about an axis.
Vec3d power_draw(Vec3d axis, double s, const PrimarySample& u) {
    const double c = math::exp(math::log(1 - u[0]) / (s + 1)), r = std::sqrt(1 - c * c);
    const math::SinCos phi = math::sincos(two_pi * u[1]);
    return frame_about(axis).to_world({r * phi.cos, r * phi.sin, c});
}
double power_pdf(Vec3d axis, double s, Vec3d w) {
    const double c = dot(axis, w);
    return c > 0 ? (s + 1) / two_pi * math::exp(s * math::log(c)) : 0;
}

struct Result {
    bool wrong = false;
    std::optional<Cause> cause;
    std::vector<Verdict> verdicts;
    std::string text() const { return cause ? cause->factor + ": " + cause->text : "none"; }
};
Result checked(Made made, std::vector<std::pair<double, double>> directions = {{40, 30}}) {
    const auto adapter = std::make_shared<Made>(std::move(made));
    std::vector<CheckCase> check_cases;
    for (const auto& [theta, azimuth] : directions) {
        CheckCase t;
        t.arm = "made", t.wo = tilt(theta, azimuth), t.theta_deg = theta, t.azimuth_deg = azimuth, t.adapter = adapter;
        check_cases.push_back(t);
    }
    CheckSettings settings;
    settings.budget = CheckBudget::limited();
    ProgressMonitor monitor;
    const auto all = check_samplers(check_cases, settings, monitor);
    Result out{all.at(0).wrong(), {}, {}};
    if (out.wrong) out.cause = cause_of(check_cases, all[0]);
    out.verdicts = verdicts_of(check_cases, all[0], out.cause);
    return out;
}
Made made(Sample draw, Density p, int numbers = 2, Traits::WoDomain wo = Traits::WoDomain::upper) {
    Made out;
    out.draw = std::move(draw), out.p = std::move(p), out.of.numbers = numbers, out.of.wo = wo;
    return out;
}

void expect_cause(const Result& r, const char* factor) {
    EXPECT_TRUE(r.wrong);
    EXPECT_TRUE(r.cause && r.cause->factor == factor) << "expected " << factor << ", got " << r.text();
}

TEST(CheckCauses, NamesAConstantWithItsMeaning) {
    const Result r = checked(made(cosine_draw, [](Vec3d o, Vec3d w) { return pi * cosine_pdf(o, w); }));
    expect_cause(r, "constant");
    EXPECT_NE(r.text().find("= pi"), std::string::npos) << r.text();
    EXPECT_NEAR(r.cause->exponent, pi, 0.01);
}

TEST(CheckCauses, NamesAMissingOrRepeatedFactor) {
    expect_cause(checked(made(cosine_draw, [](Vec3d, Vec3d w) { return w.z > 0 ? 1 / pi : 0; })), "cos theta_i");
    expect_cause(checked(made(cosine_draw, [](Vec3d o, Vec3d w) { return cosine_pdf(o, w) * w.z; })), "cos theta_i");
    const auto lobe = [](Vec3d o, const PrimarySample& u) { return power_draw(mirror(o), 20, u); };
    expect_cause(checked(made(lobe, [](Vec3d o, Vec3d w) { return 21 * power_pdf(mirror(o), 19, w) / 20; })), "w_i.R");
}

TEST(CheckCauses, NamesAMirroredFrame) {
    const auto mirrored = [](Vec3d o, const PrimarySample& u) {
        return power_draw(mirror(Vec3d{o.x, -o.y, o.z}), 30, u);
    };
    const Result r =
        checked(made(mirrored, [](Vec3d o, Vec3d w) { return power_pdf(mirror(o), 30, w); }), {{40, 50}, {60, 200}});
    ASSERT_TRUE(r.cause);
    EXPECT_NE(r.text().find("mirrored in y"), std::string::npos) << r.text();
}

TEST(CheckCauses, MeasuresATurn) {
    const Vec3d axis = tilt(50, 20), off = tilt(53, 20);
    const auto adapter =
        std::make_shared<Made>(made([off](Vec3d, const PrimarySample& u) { return power_draw(off, 50, u); },
            [axis](Vec3d, Vec3d w) { return power_pdf(axis, 50, w); }, 2, Traits::WoDomain::none));
    CheckCase t;
    t.arm = "made", t.wo = {0, 0, 1}, t.adapter = adapter;
    CheckSettings settings;
    settings.budget = CheckBudget::limited();
    ProgressMonitor monitor;
    const auto all = check_samplers({&t, 1}, settings, monitor);
    const std::vector<Place> places = places_of({&t, 1}, all.at(0), 2, 4096);
    ASSERT_EQ(places.size(), 1u);
    const auto turn = turn_hypothesis(places);
    ASSERT_TRUE(turn);
    const Vec3d by = turn->turns[0].by;
    EXPECT_NEAR(std::sqrt(dot(by, by)), 3 * pi / 180, 5 * turn->turns[0].error);
    EXPECT_LT(turn->turns[0].error, 0.01);
    EXPECT_NEAR(dot(by, cross(axis, off)) / (std::sqrt(dot(by, by)) * std::sin(3 * pi / 180)), 1, 0.2);
}

TEST(CheckCauses, NamesTheChooserOfLobes) {
    const Vec3d a = tilt(20, 0), b = tilt(60, 120);
    const auto draw = [a, b](Vec3d, const PrimarySample& u) { return power_draw(u[2] < 0.3 ? a : b, 40, u); };
    const Result r = checked(made(
        draw, [a, b](Vec3d, Vec3d w) { return (power_pdf(a, 40, w) + power_pdf(b, 40, w)) / 2; }, 3,
        Traits::WoDomain::none));
    expect_cause(r, "chooser");
    EXPECT_NE(r.text().find("0.3, 0.7"), std::string::npos) << r.text();
}

TEST(CheckCauses, MeasuresALeak) {
    const auto draw = [](Vec3d, const PrimarySample& u) {
        return u[2] < 0.02 ? from_chart({u[0], two_pi * u[1]}) : power_draw({0, 0, 1}, 50, u);
    };
    const Result r = checked(made(draw, [](Vec3d, Vec3d w) { return power_pdf({0, 0, 1}, 50, w); }, 3));
    expect_cause(r, "leak");
    EXPECT_NEAR(r.cause ? r.cause->exponent : 0, 0.02, 0.004) << r.text();
}

TEST(CheckCauses, ReportsANumberWithoutEffect) {
    const auto draw = [](Vec3d o, const PrimarySample& u) { return cosine_draw(o, PrimarySample{u[0], 0.3}); };
    const Result r = checked(made(draw, cosine_pdf));
    expect_cause(r, "curve");
    EXPECT_NE(r.text().find("u2 has no effect"), std::string::npos);
}

TEST(CheckCauses, ReportsPositivePWithoutDraws) {
    const double density = 1 / (two_pi * 0.05);
    const auto draw = [](Vec3d, const PrimarySample& u) { return from_chart({0.05 * u[0], two_pi * u[1]}); };
    const Result r = checked(made(draw, [density](Vec3d, Vec3d) { return density; }, 2, Traits::WoDomain::none));
    expect_cause(r, "unreached");
}

TEST(CheckCauses, NamesTheFaultOfWeights) {
    Made m = made(cosine_draw, cosine_pdf);
    m.f_value = [](Vec3d, Vec3d w) { return w.z > 0 ? 0.5 / pi : 0; };
    m.weights = [](Vec3d, Vec3d w) { return Vec3d{0.5 / w.z, 0, 0}; };
    Result r = checked(m);
    expect_cause(r, "cos theta_i");
    EXPECT_NE(r.text().find("over cos theta_i"), std::string::npos) << r.text();
    m.weights = [](Vec3d, Vec3d) { return Vec3d{0.25, 0, 0}; };
    r = checked(m);
    expect_cause(r, "constant");
    EXPECT_NE(r.text().find("0.5 = 1/2"), std::string::npos) << r.text();
}

TEST(CheckCauses, NamesNoneForOtherFaults) {
    // A density with a bump, and one with an error of 5 % over an eighth of the sphere.
    const auto bump = [](Vec3d o, Vec3d w) { return cosine_pdf(o, w) * (1 + 0.3 * math::sincos(9 * w.x).sin); };
    const auto patch = [](Vec3d o, Vec3d w) { return cosine_pdf(o, w) * (w.x > 0 && w.y > 0 ? 1.05 : 1.0); };
    for (const Density& p : {Density(bump), Density(patch)}) {
        const Result r = checked(made(cosine_draw, p));
        EXPECT_TRUE(r.wrong);
        EXPECT_FALSE(r.cause) << r.text();
    }
}

TEST(CheckCauses, AppearOnceWithTheirVerdict) {
    const Result r =
        checked(made(cosine_draw, [](Vec3d o, Vec3d w) { return 2 * cosine_pdf(o, w); }), {{10, 0}, {60, 90}});
    int message = 0;
    for (const Verdict& v : r.verdicts)
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
    EXPECT_EQ(percent(0.1234, 0.004), "12.3 % +- 0.4 %");
}

}  // namespace
}  // namespace crescent::check
