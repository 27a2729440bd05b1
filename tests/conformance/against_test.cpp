// Comparison of two samplers: equal ones are not reported as different, differences are found, and the ratio of
// variances has its interval.
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>

#include "check/against.h"
#include "check/check.h"
#include "check/sources/sample_file.h"
#include "tests/known_samplers/correct/right.h"
#include "tests/support/checked.h"
#include "tests/support/sanitized.h"

namespace crescent {
namespace against_test {

std::vector<CheckCase> check_cases(const std::string& arm, const std::string& brdf, double theta) {
    std::vector<CheckCase> all = make_cases(arm, {}, false, {{theta, 40}});
    std::erase_if(all, [&](const CheckCase& t) { return t.brdf != brdf || t.lighting != "fill"; });
    all.resize(1);
    return all;
}

CheckResult against(
    std::span<const CheckCase> a, std::span<const CheckCase> b, bool expect_same = false, std::uint32_t seed = 1) {
    ProgressMonitor monitor;
    TestSettings settings;
    settings.budget = check::CheckBudget::limited();
    settings.seed = seed;
    return compare_samplers(a, b, settings, expect_same, monitor);
}

TEST(Against, ItselfNothingIsToldApart) {
    const std::vector<CheckCase> a = check_cases("cosine", "Lambert + GGX", 60);
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        const CheckResult j = against(a, sampler_named_against("cosine", a), true, seed);
        EXPECT_EQ(j.state, State::right) << against_text(j);
        const Verdict& v = named(j, "variance");
        EXPECT_LT(v.evidence["interval"][0].get<double>(), 1.1) << v.message();
        EXPECT_GT(v.evidence["interval"][1].get<double>(), 0.9) << v.message();
    }
}

TEST(Against, EqualDistributionsAreNotDistinguished) {
    const std::vector<CheckCase> a = check_cases("cosine", "Lambert", 45);
    SyntheticSampler r{"cosine by rejection", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d wi) { return std::max(wi.z, 0.0) / pi; };
    r.f = [](Vec3d wo, Vec3d wi) { return wo.z > 0 && wi.z > 0 ? 0.5 / pi : 0.0; };
    r.sample = [](Vec3d, Vec2d u) {  // in the opposite rotation to the built-in sampler's
        const double rad = std::sqrt(1 - u.y), phi = -2 * pi * u.x, z = std::sqrt(u.y);
        return Draw{{rad * std::cos(phi), rad * std::sin(phi), z}, z / pi, {}, {}};
    };
    const CheckResult j = against(a, sampler_against(make_adapter(r), a), true);
    EXPECT_EQ(named(j, "same_distribution").state, State::right) << against_text(j);
    EXPECT_EQ(named(j, "same_f").state, State::right) << against_text(j);
}

/// Only two delta parts: the mirror direction with probability q, and straight through.
SyntheticSampler mirror_or_straight(double q) {
    SyntheticSampler r{"mirror or straight", "", {}, {}, {}};
    r.traits.numbers = 3;
    r.traits.delta = true;
    r.traits.wo = Traits::WoDomain::both;
    r.pdf = [](Vec3d, Vec3d) { return 0.0; };
    r.f = [](Vec3d, Vec3d) { return 0.0; };
    r.sample = [q](Vec3d wo, const PrimarySample& u) {
        const bool mirrored = u[2] < q;
        Draw d{mirrored ? Vec3d{-wo.x, -wo.y, wo.z} : -wo, 0};
        d.delta = mirrored ? q : 1 - q;
        d.weight = 0.5 / d.delta;
        return d;
    };
    return r;
}

/// Mirrors the fraction `mirrored` of the draws, a delta part, and draws the cosine otherwise.
SyntheticSampler part_mirror(double mirrored) {
    SyntheticSampler r{"part mirror", "", {}, {}, {}};
    r.traits.numbers = 3;
    r.traits.delta = true;
    r.pdf = [=](Vec3d, Vec3d wi) { return (1 - mirrored) * std::max(wi.z, 0.0) / pi; };
    r.f = [](Vec3d wo, Vec3d wi) { return wo.z > 0 && wi.z > 0 ? 0.5 / pi : 0.0; };
    r.sample = [=](Vec3d wo, const PrimarySample& u) {
        const double rad = std::sqrt(u.x), phi = 2 * pi * u.y, z = std::sqrt(1 - u.x);
        Draw d{{rad * std::cos(phi), rad * std::sin(phi), z}, (1 - mirrored) * z / pi};
        d.weight = 0.5 / (1 - mirrored);
        if (u[2] >= mirrored) return d;
        d = {{-wo.x, -wo.y, wo.z}, 0};
        d.delta = mirrored;
        d.weight = 0.1 / mirrored;
        return d;
    };
    return r;
}

TEST(Against, PassStatesTheDetectableDifference) {
    const std::vector<CheckCase> a = check_cases("cosine", "Lambert", 45);
    const Verdict v = named(against(a, sampler_named_against("cosine", a)), "same_distribution");
    const double part = v.evidence["would_have_found"]["part"].get<double>(),
                 distance = v.evidence["would_have_found"]["distance"].get<double>();
    EXPECT_LT(part, 0.03) << v.message();
    EXPECT_LT(distance, 0.01) << v.message();
    // A difference of the stated size is found: draws rotated by 1.5 times that distance of their mean.
    SyntheticSampler turned{"turned", "", {}, {}, {}};
    const double angle = 1.5 * distance / (2.0 / 3);
    turned.pdf = [=](Vec3d, Vec3d wi) { return std::max(-std::sin(angle) * wi.x + std::cos(angle) * wi.z, 0.0) / pi; };
    turned.sample = [=](Vec3d, Vec2d u) {
        const double z = std::sqrt(1 - u.x), r = std::sqrt(u.x), x = r * std::cos(2 * pi * u.y);
        const Vec3d wi{x * std::cos(angle) - z * std::sin(angle), r * std::sin(2 * pi * u.y),
            x * std::sin(angle) + z * std::cos(angle)};
        return Draw{wi, z / pi, {}, {}};
    };
    const CheckResult j = against(a, sampler_against(make_adapter(turned), a), true);
    EXPECT_EQ(named(j, "same_distribution").state, State::wrong) << against_text(j);
}

/// Samplers with only delta parts are distinguished by them.
TEST(Against, DifferentDeltaProbabilitiesAreFound) {
    const std::vector<CheckCase> a = {make_user_case(make_adapter(part_mirror(0.5)), 45, 130)};
    const auto against_one = [&](double mirrored) {
        return against(a, sampler_against(make_adapter(part_mirror(mirrored)), a), true);
    };
    EXPECT_EQ(named(against_one(0.5), "same_distribution").state, State::right);
    EXPECT_EQ(named(against_one(0.55), "same_distribution").state, State::wrong);
    const std::vector<CheckCase> glass = {make_user_case(make_adapter(mirror_or_straight(0.5)), 45, 130)};
    const auto of_parts = [&](double q) {
        return against(glass, sampler_against(make_adapter(mirror_or_straight(q)), glass), true);
    };
    EXPECT_EQ(named(of_parts(0.5), "same_distribution").state, State::right);
    EXPECT_EQ(named(of_parts(0.6), "same_distribution").state, State::wrong);
}

TEST(Against, ABetterOneIsSaidToBeSoWithItsInterval) {
    const std::vector<CheckCase> a = check_cases("uniform", "Lambert + Phong", 45);
    const std::vector<CheckCase> b = sampler_named_against("mixture", a);
    const CheckResult describe = against(a, b), expected = against(a, b, true);
    EXPECT_EQ(describe.state, State::right) << against_text(describe);
    EXPECT_FALSE(named(describe, "same_distribution").evidence.value("same", true));
    EXPECT_EQ(expected.state, State::wrong);
    const Verdict& v = named(describe, "variance");
    EXPECT_NE(v.message().find("B is better here"), std::string::npos) << v.message();
    EXPECT_GT(v.evidence["interval"][0].get<double>(), 1);
    const CheckResult reverse = against(b, a);
    const Verdict& back = named(reverse, "variance");
    EXPECT_NE(back.message().find("A is better here"), std::string::npos) << back.message();
    EXPECT_LT(back.evidence["ratio"].get<double>() * v.evidence["ratio"].get<double>(), 1.3);
}

/// Returns 20,000 draws of cosine, w_o 45 deg, f = `albedo` / pi; p as 128 x 8 points.
std::shared_ptr<const SamplerAdapter> written_samples(double albedo, bool with_f) {
    const std::string samples = testing::TempDir() + "against_samples.csv",
                      table = testing::TempDir() + "against_p.csv";
    Rng dice(5);
    std::ofstream s(samples), t(table);
    s << "u1,u2,wix,wiy,wiz,pdf" << (with_f ? ",f\n" : "\n");
    for (int i = 0; i < 20000; ++i) {
        const double u = dice.uniform(0, 1), v = dice.uniform(0, 1), z = std::sqrt(1 - u), r = std::sqrt(u);
        s << fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", u, v, r * std::cos(2 * pi * v),
            r * std::sin(2 * pi * v), z, z / pi);
        s << (with_f ? fmt::format(",{:.9g}\n", albedo / pi * (0.2 + 0.8 * z)) : "\n");
    }
    t << "cos_theta,phi,pdf\n";
    for (int i = 0; i < 128; ++i)
        for (int k = 0; k < 8; ++k)
            t << fmt::format("{:.9g},{:.9g},{:.9g}\n", i / 127.0, 2 * pi * k / 8, i / 127.0 / pi);
    s.close();
    t.close();
    return std::make_shared<SampleFile>(samples, table);
}

