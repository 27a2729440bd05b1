// What a diagnosis says of lobes that one number chooses among: what each is drawn with, or nothing where no lobe is
// off by a share.
#include <cmath>
#include <gtest/gtest.h>

#include "laws/judged.h"
#include "laws/right/right.h"
#include "math/functions.h"
#include "math/spherical.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/lobe_draws.h"

namespace crescent {
namespace {

/// cos, cos^8 and cos^40 about n, of which draws and p have so much each. part: of the turn that the first lobe draws.
Recipe powers(std::vector<double> drawn, std::vector<double> claimed, double part = 1) {
    static constexpr double s[] = {1, 8, 40};
    Recipe r{"powers", "", {}, {}, {}};
    r.traits.numbers = 3;
    r.pdf = [=](Vec3d, Vec3d i) {
        double p = 0;
        for (std::size_t k = 0; k < 3 && i.z > 0; ++k)
            p += claimed[k] * (s[k] + 1) / (2 * pi) * math::exp(s[k] * math::log(i.z));
        return p;
    };
    r.sample = [=, p = r.pdf](Vec3d o, const Numbers& u) {
        const std::size_t k = u[2] < drawn[0] ? 0 : u[2] < drawn[0] + drawn[1] ? 1 : 2;
        const double cos = math::exp(math::log(1 - u[0]) / (s[k] + 1));
        const Vec3d i = math::spherical(cos, 2 * pi * u[1] * (k == 0 ? part : 1));
        return Draw{i, p(o, i)};
    };
    return r;
}

const Verdict& first_wrong(const Judgement& j) {
    for (const Verdict& v : j.verdicts)
        if (v.state == State::wrong && v.evidence.contains("diagnosis")) return v;
    throw std::runtime_error("nothing is wrong");
}

TEST(Lobes, HaveTheSharesToldThatTheyAreDrawnWith) {
    const Judgement j = judged_at(subject_of(powers({0.2, 0.5, 0.3}, {0.5, 0.2, 0.3})), 40, TestSettings::quick());
    const Verdict& v = first_wrong(j);
    EXPECT_EQ(v.evidence["diagnosis"], "the chooser's probability") << v.say;
    EXPECT_NE(
        v.say.find("are drawn with 0.2, 0.5 and 0.3, and pdf(w) has them with 0.5, 0.2 and 0.3"), std::string::npos)
        << v.say;
}

TEST(Lobes, OfWhichOneIsOffHaveItToldByItself) {
    const Judgement j = judged_at(subject_of(powers({0.2, 0.5, 0.3}, {0.2, 0.6, 0.3})), 40, TestSettings::quick());
    const Verdict& v = first_wrong(j);
    EXPECT_EQ(v.evidence["diagnosis"], "a constant in one lobe") << v.say;
    EXPECT_NE(
        v.say.find("the lobe from 0.2 to 0.7 is drawn 0.83333 times as often as pdf(w) has it"), std::string::npos)
        << v.say;
}

/// The first lobe leaves a tenth of its turn out, and is drawn as much more often in the rest: no share explains it.
TEST(Lobes, ThatAreDrawnInAPartOfTheirRoomHaveNoShareTold) {
    const std::vector<double> even = {0.4, 0.3, 0.3};
    const Judgement j = judged_at(subject_of(powers(even, even, 0.9)), 40, TestSettings::quick());
    const Verdict& v = first_wrong(j);
    EXPECT_EQ(v.evidence["diagnosis"], "none") << v.say;
}

TEST(Lobes, ThatAreRightHaveNothingToldOfThem) {
    const std::vector<double> even = {0.4, 0.3, 0.3};
    const Trial trial = trial_of_subject(subject_of(powers(even, even)), 40, 130);
    TestCounts counts;
    const TestSettings settings = TestSettings::quick();
    TrialContext work(trial, settings, counts, 0);
    work.measure_density();
    const std::optional<LobeDraws> of = lobe_draws_of(work, 0);
    ASSERT_TRUE(of);
    EXPECT_EQ(of->lobes.size(), 3u);
    EXPECT_NEAR(of->lobes[1].from, 0.4, 1e-6);
    EXPECT_NEAR(of->lobes[1].to, 0.7, 1e-6);
    EXPECT_GT(of->at.size(), 100u);
    for (const LobeDraws::At& at : of->at) EXPECT_NEAR(at.together() / at.pdf, 1, 2e-3) << at.point.wi.z;
    const std::optional<Diagnosis> found = diagnose_several_lobes(work, 0);
    EXPECT_FALSE(found) << found->means;
}

}  // namespace
}  // namespace crescent
