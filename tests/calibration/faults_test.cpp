// Each fault has its stated size, and streams of numbers are independent.
#include "tests/calibration/faults.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unordered_set>

#include "tests/calibration/cases.h"
#include "tests/calibration/geometry.h"
#include "tests/calibration/measures.h"
#include "tests/calibration/records.h"
#include "tests/calibration/serve.h"
#include "tests/calibration/table.h"

namespace crescent::calibration {
namespace faults_test {

constexpr int draws = 1 << 18;
const Vec3d wo = unit(Vec3d{0.5, -0.3, 0.6});

/// A right sampler, and the same sampler with a fault.
struct RightAndFaulty {
    Sampler right, wrong;
    std::vector<PlaceOfFault> places;
    RightAndFaulty(std::string_view family, Fault fault, Real real = Real::f64) {
        const Family& f = family_named(family);
        Rng d = rng_of({"faults_test", 7, 0, "parameters"});
        const Member member = f.member(d);
        const StreamKey key{"faults_test", 7, 0, "fault"};
        right = sampler_of(f, member, real);
        wrong = faulty(f, member, real, fault, {&wo, 1}, key);
        places = places_of(right, fault, {&wo, 1}, key);
    }
};
bool drawn(Vec3d w) { return dot(w, w) > 0; }

class EveryPowerFamily : public testing::TestWithParam<const char*> {};

TEST_P(EveryPowerFamily, AConstantScalesThePdfByItsSize) {
    const RightAndFaulty t(GetParam(), {FaultKind::constant, 0.03});
    const Draws d = draws_of(t.wrong, wo, 1000, 1);
    for (std::size_t k = 0; k < d.wi.size(); ++k)
        if (drawn(d.wi[k])) {
            EXPECT_NEAR(pdf_at(t.wrong, wo, d.wi[k]) / pdf_at(t.right, wo, d.wi[k]), 1.03, 1e-12);
            EXPECT_NEAR(d.pdf[k] / pdf_at(t.right, wo, d.wi[k]), 1.03, 1e-9);
        }
}

TEST_P(EveryPowerFamily, ALeakMovesItsShareOfTheDraws) {
    const RightAndFaulty t(GetParam(), {FaultKind::leak, 0.1});
    EXPECT_EQ(t.wrong.numbers, t.right.numbers + 1);
    // Both get the same numbers, so draws that differ are leaked.
    Rng rng = rng_of({"faults_test", 1, 0, "numbers"});
    const auto& a = std::get<Functions<double>>(t.right.functions);
    const auto& b = std::get<Functions<double>>(t.wrong.functions);
    int differ = 0;
    for (int k = 0; k < draws / 8; ++k) {
        double u[PrimarySample::most_numbers];
        for (double& v : u) v = rng.uniform(0, 1);
        const Drawn<double> x = a.sample(wo, u), y = b.sample(wo, u);
        differ += x.pdf > 0 && !(y.pdf > 0 && versine(x.wi, y.wi) < 1e-20);
    }
    EXPECT_NEAR(differ / (draws / 8.0), 0.1, 0.006);
}

TEST_P(EveryPowerFamily, ARotationTurnsDrawsByItsAngle) {
    const RightAndFaulty t(GetParam(), {FaultKind::rotation, 0.01});
    const Draws a = draws_of(t.right, wo, 4096, 3), b = draws_of(t.wrong, wo, 4096, 3);
    double most = 0;
    for (std::size_t k = 0; k < a.wi.size(); ++k)
        if (drawn(a.wi[k]) && drawn(b.wi[k])) most = std::max(most, std::sqrt(2 * versine(a.wi[k], b.wi[k])));
    EXPECT_GT(most, 0.003);  // the axis may be near the draws of a wide density
    EXPECT_LT(most, 0.01 * (1 + 1e-6));
}

TEST_P(EveryPowerFamily, ACapIsNeverDrawnAndHasItsMass) {
    const RightAndFaulty t(GetParam(), {FaultKind::hole, 0.01});
    const PlaceOfFault& at = t.places.at(0);
    const auto inside = [&](const Sampler& s) {
        const Draws d = draws_of(s, wo, draws, 5);
        return std::ranges::count_if(d.wi, [&](Vec3d w) { return drawn(w) && versine(at.cap, unit(w)) < at.gap; });
    };
    EXPECT_EQ(inside(t.wrong), 0);
    EXPECT_NEAR(static_cast<double>(inside(t.right)) / draws, 0.01, 0.0015);
    EXPECT_GT(pdf_at(t.wrong, wo, at.cap), 0);
}

TEST_P(EveryPowerFamily, ABlindCapIsDrawnWithZeroPdf) {
    const RightAndFaulty t(GetParam(), {FaultKind::blind, 0.01});
    const Draws d = draws_of(t.wrong, wo, draws, 5);
    int blind = 0;
    for (std::size_t k = 0; k < d.wi.size(); ++k)
        blind += drawn(d.wi[k]) && d.pdf[k] > 0 && pdf_at(t.wrong, wo, d.wi[k]) == 0;
    EXPECT_NEAR(static_cast<double>(blind) / draws, 0.01, 0.0015);
}

TEST_P(EveryPowerFamily, AMismatchDrawsFromAnotherMember) {
    const RightAndFaulty t(GetParam(), {FaultKind::mismatch, 0.3});
    const Draws d = draws_of(t.wrong, wo, 4096, 9), r = draws_of(t.right, wo, 4096, 9);
    int moved = 0;
    for (std::size_t k = 0; k < d.wi.size(); ++k) {
        if (!drawn(d.wi[k])) continue;
        EXPECT_DOUBLE_EQ(d.pdf[k], pdf_at(t.right, wo, d.wi[k]));
        moved += versine(d.wi[k], r.wi[k]) > 1e-20;
    }
    EXPECT_GT(moved, 40);
    EXPECT_GT(std::fabs(fit_of(t.wrong, wo, draws / 2, 3).sigmas) + fit_of(t.wrong, wo, draws / 2, 3).chi2, 600);
}

INSTANTIATE_TEST_SUITE_P(Some, EveryPowerFamily,
    testing::Values("sky by rows and columns", "cone", "rectangle light by area", "Henyey-Greenstein",
        "von Mises-Fisher mixture", "GGX by visible normals", "GGX by D", "fibre"));

TEST(Faults, SharesOfBadValuesAreTheirSize) {
    for (const FaultKind kind : {FaultKind::nan, FaultKind::negative, FaultKind::length}) {
        const RightAndFaulty t("Phong", {kind, 0.01}, Real::f32);
        const auto adapter = make_adapter(t.wrong);
        Rng rng = rng_of({"faults_test", 3, 0, "numbers"});
        int bad = 0;
        for (int k = 0; k < 1 << 16; ++k) {
            PrimarySample u;
            for (int i = 0; i < t.wrong.numbers; ++i) u[i] = std::floor(rng.uniform(0, 0x1p24)) * 0x1p-24;
            Draw d;
            adapter->sample(0, wo, {&u, 1}, {&d, 1});
            bad += std::isnan(d.pdf) || d.pdf < 0 || std::fabs(dot(d.wi, d.wi) - 1) > 1e-3;
        }
        EXPECT_NEAR(bad / 65536.0, 0.01, 0.002) << word({kind});
    }
}

TEST(Faults, FactorsOfThePdf) {
    const auto ratio = [](const char* family, Fault fault, Vec3d wi) {
        const RightAndFaulty t(family, fault);
        return pdf_at(t.wrong, wo, wi) / pdf_at(t.right, wo, wi);
    };
    const Vec3d wi = unit(Vec3d{0.2, 0.4, 0.7}), m = unit(wo + wi);
    EXPECT_NEAR(ratio("Lambert", {FaultKind::cos_missing}, wi), 1 / wi.z, 1e-12);
    EXPECT_NEAR(ratio("Lambert", {FaultKind::cos_twice}, wi), wi.z, 1e-12);
    EXPECT_NEAR(ratio("even texels", {FaultKind::sin_missing}, wi), std::hypot(wi.x, wi.y), 1e-12);
    EXPECT_NEAR(ratio("GGX by D", {FaultKind::jacobian_missing}, wi), 4 * dot(wo, m), 1e-12);
    EXPECT_NEAR(ratio("GGX by D", {FaultKind::normal_missing}, wi), 1 / m.z, 1e-12);
    EXPECT_NEAR(ratio("cells", {FaultKind::factor, 2}, wi), 2, 1e-12);
}

TEST(Faults, EveryBrokenFamilyClaimsAnotherDensity) {
    for (const Family& f : families())
        for (const Broken b : f.breaks) {
            Rng d = rng_of({"faults_test", 5, 0, f.name});
            const Member member = f.member(d);
            const Sampler right = sampler_of(f, member, Real::f64);
            const Sampler wrong =
                faulty(f, member, Real::f64, {FaultKind::broken, 0, b}, {&wo, 1}, {"faults_test", 5, 0, "fault"});
            double off = 0;
            for (const Vec3d w : draws_of(wrong, wo, 512, 1).wi)
                if (drawn(w)) off += std::fabs(pdf_at(wrong, wo, w) / pdf_at(right, wo, w) - 1);
            EXPECT_GT(off / 512, 0.01) << f.name << ": " << word({FaultKind::broken, 0, b});
        }
}

TEST(Streams, TwoKeysShareNoNumbers) {
    std::unordered_set<std::uint64_t> seen;
    std::size_t count = 0;
    for (const std::string_view set : {"right", "power"})
        for (std::uint64_t seed : {1, 2})
            for (std::uint64_t index : {0, 1, 2, 17})
                for (const std::string_view purpose : {"parameters", "w_o", "fault"}) {
                    Rng d = rng_of({set, seed, index, purpose});
                    for (int k = 0; k < 4096; ++k, ++count)
                        seen.insert(static_cast<std::uint64_t>(d.uniform(0, 0x1p53)));
                }
    EXPECT_GE(seen.size() + 1, count);  // 2e10 pairs of 53 bits: expected number of equal pairs 2e-6
}

TEST(Streams, PartsOfAKeyAreSeparated) {
    EXPECT_NE(hash_of({"ab", 1, 2, "c"}), hash_of({"a", 1, 2, "bc"}));
    EXPECT_NE(hash_of({"a", 1, 2, "c"}), hash_of({"a", 2, 1, "c"}));
    EXPECT_EQ(hash_of({"a", 1, 2, "c"}), hash_of({"a", 1, 2, "c"}));
}

TEST(Cases, AreReproducibleAndDifferByIndexAndSeed) {
    const auto text = [](std::uint64_t seed, std::uint64_t index) {
        const Case c = case_set("power").make({"power", seed, index, 1, false});
        return c.family + c.parameters + c.kind + (c.grid.empty() ? "" : std::to_string(c.grid[0].first));
    };
    EXPECT_EQ(text(1, 3), text(1, 3));
    EXPECT_NE(text(1, 3), text(2, 3));
    EXPECT_NE(text(1, 3), text(1, 23));
}

TEST(Cases, PowerHasTenOfEachKindAndSizeInTwoHundred) {
    std::map<std::string, int> cells;
    for (std::uint64_t k = 0; k < 200; ++k) {
        const Case c = case_set("power").make({"power", 3, k, 1, false});
        ++cells[c.kind + std::to_string(c.size)];
        EXPECT_EQ(c.expected, State::wrong);
        EXPECT_FALSE(c.held_out);
    }
    EXPECT_EQ(cells.size(), 20u);
    for (const auto& [cell, count] : cells) EXPECT_EQ(count, 10) << cell;
}

TEST(Records, CsvRoundTripKeepsTheTables) {
    Case c;
    c.family = "glass, rough";
    c.kind = "leak";
    c.size = 0.01;
    c.expected = State::wrong;
    c.cause = "constant";
    Result result;
    result.state = State::wrong;
    result.wrong = {"density", "mean"};
    result.causes = {"a constant", "cos theta_i"};
    result.cpu_seconds = 0.25;
    result.evaluations = 1234;
    result.wo = 3;
    const auto r = record_of({"power", 1, 2, 3, false}, {"0.1", false, true}, c, result);
    const std::string path = testing::TempDir() + "calibration_records.csv";
    std::ofstream(path) << csv_of({r});
    const auto back = read_csv(path);
    std::filesystem::remove(path);
    ASSERT_EQ(back.size(), 1u);
    for (const char* key : {"set", "seed", "index", "wo", "engine", "mode", "by", "family", "kind", "size", "state",
             "expected", "wrong", "open", "cpu", "evaluations", "directions", "cause"})
        EXPECT_EQ(back[0].at(key), r.at(key)) << key;
    EXPECT_EQ(identity_of(back[0]), identity_of(r));
    EXPECT_TRUE(causes_of(back[0]).named && causes_of(back[0]).others);
    EXPECT_EQ(csv_of(back), csv_of({r}));
    EXPECT_EQ(table_of(back), table_of({r}));
}

TEST(Table, BoundsAreThoseOfClopperAndPearson) {
    EXPECT_NEAR(upper_bound(0, 3000), 1 - std::pow(0.05, 1.0 / 3000), 1e-12);
    EXPECT_NEAR(lower_bound(10, 10), std::pow(0.05, 0.1), 1e-12);
    EXPECT_NEAR(upper_bound(1, 10), 0.3942, 1e-4);
}

}  // namespace faults_test
}  // namespace crescent::calibration