/// f = `albedo` / pi (0.2 + 0.8 cos), drawn uniformly over the upper half.
std::shared_ptr<const SamplerAdapter> even_with(double albedo) {
    SyntheticSampler r{"even", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d wi) { return wi.z > 0 ? 1 / (2 * pi) : 0.0; };
    r.f = [albedo](Vec3d, Vec3d wi) { return wi.z > 0 ? albedo / pi * (0.2 + 0.8 * wi.z) : 0.0; };
    r.sample = [](Vec3d, Vec2d u) { return Draw{about({0, 0, 1}, u.x, u.y), 1 / (2 * pi), {}, {}}; };
    return make_adapter(r);
}

TEST(Against, AFileOfSamplesWithFIsComparedAtItsDraws) {
    const std::vector<CheckCase> a = {make_user_case(written_samples(0.5, true), 45, 0)};
    const CheckResult right = against(a, sampler_against(even_with(0.5), a)),
                      other = against(a, sampler_against(even_with(0.55), a)),
                      arm = against(a, sampler_named_against("uniform", a));
    EXPECT_EQ(named(right, "same_f").state, State::right) << against_text(right);
    EXPECT_FALSE(named(other, "same_f").evidence.value("same", true)) << against_text(other);
    EXPECT_EQ(named(other, "variance").state, State::skipped) << against_text(other);
    // X_A = 0.5 (0.2 + 0.8 z) and X_B = z X_A; z^2 is uniform under A, z under B.
    const double var_a = 0.16 * (0.5 - 4.0 / 9), mean = 0.1 + 0.8 / 3,
                 square = 4 * 0.25 * (0.04 / 3 + 0.32 / 4 + 0.64 / 5), ratio = var_a / (square - mean * mean);
    for (const CheckResult* j : {&right, &arm}) {
        const Verdict& v = named(*j, "variance");
        ASSERT_EQ(v.state, State::right) << against_text(*j);
        EXPECT_LT(v.evidence["interval"][0].get<double>(), 1.05 * ratio) << v.message();
        EXPECT_GT(v.evidence["interval"][1].get<double>(), 0.95 * ratio) << v.message();
        EXPECT_NE(v.message().find("A is better here"), std::string::npos) << v.message();
    }
    EXPECT_EQ(named(arm, "same_f").state, State::skipped);
}

