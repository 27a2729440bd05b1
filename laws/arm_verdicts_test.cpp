// What is known of built-in arms shows in their verdicts, and planted faults are caught. scripts/judged.sh shows that
// every built-in arm gets the verdicts that are expected of it.
#include <cmath>
#include <gtest/gtest.h>

#include "base/sanitized_test.h"
#include "laws/planted/planted.h"
#include "subjects/list.h"
#include "subjects/pipe.h"
#include "check/gtest.h"
#include "verdicts/judge.h"
#include "check/print.h"

namespace crescent {
namespace {

Judgement of(const std::string& arm, const Settings& settings = {}) {
    ProgressMonitor monitor;
    return judge(trials_of(arm, settings, false), TestSettings::quick(), monitor);
}

const Verdict& find(const Judgement& j, const std::string& trial, const std::string& name) {
    for (const Verdict& v : j.verdicts)
        if (v.trial.find(trial) != std::string::npos && v.name == name) return v;
    throw std::runtime_error("no verdict " + name + " on " + trial);
}

TEST(Verdicts, PhongOnLambertLosesTheSupportThatTheorySays) {
    const Judgement j = of("phong", {{"s", 32}});
    const Verdict& v = find(j, "w_o 60 deg az 250, s=32, Lambert + Phong", "support");
    EXPECT_EQ(v.state, State::wrong);
    EXPECT_NEAR(v.evidence["lost_of_diffuse"].get<double>(), 0.25, 1e-3);
    EXPECT_EQ(find(j, "w_o 60 deg az 250, s=32, Phong", "support").state, State::right);
    EXPECT_EQ(find(j, "w_o 0 deg, s=32, Lambert + Phong", "mean").state, State::inconclusive);
}

TEST(Verdicts, SeeTheNearerOfTwoLights) {
    const TrialLight light = trial_setup(LobeKind::none, true, "fill + two disks", 32).light;
    ASSERT_EQ(light.disks.size(), 2u);
    int both = 0, front = 0, back = 0;
    for (double theta = 0; theta < 90; ++theta)
        for (double azimuth = 0; azimuth < 90; ++azimuth) {
            const Vec3d wi = tilt(theta, azimuth);
            const auto far = light.disks[0].distance(wi), near = light.disks[1].distance(wi);
            both += far && near;
            front += near && !far;
            back += far && !near;
            EXPECT_EQ(light(wi),
                near           ? light.disks[1].radiance
                    : far      ? light.disks[0].radiance
                    : wi.z > 0 ? 1
                               : 0)
                << theta << " " << azimuth;
        }
    EXPECT_GT(both, 50);
    EXPECT_GT(front, 50);
    EXPECT_GT(back, 50);
}

class PlantedFaultsInQuickMode : public testing::TestWithParam<std::size_t> {
public:
    static constexpr std::size_t shards = 6;
};

/// And what explains a fault is named for four of five of those that have such a cause, and for no other.
TEST_P(PlantedFaultsInQuickMode, AreCaughtAndExplained) {
    ProgressMonitor monitor;
    const auto faults = planted_faults(false);
    EXPECT_GE(faults.size(), 60u);
    std::size_t with = 0, named = 0;
    std::string told;
    for (std::size_t k = GetParam(); k < faults.size(); k += shards * test::every) {
        // Of 0, 45 and 75 deg two that take turns; crescent check --planted asks at all three.
        std::vector<Trial> trials = faults[k].trials;
        if (trials.size() == 3) trials.erase(trials.begin() + 2 * static_cast<int>(k % 2));
        const Judgement j = judge(trials, TestSettings::quick(), monitor);
        EXPECT_EQ(j.state, State::wrong) << faults[k].name;
        const Explained e = explained(faults[k], j);
        with += !e.cause.empty();
        named += e.right;
        told += e.fault + ": " + e.cause + " -> " + e.said + "\n";
        if (e.cause.empty()) EXPECT_EQ(e.said, "none") << e.fault;
    }
    EXPECT_GE(10 * named + 9, 8 * with) << told;  // to a whole fault
}

INSTANTIATE_TEST_SUITE_P(
    Shards, PlantedFaultsInQuickMode, testing::Range(std::size_t{0}, PlantedFaultsInQuickMode::shards));

struct CosineOfMine {
    struct Drawn {
        std::array<float, 3> wi;
        float pdf;
    };
    float too_much = 1;
    Drawn sample(std::array<float, 3>, std::array<float, 2> u) const {
        const float r = std::sqrt(u[0]), phi = 6.2831853f * u[1], z = std::sqrt(1 - u[0]);
        return {{r * std::cos(phi), r * std::sin(phi), z}, too_much * z / 3.14159265f};
    }
    float pdf(std::array<float, 3>, std::array<float, 3> wi) const {
        return wi[2] > 0 ? too_much * wi[2] / 3.14159265f : 0;
    }
};

TEST(Verdicts, JudgeAStructOfPlainFloats) {
    EXPECT_THAT(CosineOfMine{}, IsARightSampler());
    EXPECT_THAT(CosineOfMine{1.01f}, testing::Not(IsNotAWrongSampler()));
}

TEST(Verdicts, LeaveARightSamplerOfAConeAlone) {
    struct Cone {
        CosineOfMine::Drawn sample(std::array<float, 3>, std::array<float, 2> u) const {
            const float z = 1 - 0.2f * u[0], sin = std::sqrt(1 - z * z), phi = 6.2831853f * u[1];
            return {{sin * std::cos(phi), sin * std::sin(phi), z}, 1 / (6.2831853f * 0.2f)};
        }
        float pdf(std::array<float, 3>, std::array<float, 3> wi) const {
            return wi[2] >= 0.8f ? 1 / (6.2831853f * 0.2f) : 0;
        }
    };
    EXPECT_THAT(Cone{}, IsARightSampler());
}

/// A density tabulated over 8 x 16 cells of the hemisphere, one of them forty times as bright: its warp has a seam at
/// every cell.
struct Tabulated {
    struct Drawn {
        Vec3d wi;
        double pdf;
    };
    static double cell(int i, int j) { return 0.1 + (i * 7 + j * 13) % 11 * 0.35 + (i == 3 && j == 5 ? 40 : 0); }
    static double row(int i) {
        double sum = 0;
        for (int j = 0; j < 16; ++j) sum += cell(i, j);
        return sum;
    }
    static double all() {
        double sum = 0;
        for (int i = 0; i < 8; ++i) sum += row(i);
        return sum;
    }
    double pdf(Vec3d, Vec3d wi) const {
        const double turns = std::atan2(wi.y, wi.x) / (2 * pi);
        return wi.z <= 0 ? 0
                         : cell(std::min(7, int(wi.z * 8)), std::min(15, int((turns < 0 ? turns + 1 : turns) * 16))) /
                all() * 128 / (2 * pi);
    }
    Drawn sample(Vec3d wo, Vec2d u) const {
        int i = 0, j = 0;
        double x = u.x * all();
        for (; i < 7 && x >= row(i); ++i) x -= row(i);
        double y = u.y * row(i);
        for (; j < 15 && y >= cell(i, j); ++j) y -= cell(i, j);
        const double z = (i + std::min(x / row(i), 1 - 1e-9)) / 8,
                     phi = 2 * pi * (j + std::min(y / cell(i, j), 1 - 1e-9)) / 16, sin = std::sqrt(1 - z * z);
        const Vec3d wi{sin * std::cos(phi), sin * std::sin(phi), z};
        return {wi, pdf(wo, wi)};
    }
};

TEST(Verdicts, LeaveASamplerWithSeamsAlone) { EXPECT_THAT(Tabulated{}, IsARightSampler()); }

TEST(Verdicts, LeaveAThinBandAlone) {
    struct Band {
        double low = std::cos(0.735), high = std::cos(0.70);
        double pdf(Vec3d, Vec3d wi) const { return wi.z >= low && wi.z <= high ? 1 / (2 * pi * (high - low)) : 0; }
        Tabulated::Drawn sample(Vec3d, Vec2d u) const {
            const double z = low + (high - low) * u.x, sin = std::sqrt(1 - z * z);
            return {{sin * std::cos(2 * pi * u.y), sin * std::sin(2 * pi * u.y), z}, 1 / (2 * pi * (high - low))};
        }
    };
    EXPECT_THAT(Band{}, IsARightSampler());
}

TEST(Verdicts, AskForThePdfWhereNothingIsDrawn) {
    struct Negative : CosineOfMine {
        float pdf(std::array<float, 3>, std::array<float, 3> wi) const { return wi[2] / 3.14159265f; }
    };
    const Judgement j = judge_sampler("negative under the horizon", Negative{});
    EXPECT_EQ(find(j, "w_o 0 deg", "valid").state, State::wrong);
}

TEST(Verdicts, CallAProgramTooSlowRatherThanWrong) {
    PipeLimits limits;
    limits.total_seconds = 0.5;
    const std::string slow =
        "read hello; echo hello 1 slow; read f; echo -; while read verb; do sleep 0.2; echo 0 0 1 1; done";
    TestSettings settings;
    ProgressMonitor monitor;
    settings.accept_few = true;  // few, not none
    const Judgement j = judge(trials_of_subject(start_pipe(slow, limits), false), settings, monitor);
    EXPECT_EQ(j.state, State::inconclusive);
    EXPECT_EQ(j.left_out.size(), 8u);
    for (const Verdict& v : j.verdicts) EXPECT_EQ(v.state, State::inconclusive) << v.name << v.say;
}

/// What is said of a program that is waited for that long.
std::string fault_of(const std::string& command, double seconds = 30) {
    PipeLimits limits;
    limits.hello_seconds = limits.quiet_seconds = seconds;
    try {
        const auto pipe = start_pipe(command, limits);
        std::vector<Numbers> u(100, {0.5, 0.5});
        std::vector<Draw> out(100);
        pipe->sample(0, {0, 0, 1}, u, out);
    } catch (const SubjectFault& fault) { return fault.what(); }
    return "";
}

TEST(Verdicts, SayWhatAPipeDidWrongAndWhere) {
    EXPECT_NE(fault_of("sleep 20", 0.5)
                  .find("request 1 ('hello 2'): expected 'hello 2 NAME [KEY=VALUE]...' or 'hello 1 NAME', got nothing"),
        std::string::npos);
    EXPECT_NE(fault_of("exec 3<&0; sleep 20 <&3 & exit 0", 5)
                  .find("the program ended with exit code 0, and what it left running"),
        std::string::npos);
    EXPECT_NE(fault_of("echo hallo").find("got 'hallo'"), std::string::npos);
    EXPECT_NE(fault_of("exit 3").find("exit code 3"), std::string::npos);
    EXPECT_NE(fault_of("echo hello 1 x; echo 1; exit 0").find("request"), std::string::npos);
    EXPECT_NE(fault_of("yes").find("got 'y'"), std::string::npos);
    EXPECT_NE(fault_of("tr -d '\\n' < /dev/zero").find("more than 4096 bytes"), std::string::npos);
}

}  // namespace
}  // namespace crescent
