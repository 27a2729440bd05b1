// Whole checks at one w_o of samplers whose verdict is known.
#include "check/decide/check_at.h"

#include <gtest/gtest.h>

#include "check/constants.h"
#include "check/decide/sizes.h"
#include "math/functions.h"
#include "math/simd/frame.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace check_at_test {

/// A cosine sampler with one fault.
struct Cosine : SamplerSource {
    double factor = 1, leak = 0, hole = 0;  // factor on pdf; share of uniform draws; mass of a cap that is never drawn
    double turn = 1;                        // share of the circle over which azimuths are drawn
    bool nothing = false, elsewhere = false;
    std::string name() const override { return "cosine"; }
    Traits traits() const override {
        Traits t;
        t.numbers = 3;
        return t;
    }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            const bool leaks = u[i][2] < leak;
            const double z = leaks ? u[i].x : std::sqrt(u[i].x), r = std::sqrt(1 - z * z);
            const double phi = two_pi * turn * u[i].y;
            Vec3d w{r * std::cos(phi), r * std::sin(phi), z};
            if (w.x * 0.48 + w.y * 0.36 + w.z * 0.8 > 1 - hole / 1.6) {
                w.x = -w.x;
                w.y = -w.y;
            }
            out[i] = {};
            if (!nothing) out[i] = {w, elsewhere ? 1.0 : value(w.z)};
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = value(elsewhere ? -at[i].wi.z : at[i].wi.z);
    }
    double value(double z) const { return z > 0 ? factor * z / 3.14159265358979323846 : 0; }
};

CheckAt checked(const Cosine& s, std::uint32_t seed = 1) {
    return check_sampler_at(s, 0, {0, 0, 1}, {}, CheckBudget::limited(), seed);
}
bool has(const CheckAt& c, std::string_view verdict) {
    for (const Finding& f : c.findings)
        if (info(f.first.family).verdict == verdict) return true;
    for (const SmallFault& f : c.small)
        if (info(f.family).verdict == verdict) return true;
    return false;
}

TEST(CheckAtOneWo, ReportsARightSamplerWithSizes) {
    const CheckAt c = checked({});
    EXPECT_FALSE(c.wrong());
    EXPECT_FALSE(c.inconclusive);
    for (const char* kind : {"constant", "leak", "cap", "rotation", "parameter"}) EXPECT_TRUE(c.sizes.of(kind)) << kind;
    EXPECT_LT(c.sizes.of("constant").value(), target_constant);
    EXPECT_LT(c.sizes.of("leak").value(), target_leak * 4);
    EXPECT_LT(c.evaluations, 500000u);
}

TEST(CheckAtOneWo, GivesTheSameNumbersAgain) {
    const CheckAt a = checked({}), b = checked({});
    EXPECT_EQ(a.integrals.sums[mass].value, b.integrals.sums[mass].value);
    EXPECT_EQ(a.observations.sums[slope].sum, b.observations.sums[slope].sum);
    EXPECT_NE(a.observations.sums[slope].sum, checked({}, 2).observations.sums[slope].sum);
}

TEST(CheckAtOneWo, FindsFaultsAndNamesTheirVerdict) {
    Cosine constant, leak, hole, nothing, elsewhere;
    constant.factor = 1.003;
    leak.leak = 0.02;
    hole.hole = 0.02;
    nothing.nothing = true;
    elsewhere.elsewhere = true;
    EXPECT_TRUE(has(checked(constant), "normalised"));
    EXPECT_TRUE(has(checked(leak), "density"));
    EXPECT_FALSE(has(checked(leak), "normalised"));
    EXPECT_TRUE(has(checked(hole), "density"));
    EXPECT_TRUE(has(checked(nothing), "normalised"));
    EXPECT_TRUE(has(checked(elsewhere), "identity"));
}

TEST(CheckAtOneWo, FindsAnArcThatIsNeverDrawn) {
    Cosine arc;
    arc.turn = 358.0 / 360;
    const CheckAt c = checked(arc);
    const auto band = std::ranges::find(c.findings, Family::band, [](const Finding& f) { return f.first.family; });
    ASSERT_NE(band, c.findings.end());
    // The last of 64 bands covers 5.625 degrees, of which 2 are missing.
    const ChartRect where = rect_of_band(band->first.member);
    EXPECT_EQ(where.phi1, two_pi);
    EXPECT_NEAR(where.phi0, two_pi * 63 / 64, 1e-12);
    EXPECT_NEAR(-band->second.difference / band->second.expected, 2.0 / 5.625, 0.1);
}