TEST(Against, AFileOfSamplesWithoutFSaysSo) {
    const std::vector<CheckCase> a = {make_user_case(written_samples(0.5, false), 45, 0)};
    const CheckResult j = against(a, sampler_against(even_with(0.5), a));
    for (const char* name : {"same_f", "variance"}) {
        EXPECT_EQ(named(j, name).state, State::skipped);
        EXPECT_NE(named(j, name).message().find("column f"), std::string::npos) << named(j, name).message();
    }
}

/// Lambert of `albedo`, drawn by the cosine; the stated p is `describe` times the true one.
std::shared_ptr<const SamplerAdapter> lambert(double albedo, double describe = 1) {
    SyntheticSampler r{"cosine", "", {}, {}, {}};
    r.pdf = [describe](Vec3d, Vec3d wi) { return describe * std::max(wi.z, 0.0) / pi; };
    r.f = [albedo](Vec3d wo, Vec3d wi) { return wo.z > 0 && wi.z > 0 ? albedo / pi : 0.0; };
    r.sample = [describe](Vec3d, Vec2d u) {
        const double rad = std::sqrt(u.x), phi = 2 * pi * u.y, z = std::sqrt(1 - u.x);
        return Draw{{rad * std::cos(phi), rad * std::sin(phi), z}, describe * z / pi, {}, {}};
    };
    return make_adapter(r);
}

TEST(Against, DifferentFIsReportedAndCanFail) {
    const std::vector<CheckCase> a = check_cases("cosine", "Lambert", 45), b = sampler_against(lambert(0.505), a);
    const CheckResult describe = against(a, b), expected = against(a, b, true);
    EXPECT_EQ(describe.state, State::right) << against_text(describe);
    const Verdict& f = named(describe, "same_f");
    EXPECT_EQ(f.state, State::right);
    EXPECT_FALSE(f.evidence.value("same", true));
    EXPECT_NEAR(f.evidence["largest_relative"].get<double>(), 0.005 / 0.505, 1e-6);
    EXPECT_NE(f.message().find("0.9901 times"), std::string::npos) << f.message();
    EXPECT_EQ(named(describe, "variance").state, State::skipped) << against_text(describe);
    EXPECT_EQ(expected.state, State::wrong);
    EXPECT_EQ(named(expected, "same_f").state, State::wrong) << against_text(expected);
}

