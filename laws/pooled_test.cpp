// Faults of half a per cent that no w_o shows alone, and right samplers beside them.
#include <cmath>
#include <gtest/gtest.h>

#include "laws/right/renderers.h"
#include "subjects/list.h"
#include "verdicts/judge.h"

namespace crescent {
namespace {

/// Lambert and a lobe about the mirror direction: the first number, stretched, chooses the lobe with probability
/// `choice`, p says a half.
Recipe two_lobes(double choice, double sharpness) {
    Recipe r{"two lobes", "", {}, {}, {}};
    const auto mirrored = [](Vec3d wo) { return Vec3d{-wo.x, -wo.y, wo.z}; };
    r.pdf = [=](Vec3d wo, Vec3d wi) {
        const double c = std::max(dot(mirrored(wo), wi), 0.0);
        return 0.5 * std::max(wi.z, 0.0) / pi + 0.5 * (sharpness + 1) / (2 * pi) * std::pow(c, sharpness);
    };
    r.sample = [choice, sharpness, mirrored, p = r.pdf](Vec3d wo, const Numbers& u) {
        const bool lobe = u[0] < choice;
        const double v = lobe ? u[0] / choice : (u[0] - choice) / (1 - choice);
        const Vec3d wi = lobe ? about(mirrored(wo), std::pow(v, 1 / (sharpness + 1)), u[1])
                              : about({0, 0, 1}, std::sqrt(1 - v), u[1]);
        return Draw{wi, p(wo, wi), {}, {}};
    };
    return r;
}

Judgement judged(const Recipe& r, std::uint32_t seed = 1) {
    ProgressMonitor monitor;
    TestSettings settings;
    settings.seed = seed;
    return judge(trials_of_subject(subject_of(r), false), settings, monitor);
}

TEST(Pooled, ALobeThatIsChosenHalfAPerCentTooOftenIsFound) {
    const Judgement j = judged(two_lobes(0.505, 50));
    std::size_t told = 0;
    for (const Verdict& v : j.verdicts)
        told +=
            v.state == State::wrong && v.name == "density" && v.say.find("over 8 w_o together") != std::string::npos;
    EXPECT_EQ(told, 1u) << what_is_wrong(j);
}

TEST(Pooled, OneThatIsChosenAsOftenAsPSaysIsLeftAlone) {
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        const Judgement j = judged(two_lobes(0.5, 50), seed);
        EXPECT_EQ(j.state, State::right) << what_is_wrong(j);
    }
}

}  // namespace
}  // namespace crescent
