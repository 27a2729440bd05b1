// Every arm of the list, newcomers included, gets the verdicts that the list expects of it; the planted faults do not.
#include <cmath>
#include <gtest/gtest.h>

#include "laws/planted/planted.h"
#include "verdicts/gtest.h"
#include "verdicts/judge.h"
#include "verdicts/list.h"
#include "verdicts/pipe.h"
#include "verdicts/print.h"

namespace crescent {
namespace {

Judgement of(const std::string& arm, const Settings& settings = {}) {
    Watch watch;
    return judge(trials_of(arm, settings, false), Rigour::quick(), watch);
}

const Verdict& find(const Judgement& j, const std::string& trial, const std::string& name) {
    for (const Verdict& v : j.verdicts)
        if (v.trial.find(trial) != std::string::npos && v.name == name) return v;
    throw std::runtime_error("no verdict " + name + " on " + trial);
}

TEST(Verdicts, EveryArmOfTheListGetsWhatTheListExpects) {
    for (const std::string& arm : arm_names()) {
        const Judgement j = of(arm);
        EXPECT_TRUE(j.as_expected) << verdict_table(j);
    }
}

TEST(Verdicts, PhongOnLambertLosesTheSupportThatTheorySays) {
    const Judgement j = of("phong", {{"s", 32}});
    const Verdict& v = find(j, "w_o 60 deg az 250, s=32, Lambert + Phong", "support");
    EXPECT_EQ(v.state, State::wrong);
    EXPECT_NEAR(v.evidence["lost_of_diffuse"].get<double>(), 0.25, 1e-3);
    EXPECT_EQ(find(j, "w_o 60 deg az 250, s=32, Phong", "support").state, State::right);
    EXPECT_EQ(find(j, "w_o 0 deg, s=32, Lambert + Phong", "mean").state, State::inconclusive);
}

TEST(Verdicts, QuickModeCatchesEveryPlantedFault) {
    Watch watch;
    const auto faults = planted_faults(false);
    EXPECT_GE(faults.size(), 24u);
    for (const PlantedFault& fault : faults) EXPECT_EQ(judge(fault.trials, Rigour::quick(), watch).state, State::wrong) << fault.name;
}

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
    float pdf(std::array<float, 3>, std::array<float, 3> wi) const { return wi[2] > 0 ? too_much * wi[2] / 3.14159265f : 0; }
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
        float pdf(std::array<float, 3>, std::array<float, 3> wi) const { return wi[2] >= 0.8f ? 1 / (6.2831853f * 0.2f) : 0; }
    };
    EXPECT_THAT(Cone{}, IsARightSampler());
}

std::string fault_of(const std::string& command) {
    PipeLimits limits;
    limits.hello_seconds = limits.quiet_seconds = 0.5;
    try {
        const auto pipe = start_pipe(command, limits);
        std::vector<Vec2d> u(100, {0.5, 0.5});
        std::vector<Draw> out(100);
        pipe->sample(0, {0, 0, 1}, u, out);
    } catch (const SubjectFault& fault) {
        return fault.what();
    }
    return "";
}

TEST(Verdicts, SayWhatAPipeDidWrongAndWhere) {
    EXPECT_NE(fault_of("sleep 20").find("request 1 ('hello 1'): expected 'hello 1 NAME', got nothing"), std::string::npos);
    EXPECT_NE(fault_of("echo hallo").find("got 'hallo'"), std::string::npos);
    EXPECT_NE(fault_of("exit 3").find("exit code 3"), std::string::npos);
    EXPECT_NE(fault_of("echo hello 1 x; echo 1; exit 0").find("request"), std::string::npos);
    EXPECT_NE(fault_of("yes").find("got 'y'"), std::string::npos);
    EXPECT_NE(fault_of("tr -d '\\n' < /dev/zero").find("more than 4096 bytes"), std::string::npos);
}

}  // namespace
}  // namespace crescent