TEST(Against, AHeavyTailIsInconclusive) {
    const std::vector<CheckCase> phong = check_cases("phong", "Lambert + Phong", 0);
    const Verdict v = named(against(phong, sampler_named_against("cosine", phong)), "variance");
    EXPECT_EQ(v.state, State::inconclusive) << v.message();
    EXPECT_NE(v.message().find("heavy tail"), std::string::npos) << v.message();
    EXPECT_EQ(v.next.kind, NextStep::Kind::heavier_pdf);
}

/// Every weight of cosine on Lambert is the albedo; only rounding remains, which is not ranked.
TEST(Against, TwoSamplersWithoutVarianceAreNotRanked) {
    const std::vector<CheckCase> a = check_cases("cosine", "Lambert", 45);
    for (const auto& b : {sampler_named_against("cosine", a), sampler_against(lambert(0.5), a)}) {
        const Verdict v = named(against(a, b), "variance");
        EXPECT_EQ(v.state, State::right);
        EXPECT_NE(v.message().find("Neither has a variance"), std::string::npos) << v.message();
        EXPECT_EQ(v.message().find("better"), std::string::npos) << v.message();
    }
    const Verdict one = named(against(a, sampler_named_against("uniform", a)), "variance");
    EXPECT_EQ(one.evidence.value("better", "?"), "A") << one.message();
}

/// Of 48 pairs, one in twenty has an interval without 1.
TEST(Against, ItselfIsNeverBetter) {
    const std::vector<CheckCase> a = check_cases("cosine", "Lambert + GGX", 60),
                                 even = check_cases("uniform", "Lambert", 45);
    for (std::uint32_t seed = 1; seed <= 24; seed += test::every)
        for (const auto& [one, arm] : {std::pair(&a, "cosine"), {&even, "uniform"}}) {
            const Verdict v = named(against(*one, sampler_named_against(arm, *one), false, seed), "variance");
            EXPECT_EQ(v.evidence.value("better", "none"), "none") << seed << ": " << v.message();
        }
}

/// A p stated as 0.9 of the true one gives weights of 1.11 of the light, whose variance is not that of an estimate of
/// the integral.
TEST(Against, AWrongOneIsNotRanked) {
    const std::vector<CheckCase> a = check_cases("uniform", "Lambert", 45);
    const CheckResult j = against(a, sampler_against(lambert(0.5, 0.9), a));
    const Verdict& v = named(j, "variance");
    EXPECT_EQ(v.state, State::skipped) << against_text(j);
    EXPECT_NE(v.message().find("B is wrong itself, by normalised"), std::string::npos) << v.message();
    EXPECT_FALSE(v.evidence.contains("ratio"));
}

/// A mirror coat over Lambert: q = 1/4, and the mirror's reflectance.
std::shared_ptr<const SamplerAdapter> coated(double mirror_reflects) {
    SyntheticSampler r{"coat", "", {}, {}, {}};
    r.traits.numbers = 3;
    r.traits.delta = true;
    r.pdf = [](Vec3d, Vec3d wi) { return 0.75 * std::max(wi.z, 0.0) / pi; };
    r.f = [](Vec3d wo, Vec3d wi) { return wo.z > 0 && wi.z > 0 ? 0.3 / pi : 0.0; };
    r.sample = [mirror_reflects](Vec3d wo, const PrimarySample& u) {
        Draw d;
        if (u[2] < 0.25) {
            d.wi = {-wo.x, -wo.y, wo.z};
            d.delta = 0.25;
            d.weight = mirror_reflects / 0.25;
            return d;
        }
        const double rad = std::sqrt(u[0]), phi = 2 * pi * u[1], z = std::sqrt(1 - u[0]);
        d.wi = {rad * std::cos(phi), rad * std::sin(phi), z};
        d.pdf = 0.75 * z / pi;
        d.weight = 0.3 / 0.75;
        return d;
    };
    return make_adapter(r);
}

TEST(Against, DifferentDeltaPowersAreNotRanked) {
    const std::vector<CheckCase> a = {make_user_case(coated(0.2), 45, 0)};
    const CheckResult alike = against(a, sampler_against(coated(0.2), a)),
                      other = against(a, sampler_against(coated(0.25), a));
    EXPECT_TRUE(named(alike, "same_f").evidence.value("same", false)) << against_text(alike);
    EXPECT_EQ(named(alike, "variance").evidence.value("better", "?"), "none") << against_text(alike);
    EXPECT_FALSE(named(other, "same_f").evidence.value("same", true)) << against_text(other);
    EXPECT_NE(named(other, "same_f").message().find("delta part"), std::string::npos) << against_text(other);
    EXPECT_EQ(named(other, "variance").state, State::skipped) << against_text(other);
}

}  // namespace against_test
}  // namespace crescent