/// Number of checks of ten that find a fault of this size.
template <class Break> int found(double size, Break break_by) {
    int out = 0;
    for (std::uint32_t seed = 10; seed < 20; ++seed) {
        Cosine s;
        break_by(s, size);
        out += checked(s, seed).wrong();
    }
    return out;
}
TEST(CheckAtOneWo, FindsFaultsOfTheStatedSizes) {
    const Sizes s = checked({}).sizes;
    EXPECT_GE(found(s.of("constant").value(), [](Cosine& c, double e) { c.factor = 1 + e; }), 7);
    EXPECT_GE(found(s.of("leak").value(), [](Cosine& c, double e) { c.leak = e; }), 7);
    EXPECT_GE(found(s.of("cap").value(), [](Cosine& c, double e) { c.hole = e; }), 7);
}

/// Counts every call. p: a noisy sky, a cosine with a spike of 1/10 of the draws, or a cosine; f = p pi if it has one.
struct Counted : SamplerSource {
    enum Shape { cosine, noise, spike } shape;
    bool with_f, leaks;
    mutable std::uint64_t calls = 0;
    Counted(Shape s, bool f, bool leak) : shape(s), with_f(f), leaks(leak) {}
    std::string name() const override { return "counted"; }
    bool has_f() const override { return with_f; }
    static double noise_at(double x) { return 0.1 + 1.8 * (std::fabs(std::sin(7919 * std::floor(512 * x)))); }
    double value(Vec3d w) const {
        if (!(w.z > 0)) return 0;
        const double even = w.z / 3.14159265358979323846;
        if (shape == cosine) return even;
        if (shape == noise) return even * noise_at(w.z * w.z);
        constexpr double area = two_pi * 1e-7;
        return 0.9 * even + (0.6 * w.x + 0.8 * w.z > 1 - 1e-7 ? 0.1 / area : 0);
    }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        calls += u.size();
        for (std::size_t i = 0; i < u.size(); ++i) {
            Vec3d w = from_chart({1 - std::sqrt(u[i].x), two_pi * u[i].y});
            if (leaks && u[i].y < 0.01) w = from_chart({u[i].x, two_pi * u[i].y});
            if (shape == spike && u[i].y > 0.9) {
                const Vec3d a = from_chart({1e-7 * u[i].x, two_pi * 10 * (u[i].y - 0.9)});
                w = {0.8 * a.x + 0.6 * a.z, a.y, 0.8 * a.z - 0.6 * a.x};
            }
            out[i] = {w, value(w)};
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        calls += at.size();
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = value(at[i].wi);
    }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        calls += at.size();
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = value(at[i].wi) / std::fabs(at[i].wi.z);
    }
};

TEST(CheckAtOneWo, EvaluatesNoMoreThanItsBudget) {
    for (const CheckBudget& budget :
        {CheckBudget::quick(), CheckBudget::limited(), CheckBudget::limited(3e5), CheckBudget::limited(2e5)})
        for (auto shape : {Counted::cosine, Counted::noise, Counted::spike})
            for (bool with_f : {false, true})
                for (bool leaks : {false, true}) {
                    const Counted s(shape, with_f, leaks);
                    const CheckAt c = check_sampler_at(s, 0, {0, 0, 1}, {}, budget, 5);
                    EXPECT_NEAR(static_cast<double>(c.evaluations), static_cast<double>(s.calls), 1000);
                    // A leak is confirmed, which takes as many evaluations again.
                    EXPECT_LE(static_cast<double>(s.calls), (leaks ? 2 : 1) * budget.evaluations)
                        << shape << with_f << leaks;
                    EXPECT_GE(static_cast<double>(s.calls), 0.1 * budget.evaluations) << shape << with_f << leaks;
                }
}

TEST(CheckAtOneWo, FindsNaNAtACornerOfU) {
    struct AtZero : Cosine {
        void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
            Cosine::sample(t, wo, u, out);
            for (std::size_t i = 0; i < u.size(); ++i)
                if (u[i].y == 0) out[i].wi.x = std::numeric_limits<double>::quiet_NaN();
        }
    };
    EXPECT_TRUE(has(check_sampler_at(AtZero{}, 0, {0, 0, 1}, {}, CheckBudget::limited(), 1), "valid"));
}

