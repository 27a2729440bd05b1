// Several lobes reach one direction: what they draw there together is held against p, so that a lobe is found that is
// drawn a little more often than p weighs it, where the whole still integrates to one.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "laws/judged.h"
#include "laws/right/right.h"
#include "math/functions.h"
#include "subjects/list.h"

namespace crescent {
namespace {

constexpr double power = 5;

/// The cosine, drawn with `drawn`, beside cos^5 about n turned to x, drawn else; pdf(w) has `claimed` of the cosine.
/// The third number chooses, or the first, which is then stretched.
Recipe mixture(double drawn, double claimed, bool of_two_numbers) {
    Recipe r{"mixture", "", {}, {}, {}};
    r.traits.numbers = of_two_numbers ? 2 : 3;
    const Vec3d axis = tilt(20, 0);
    r.pdf = [=](Vec3d, Vec3d i) {
        const double c = std::max(dot(i, axis), 0.0);
        return i.z > 0
            ? (claimed * 2 * i.z + (1 - claimed) * (power + 1) * std::exp(power * std::log(std::max(c, 1e-300)))) /
                (2 * pi)
            : 0.0;
    };
    r.sample = [=, p = r.pdf](Vec3d o, const Numbers& u) {
        const double choice = of_two_numbers ? u.x : u[2];
        const bool cosine = choice < drawn;
        const double x = !of_two_numbers ? u.x : cosine ? u.x / drawn : (u.x - drawn) / (1 - drawn);
        const double cos = std::exp(std::log(1 - x) / (cosine ? 2 : power + 1));
        const Vec3d i = about(cosine ? Vec3d{0, 0, 1} : axis, cos, u.y);
        return Draw{i, i.z > 0 ? p(o, i) : 0.0, {}, {}};
    };
    return r;
}

Verdict identity_of(const Recipe& r, std::uint32_t seed) {
    TestSettings settings;
    settings.seed = seed;
    return named(judged_at(subject_of(r), 45, settings), "identity");
}

TEST(LobesTogether, DrawWhatPSaysWhereTheyAreChosenWithWhatItHas) {
    for (bool of_two : {false, true})
        for (double drawn : {0.2, 0.5})
            for (std::uint32_t seed : {1u, 2u, 3u}) {
                const Verdict v = identity_of(mixture(drawn, drawn, of_two), seed);
                EXPECT_EQ(v.state, State::right) << v.say;
                EXPECT_GT(v.evidence.value("reached_by_several_lobes", 0), 20) << v.say;
            }
}

TEST(LobesTogether, AreFoundWhereOneIsDrawnALittleMoreOftenThanPSays) {
    for (bool of_two : {false, true})
        for (double drawn : {0.3, 0.5}) {
            const Verdict v = identity_of(mixture(drawn, drawn + 0.005, of_two), 1);
            EXPECT_EQ(v.state, State::wrong) << v.say;
            EXPECT_NE(v.say.find("Several lobes"), std::string::npos) << v.say;
        }
}

TEST(LobesTogether, NameTheChoosersProbability) {
    for (bool of_two : {false, true})
        for (double claimed : {0.45, 0.51}) {
            const Verdict v = identity_of(mixture(0.5, claimed, of_two), 1);
            EXPECT_EQ(v.evidence.value("diagnosis", ""), "the chooser's probability") << v.say;
        }
}

/// A lobe whose power is not the one that is drawn is off by no one share.
TEST(LobesTogether, NameItNotWhereALobeIsOffInItself) {
    for (bool of_two : {false, true}) {
        Recipe r = mixture(0.5, 0.5, of_two);
        r.pdf = [](Vec3d, Vec3d i) {
            const double c = std::max(dot(i, tilt(20, 0)), 1e-300);
            return i.z > 0 ? (2 * i.z + (power + 1.3) * std::exp((power + 0.3) * std::log(c))) / (4 * pi) : 0.0;
        };
        r.sample = [p = r.pdf, sample = r.sample](Vec3d o, const Numbers& u) {
            Draw d = sample(o, u);
            d.pdf = d.pdf > 0 ? p(o, d.wi) : 0;
            return d;
        };
        const Verdict v = identity_of(r, 1);
        EXPECT_EQ(v.state, State::wrong) << v.say;
        EXPECT_NE(v.evidence.value("diagnosis", ""), "the chooser's probability") << v.say;
    }
}

}  // namespace
}  // namespace crescent
