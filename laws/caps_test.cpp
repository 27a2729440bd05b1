// Samplers of many small cones: each is found from the draws, and what they sum to is known within what may be asked.
#include <cmath>
#include <gtest/gtest.h>

#include "laws/judged.h"
#include "laws/right/right.h"
#include "subjects/list.h"
#include "verdicts/judge.h"
#include "check/print.h"

namespace crescent {
namespace {

/// One number chooses among `count` cones, whose axes are drawn over the upper half; p is the sum over those that hold
/// w, times `claimed`.
Recipe cones(int count, double half_angle, double claimed = 1) {
    std::vector<Vec3d> axes;
    Dice dice(static_cast<std::uint64_t>(count));
    while (static_cast<int>(axes.size()) < count) axes.push_back(dice.direction(0.2, 0.98));
    const double a = 1 - std::cos(half_angle);
    Recipe r{"cones", "", {}, {}, {}};
    r.traits.numbers = 3;
    r.sample = [=](Vec3d, const Numbers& u) {
        const Vec3d wi = about(axes[static_cast<std::size_t>(u[2] * count)], 1 - a * u[0], u[1]);
        double p = 0;
        for (Vec3d axis : axes) p += dot(axis, wi) >= 1 - a;
        return Draw{wi, claimed * p / (2 * pi * a * count), {}, {}};
    };
    r.pdf = [=](Vec3d, Vec3d wi) {
        double p = 0;
        for (Vec3d axis : axes) p += dot(axis, wi) >= 1 - a;
        return claimed * p / (2 * pi * a * count);
    };
    return r;
}

Judgement judged(const Recipe& r) { return judged_at(subject_of(r), 45, TestSettings::quick()); }

State state_of(const Judgement& j, std::string_view name) {
    for (const Verdict& v : j.verdicts)
        if (v.name == name) return v.state;
    return State::error;
}

TEST(ManyCones, AreKnownToIntegrateToOneAlsoWhereTheyOverlap) {
    for (const auto& [count, half_angle] : {std::pair(64, 0.01), {100, 0.05}}) {
        const Judgement j = judged(cones(count, half_angle));
        EXPECT_EQ(state_of(j, "normalised"), State::right) << count << what_is_wrong(j);
        EXPECT_EQ(state_of(j, "density"), State::right) << count << what_is_wrong(j);
    }
}

TEST(ManyCones, ThatSumToAnotherNumberAreWrong) {
    EXPECT_EQ(state_of(judged(cones(64, 0.01, 1.001)), "normalised"), State::wrong);
}

}  // namespace
}  // namespace crescent