/// A sampler whose draws have no weight: the mean of f cos / pdf is that of a render.
TEST(CheckAtOneWo, MeasuresTheMeanOfWeightsWhateverTheDensitySays) {
    const auto mean = [](double factor) {
        FunctionSampler s;
        s.p = [factor](Vec3d o, Vec3d w) { return factor * cosine_pdf(o, w); };
        s.f_value = lambert(1);
        return check_sampler_at(s, 0, {0, 0, 1}, {}, CheckBudget::limited(), 1);
    };
    const CheckAt dark = mean(3.1415926535), right = mean(1);
    EXPECT_TRUE(has(dark, "normalised"));
    const auto found = std::ranges::find(dark.findings, Family::mean, [](const Finding& f) { return f.first.family; });
    ASSERT_NE(found, dark.findings.end());
    EXPECT_NEAR(1 + found->second.difference / found->second.expected, 1 / 3.1415926535, 0.01);
    EXPECT_FALSE(right.wrong());
    EXPECT_TRUE(std::ranges::any_of(right.answers, [](const Answer& a) { return a.family == Family::mean; }));
}

TEST(CheckAtOneWo, NeverRequestsADensityThatTheSamplerDoesNotHave) {
    FunctionSampler s;
    s.of.has_pdf = false;
    s.p = [](Vec3d, Vec3d) { return 1.0; };  // of a draw
    s.f_value = lambert(0.5);
    s.weights = [](Vec3d, Vec3d) { return Vec3d{0.5, 0.5, 0.5}; };
    struct WithoutPdf : FunctionSampler {
        using FunctionSampler::FunctionSampler;
        void pdf(int, std::span<const Pair>, std::span<double>) const override { ADD_FAILURE() << "pdf is requested"; }
    } quiet;
    static_cast<FunctionSampler&>(quiet) = s;
    const CheckAt c = check_sampler_at(quiet, 0, {0, 0, 1}, {}, CheckBudget::limited(), 1);
    EXPECT_FALSE(c.wrong());
}

TEST(CheckAtOneWo, GivesNoVerdictOnAnswersThatAreNotNumbers) {
    FunctionSampler s;
    s.f_value = [](Vec3d, Vec3d w) { return w.x > 0.8 ? std::nan("") : lambert(0.5)({}, w); };
    const CheckAt c = check_sampler_at(s, 0, {0, 0, 1}, {}, CheckBudget::limited(), 1);
    EXPECT_TRUE(has(c, "valid"));
    EXPECT_EQ(c.invalid.first, InvalidAnswers::Function::f);
    EXPECT_GT(c.invalid.wi.x, 0.8);
    for (const char* verdict : {"support", "identity", "physics", "mean", "tail"}) EXPECT_TRUE(c.is_withheld(verdict));
    for (const char* verdict : {"valid", "normalised", "density"}) EXPECT_FALSE(c.is_withheld(verdict));
    FunctionSampler none;
    none.p = [](Vec3d, Vec3d) { return std::nan(""); };
    const CheckAt d = check_sampler_at(none, 0, {0, 0, 1}, {}, CheckBudget::limited(), 1);
    EXPECT_TRUE(has(d, "valid"));
    for (const char* verdict : {"normalised", "density", "identity"}) EXPECT_TRUE(d.is_withheld(verdict));
    EXPECT_FALSE(has(d, "identity"));
}

TEST(CheckAtOneWo, HasNoFiniteIntervalForAnInfiniteIntegral) {
    const auto integral = [](double power) {
        FunctionSampler s;
        s.of.wo = Traits::WoDomain::none;
        s.draw = [](Vec3d, const PrimarySample& u) { return from_chart({2 * u.x, two_pi * u.y}); };
        s.p = [power](Vec3d, Vec3d w) {
            return 1 / (2 * two_pi) + 1e-3 * math::exp(-power * math::log(std::max(std::fabs(w.z), 1e-15)));
        };
        return check_sampler_at(s, 0, {0, 0, 1}, {}, CheckBudget::limited(), 1);
    };
    for (double power : {1.0, 2.0}) {
        const CheckAt c = integral(power);
        EXPECT_TRUE(has(c, "normalised") || *c.sizes.integral > inconclusive_at * target_constant) << power;
    }
    EXPECT_LT(*integral(-1).sizes.integral, inconclusive_at * target_constant);
}

/// A sphere seen from the origin, by area; its centre is a unit vector.
struct Sphere {
    Vec3d centre;
    double radius;
    /// To the point at this cosine from the axis to the origin; a share of the turn about it.
    Vec3d direction(double z, double turn) const {
        const double r = std::sqrt(1 - z * z), phi = two_pi * turn;
        const Frame<double> frame = frame_about(-centre);
        return normalize(centre + radius * (r * std::cos(phi) * frame.t + r * std::sin(phi) * frame.b - z * centre));
    }
    /// Of points of the whole sphere, of which those behind draw nothing.
    double pdf(Vec3d w) const {
        const double along = dot(centre, w), h2 = radius * radius - 1 + along * along;
        if (!(along > 0 && h2 > 0)) return 0;
        const double h = std::sqrt(h2), distance = along - h;
        return distance * distance / (h / radius) / (2 * two_pi * radius * radius);
    }
};

