// A lobe of a mixture that pdf(w) gives less than its share, by so much that the whole falls short by what a constant
// that one knows would explain: no constant is named.
#include <cmath>
#include <gtest/gtest.h>

#include "laws/right/right.h"
#include "math/functions.h"
#include "subjects/list.h"
#include "verdicts/judge.h"

namespace crescent {
namespace {

/// Draws nothing with 0.04, and else the cosine or cos^20 about n, as often; pdf(w) has so much of either.
Recipe mixture(double of_cosine, double of_power) {
    Recipe r{"mixture", "", {}, {}, {}};
    r.traits.numbers = 3;
    r.traits.own_random = true;  // so that no point of a warp speaks
    r.pdf = [=](Vec3d, Vec3d i) {
        if (i.z <= 0) return 0.0;
        return (of_cosine * 2 * i.z + of_power * 21 * math::exp(20 * math::log(i.z))) / (2 * pi);
    };
    r.sample = [p = r.pdf](Vec3d o, const Numbers& u) {
        if (u[2] < 0.04) return Draw{{0, 0, 1}, 0, {}, {}};
        const double cos = math::exp(math::log(1 - u[0]) / (u[2] < 0.52 ? 2 : 21));
        const Vec3d i = about({0, 0, 1}, cos, u[1]);
        return Draw{i, p(o, i), {}, {}};
    };
    return r;
}

std::string diagnosed(const Recipe& recipe, std::uint64_t seed) {
    const Trial trial = trial_of_subject(subject_of(recipe), 45, 130);
    TestSettings settings = TestSettings::quick();
    settings.seed = seed;
    ProgressMonitor monitor;
    for (const Verdict& v : judge({&trial, 1}, settings, monitor).verdicts)
        if (v.state == State::wrong && v.evidence.contains("diagnosis")) return v.say;
    return "";
}

TEST(Mixtures, WithOneLobeOffHaveNoConstantNamed) {
    for (std::uint64_t seed : {1, 2, 3, 4}) {
        const std::string one = diagnosed(mixture(0.48 * 0.92, 0.48), seed);
        EXPECT_EQ(one.find("a constant"), std::string::npos) << one;
        const std::string both = diagnosed(mixture(0.48 * 0.96, 0.48 * 0.96), seed);
        EXPECT_NE(both.find("1 / the share of draws that are not nothing"), std::string::npos) << both;
    }
}

}  // namespace
}  // namespace crescent
