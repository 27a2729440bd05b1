// Built-in arms at the limits of the schema: none that is right is accused there. What is inconclusive says why, and
// what would settle it.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

#include "base/errors.h"
#include "base/sanitized_test.h"
#include "judgements/all.h"
#include "laws/judged.h"
#include "laws/right/right.h"
#include "subjects/list.h"
#include "subjects/pipe.h"
#include "check/print.h"

namespace crescent {
namespace {

Judgement at_a_few(const std::string& arm, const Settings& settings) {
    std::vector<Trial> trials = trials_of(arm, settings, false);
    std::erase_if(trials, [](const Trial& t) { return t.theta_deg != 45 && t.theta_deg != 89; });
    ProgressMonitor monitor;
    TestSettings few = TestSettings::quick();
    few.draws /= 4;
    return judge(trials, few, monitor);
}

bool reads(const std::string& arm, const Settings& settings) {
    try {
        return !trials_of(arm, settings, false).empty();
    } catch (const InputError&) { return false; }
}

void expect_settled(const Judgement& j, std::set<std::string>& met) {
    for (const Verdict& v : j.verdicts) {
        if (v.state != State::inconclusive) continue;
        met.insert(v.name);
        EXPECT_FALSE(v.say.empty()) << v.arm << " [" << v.trial << "] " << v.name;
        EXPECT_FALSE(v.settle.empty()) << v.arm << " [" << v.trial << "] " << v.name << ": " << v.say;
    }
}

TEST(Limits, OfTheSchemaLeadToNoAccusation) {
    std::set<std::string> met;
    const std::vector<std::string> arms = sampler_names();
    for (std::size_t k = 0; k < arms.size(); k += test::every)
        for (const Settings& at : {Settings{{"s", 1e-3}}, {{"s", 1e6}}, {{"alpha", 1e-4}}, {{"alpha", 1}}}) {
            const std::string& arm = arms[k];
            if (!reads(arm, at)) continue;
            const Judgement j = at_a_few(arm, at);
            EXPECT_TRUE(j.as_expected) << arm << " " << at.begin()->first << "=" << at.begin()->second << "\n"
                                       << verdict_table(j);
            expect_settled(j, met);
        }
    for (const char* name : {"tail", "mean", "efficiency"}) EXPECT_TRUE(met.count(name)) << name;
}

/// p of the lobe is next to nothing where Lambert's light comes from: all samples are alike, and their mean is short of
/// it.
TEST(Limits, NameATailThatNoDrawMet) {
    for (const auto& [arm, at] :
        {std::pair<std::string, Settings>{"blinn", {{"s", 1e5}}}, {"ggx-d", {{"alpha", 1e-4}}}}) {
        const Judgement j = at_a_few(arm, at);
        std::size_t told = 0;
        for (const Verdict& v : j.verdicts) {
            if (v.name != "mean" || !v.evidence.contains("unmet_share")) continue;
            ++told;
            EXPECT_EQ(v.state, State::inconclusive);
            EXPECT_NE(v.say.find("Heavy tail that no draw met"), std::string::npos) << v.say;
            const double lacking = 1 - v.evidence["mean"].get<double>() / v.evidence["quadrature"].get<double>();
            EXPECT_NEAR(v.evidence["unmet_share"].get<double>(), lacking, 0.02) << v.say;
            EXPECT_LT(v.evidence["unmet_chance_of_a_draw"].get<double>(), 1e-3);
        }
        EXPECT_GT(told, 0u) << verdict_table(j);
    }
}

/// A light that the sampler claims to draw and does not is no tail: chance does not miss it.
TEST(Limits, AccuseASamplerThatLeavesOutWhatItClaims) {
    Recipe r{"cosine above 0.6", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d wi) { return wi.z <= 0 ? 0 : wi.z > 0.6 ? wi.z / (0.64 * pi) : 0.2 * wi.z / pi; };
    r.f = [](Vec3d wo, Vec3d wi) { return wo.z > 0 && wi.z > 0 ? 0.5 / pi : 0.0; };
    r.sample = [p = r.pdf](Vec3d wo, Vec2d u) {
        const double z = std::sqrt(1 - 0.64 * u.x), sin = std::sqrt(1 - z * z), phi = 2 * pi * u.y;
        const Vec3d wi{sin * std::cos(phi), sin * std::sin(phi), z};
        return Draw{wi, p(wo, wi), {}, {}};
    };
    ProgressMonitor monitor;
    const Trial trial = trial_of_subject(subject_of(r), 45, 130);
    const Judgement j = judge({&trial, 1}, TestSettings::quick(), monitor);
    for (const Verdict& v : j.verdicts)
        if (v.name == "mean" || v.name == "physics") EXPECT_EQ(v.state, State::wrong) << v.name << ": " << v.say;
}

Judgement judged(std::shared_ptr<const JudgedSampler> subject, TestSettings settings) {
    return judged_at(std::move(subject), 45, settings);
}

/// One verdict after the other is brought to where it cannot tell.
TEST(Limits, WhatIsInconclusiveSaysWhatWouldSettleIt) {
    std::set<std::string> met;
    Recipe r{"cosine", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d wi) { return std::max(wi.z, 0.0) / pi; };
    r.f = [](Vec3d, Vec3d wi) { return wi.z > 0 ? 0.5 / pi : 0.1; };
    r.sample = [](Vec3d, Vec2d u) {
        const double r = std::sqrt(u.x), phi = 2 * pi * u.y, z = std::sqrt(1 - u.x);
        return Draw{{r * std::cos(phi), r * std::sin(phi), z}, z / pi, {}, {}};
    };
    expect_settled(judged(subject_of(r), TestSettings::quick()), met);  // f goes on below: support, physics, mean
    for (const char* name : {"support", "physics", "mean"}) EXPECT_TRUE(met.count(name)) << name;

    Recipe wrinkled = r;  // jumps along thousands of curves
    wrinkled.pdf = [](Vec3d, Vec3d wi) {
        return wi.z > 0
            ? (1 + (std::fmod(std::fabs(1e3 * wi.x * wi.y + 977 * wi.z), 1.0) < 0.5 ? 0.9 : -0.9)) / (2 * pi)
            : 0.0;
    };
    wrinkled.f = {};
    TestSettings few = TestSettings::quick();
    few.evaluations = 2000;
    expect_settled(judged(subject_of(wrinkled), few), met);

    Recipe rare = r;  // next to nothing is ever drawn
    rare.f = {};
    rare.sample = [right = r.sample](Vec3d wo, Vec2d u) {
        Draw d = right(wo, u);
        if (u.x > 2e-4) d.pdf = 0;
        return d;
    };
    rare.pdf = [](Vec3d, Vec3d wi) { return wi.z * wi.z > 1 - 2e-4 && wi.z > 0 ? wi.z / pi : 0.0; };
    few = TestSettings::quick();
    few.draws = 2048;
    expect_settled(judged(subject_of(rare), few), met);
    for (const char* name : {"normalised", "density"}) EXPECT_TRUE(met.count(name)) << name;

    PipeLimits limits;
    limits.total_seconds = 0.3;
    ProgressMonitor monitor;
    const std::string slow =
        "read hello; echo hello 1 slow; read f; echo -; while read verb; do sleep 0.2; echo 0 0 1 1; done";
    expect_settled(judge(trials_of_subject(start_pipe(slow, limits), false), TestSettings::quick(), monitor), met);
    EXPECT_EQ(met.size(), verdict_names.size());
}

}  // namespace
}  // namespace crescent