/// The front of a sphere by area: at its rim p has a pole of d^(-1/2), whose square has no finite integral.
TEST(CheckAtOneWo, DecidesTheIntegralOfADensityWithAPole) {
    const Sphere sphere{.centre = {0.36, 0.48, 0.8}, .radius = 0.25};
    const double front = 1 - sphere.radius;  // twice its share of the area
    FunctionSampler s;
    s.of.wo = Traits::WoDomain::none;
    s.draw = [=](Vec3d, const PrimarySample& u) { return sphere.direction(sphere.radius + front * u.x, u.y); };
    s.p = [=](Vec3d, Vec3d w) { return sphere.pdf(w) * 2 / front; };
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        const CheckAt c = check_sampler_at(s, 0, {0, 0, 1}, {}, CheckBudget::limited(), seed);
        EXPECT_FALSE(c.wrong()) << seed;
        EXPECT_FALSE(c.inconclusive) << seed;
    }
}

/// Four such spheres, whose back draws nothing: a small budget does not resolve their rims, and a larger tree does.
TEST(CheckAtOneWo, GrowsItsTreeAgainWhereItGoesOnForAnIntegral) {
    const Sphere spheres[] = {{tilt(20), 0.2}, {tilt(50, 100), 0.3}, {tilt(40, 200), 0.15}, {tilt(60, 300), 0.25}};
    FunctionSampler s;
    s.of.wo = Traits::WoDomain::none;
    s.of.numbers = 3;
    s.draw = [&](Vec3d, const PrimarySample& u) -> Vec3d {
        const Sphere& sphere = spheres[static_cast<std::size_t>(4 * u[2])];
        const double z = 1 - 2 * u.x;
        return z < sphere.radius ? Vec3d{} : sphere.direction(z, u.y);
    };
    s.p = [&](Vec3d, Vec3d w) {
        double p = 0;
        for (const Sphere& sphere : spheres) p += sphere.pdf(w) / 4;
        return p;
    };
    CheckBudget budget = CheckBudget::limited();
    budget.most_evaluations = 4e6;
    budget.stop_when_conclusive = true;
    for (std::uint32_t seed = 1; seed <= 2; ++seed) {
        const CheckAt c = check_sampler_at(s, 0, {0, 0, 1}, {}, budget, seed);
        EXPECT_FALSE(c.wrong()) << seed;
        EXPECT_FALSE(c.inconclusive) << seed;
        EXPECT_GT(c.looks, budget.looks) << seed;
    }
}

TEST(CheckAtOneWo, DrawsOfALightBelowTheHorizonNeedADensityThere) {
    FunctionSampler s;
    s.draw = [](Vec3d o, const PrimarySample& u) { return -1.0 * cosine_draw(o, u); };
    s.change = [](const PrimarySample&, Draw& d) { d.pdf = 0.3; };
    s.of.wo = Traits::WoDomain::none;
    EXPECT_TRUE(has(check_sampler_at(s, 0, {0, 0, 1}, {}, CheckBudget::limited(), 1), "identity"));
}

/// A budget that leaves open faults more than ten times their targets.
TEST(CheckAtOneWo, GoesOnWhileASizeIsTooLarge) {
    FunctionSampler s;
    s.of.wo = Traits::WoDomain::none;
    s.draw = [](Vec3d, const PrimarySample& u) { return from_chart({2 * u.x, two_pi * u.y}); };
    s.p = [](Vec3d, Vec3d) { return 1 / (2 * two_pi); };
    CheckBudget small = CheckBudget::limited(3e4), further = small;
    further.most_evaluations = 1e6;
    const CheckAt open = check_sampler_at(s, 0, {0, 0, 1}, {}, small, 1),
                  decided = check_sampler_at(s, 0, {0, 0, 1}, {}, further, 1);
    EXPECT_TRUE(open.inconclusive);
    EXPECT_FALSE(decided.inconclusive);
    EXPECT_FALSE(decided.wrong());
    EXPECT_GT(decided.looks, open.looks);
    EXPECT_LE(decided.evaluations, 1000000u);
}

}  // namespace check_at_test
}  // namespace crescent::check
