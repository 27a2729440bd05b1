// Faults in a small part of what is drawn, and right samplers that look like them: a sun that pdf(w) does not know, a
// clamped number, a sliver that is never drawn, a sky of bands that falls short; answers that differ in their last
// bits.
#include <cmath>
#include <gtest/gtest.h>

#include "laws/judged.h"
#include "laws/right/right.h"
#include "math/functions.h"
#include "simd/random.h"
#include "stats/moments.h"
#include "subjects/builtin.h"
#include "subjects/list.h"
#include "trials/trial_context.h"
#include "trials/weights.h"
#include "verdicts/judge.h"

namespace crescent {
namespace {

Judgement judged(const Trial& trial, std::uint64_t draws = std::uint64_t{1} << 15) {
    return judged_alone(trial, of_draws(draws));
}

Vec3d spherical(double cos, double turns) { return about({0, 0, 1}, cos, turns); }

Recipe light(const char* name) {
    Recipe r{name, "", {}, {}, {}};
    r.traits.wo = Traits::Asked::none;
    r.pdf = [](Vec3d, Vec3d) { return 1 / (4 * pi); };
    return r;
}

Recipe cosine() {
    Recipe r{"cosine", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d wi) { return std::max(wi.z, 0.0) / pi; };
    r.sample = [](Vec3d, const Numbers& u) {
        const Vec3d wi = spherical(std::sqrt(1 - u[0]), u[1]);
        return Draw{wi, wi.z / pi, {}, {}};
    };
    return r;
}

/// f, and with it every weight, is 10 % more than is reflected: the spread of the weights is rounding, and no measure.
TEST(SmallFaults, OfWeightsThatAreAllAlikeAreToldInPerCent) {
    for (double rounding : {0.0, 1e-15, 1e-9}) {
        Recipe r = cosine();
        r.f = [](Vec3d, Vec3d wi) { return wi.z > 0 ? 0.5 / pi : 0.0; };
        r.sample = [right = r.sample, rounding](Vec3d wo, const Numbers& u) {
            Draw d = right(wo, u);
            d.weight = 0.55 * (u[0] < 3e-4 ? 1 + rounding : 1);
            return d;
        };
        const Verdict v = named(judged(trial_of_subject(subject_of(r), 45, 130)), "mean");
        EXPECT_EQ(v.state, State::wrong);
        EXPECT_NE(v.say.find("+10 %"), std::string::npos) << v.say;
        EXPECT_EQ(v.say.find("z ="), std::string::npos) << v.say;
    }
}

/// One draw in 1500 goes to a disk of 0.27 degrees that p, which integrates to one, knows nothing of.
TEST(SmallFaults, ASunThatThePdfDoesNotKnowIsFoundByTheDrawsThatCrowdThere) {
    Recipe r = light("even, with a sun");
    r.sample = [](Vec3d, const Numbers& u) {
        constexpr double share = 1.0 / 1500;
        if (u[0] < share) return Draw{about(tilt(50, 30), 1 - u[0] / share * 1.1e-5, u[1]), 1 / (4 * pi), {}, {}};
        return Draw{spherical(1 - 2 * (u[0] - share) / (1 - share), u[1]), 1 / (4 * pi), {}, {}};
    };
    const Verdict v = named(judged(trial_of_subject(subject_of(r), 0, 0)), "density");
    EXPECT_EQ(v.state, State::wrong) << v.say;
    EXPECT_NE(v.say.find("crowd"), std::string::npos) << v.say;
    const auto& w = v.evidence.at("clump").at("w");
    EXPECT_GT(dot(tilt(50, 30), Vec3d{w[0], w[1], w[2]}), 0.9999);
}

/// A sampler that draws numbers of its own, of 24 bits each.
Recipe with_numbers_of_its_own(Recipe r) {
    r.traits.own_random = true;
    r.sample = [right = r.sample](Vec3d wo, const Numbers& u) {
        const auto bits = [](double x) { return static_cast<std::uint32_t>(x * 0x1p24); };
        const auto h = pcg4d<std::uint32_t>({bits(u[0]), bits(u[1]), 7, 77});
        return right(wo, Vec2d{(h.x >> 8) * 0x1p-24, (h.y >> 8) * 0x1p-24});
    };
    return r;
}

/// u moves nothing there, and its steps are no cause.
TEST(SmallFaults, OfASamplerWithNumbersOfItsOwnAreFoundByTheDrawsThatCrowd) {
    Recipe r = light("even, with a sun");
    r.sample = [](Vec3d, const Numbers& u) {
        constexpr double share = 1.0 / 1500;
        if (u[0] < share) return Draw{about(tilt(50, 30), 1 - u[0] / share * 1.1e-5, u[1]), 1 / (4 * pi), {}, {}};
        return Draw{spherical(1 - 2 * (u[0] - share) / (1 - share), u[1]), 1 / (4 * pi), {}, {}};
    };
    const Verdict v = named(judged(trial_of_subject(subject_of(with_numbers_of_its_own(r)), 0, 0)), "density");
    EXPECT_EQ(v.state, State::wrong) << v.say;
    EXPECT_NE(v.say.find("crowd"), std::string::npos) << v.say;
    Recipe bent = cosine();
    bent.pdf = [](Vec3d, Vec3d wi) { return wi.z > 0 ? 1.5 * wi.z * wi.z / pi : 0; };
    const Verdict b = named(judged(trial_of_subject(subject_of(with_numbers_of_its_own(bent)), 45, 130)), "density");
    EXPECT_EQ(b.state, State::wrong) << b.say;
    EXPECT_EQ(b.say.find("2^-24"), std::string::npos) << b.say;
}

/// A lobe of which floats round the cosine: its draws near the axis are few directions, and nobody's fault.
TEST(SmallFaults, OfRoundingAreNoneWhereASamplerHasNumbersOfItsOwn) {
    constexpr double power = 1e4;
    Recipe r{"lobe in floats", "", {}, {}, {}};
    r.traits.wo = Traits::Asked::none;
    r.pdf = [](Vec3d, Vec3d wi) { return wi.z > 0 ? (power + 1) / (2 * pi) * math::exp(power * math::log(wi.z)) : 0; };
    r.sample = [pdf = r.pdf](Vec3d wo, const Numbers& u) {
        const float cos = static_cast<float>(math::exp(math::log(1 - u[0]) / (power + 1)));
        const float sin = std::sqrt(std::max(1 - cos * cos, 0.0f)), phi = static_cast<float>(2 * pi * u[1]);
        const Vec3d wi{double(sin * std::cos(phi)), double(sin * std::sin(phi)), double(cos)};
        return Draw{wi, pdf(wo, wi), {}, {}};
    };
    const Trial trial = trial_of_subject(subject_of(with_numbers_of_its_own(r)), 0, 0);
    const Verdict v = named(judged(trial, std::uint64_t{1} << 17), "density");
    EXPECT_EQ(v.state, State::right) << v.say;
}

TEST(SmallFaults, ANumberClampedAtOneThousandthPutsARingOfDrawsInOnePlace) {
    Recipe r = cosine();
    r.sample = [right = r.sample](Vec3d wo, const Numbers& u) { return right(wo, Vec2d{std::min(u[0], 0.999), u[1]}); };
    const Verdict v = named(judged(trial_of_subject(subject_of(r), 45, 130)), "density");
    EXPECT_EQ(v.state, State::wrong) << v.say;
}

TEST(SmallFaults, ASliverThatIsNeverDrawnMakesTheRestTooDense) {
    Recipe r = cosine();
    r.sample = [right = r.sample](Vec3d wo, const Numbers& u) { return right(wo, Vec2d{u[0], u[1] * 359.9 / 360}); };
    const Verdict v = named(judged(trial_of_subject(subject_of(r), 45, 130)), "identity");
    EXPECT_EQ(v.state, State::wrong) << v.say;
    EXPECT_NE(v.say.find("nearly everywhere"), std::string::npos) << v.say;
}

/// Seven bands of cos theta, of which p says `share`.
Recipe bands(double share) {
    static const std::vector<double> edge = {-1, -0.6, -0.1, 0, 0.15, 0.4, 0.8, 1}, height = {.5, 1, 2, 5, 3, 4, 2};
    double all = 0;
    for (std::size_t k = 0; k < height.size(); ++k) all += height[k] * (edge[k + 1] - edge[k]);
    const auto p = [all, share](double z) {
        std::size_t k = 0;
        while (k + 1 < height.size() && z >= edge[k + 1]) ++k;
        return share * height[k] / all / (2 * pi);
    };
    Recipe r = light("bands");
    r.pdf = [p](Vec3d, Vec3d wi) { return p(wi.z); };
    r.sample = [p, all](Vec3d, const Numbers& u) {
        double left = u[0] * all;
        std::size_t k = 0;
        for (; k + 1 < height.size() && left >= height[k] * (edge[k + 1] - edge[k]); ++k)
            left -= height[k] * (edge[k + 1] - edge[k]);
        const Vec3d wi = spherical(std::min(edge[k] + left / height[k], edge[k + 1] - 1e-12), u[1]);
        return Draw{wi, p(wi.z), {}, {}};
    };
    return r;
}

/// As a program behind a pipe: asked by one thread, and no more than it is worth.
class AsProgram : public JudgedSampler {
public:
    explicit AsProgram(Recipe r) : recipe_(std::move(r)) {}
    std::string name() const override { return recipe_.family; }
    Traits traits() const override { return recipe_.traits; }
    void sample(int, Vec3d wo, std::span<const Numbers> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) out[i] = recipe_.sample(wo, u[i]);
        answers_ += u.size();
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = recipe_.pdf(at[i].wo, at[i].wi);
        answers_ += at.size();
    }
    Spending spending() const override { return {answers_, 0, 0}; }
    bool serial() const override { return true; }

private:
    Recipe recipe_;
    mutable std::uint64_t answers_ = 0;
};

TEST(SmallFaults, OfSixInTenThousandAreFoundInASkyOfBandsWithinTheQuestionsOfAProgram) {
    const Judgement right = judged(trial_of_subject(std::make_shared<AsProgram>(bands(1)), 0, 0), 8192);
    EXPECT_EQ(right.state, State::right) << what_is_wrong(right);
    EXPECT_LT(named(right, "normalised").evidence["quadrature_error"].get<double>(), 1e-6);
    const Judgement wrong = judged(trial_of_subject(std::make_shared<AsProgram>(bands(0.9994)), 0, 0), 8192);
    EXPECT_EQ(named(wrong, "normalised").state, State::wrong) << named(wrong, "normalised").say;
}

/// What is right says what it could hide.
TEST(SmallFaults, ThatWouldNotBeSeenAreSaid) {
    const Judgement j = judged(trial_of_subject(subject_of(cosine()), 45, 130));
    EXPECT_GE(named(j, "normalised").evidence["unseen"].get<double>(), 1e-4);
    const double bin = named(j, "density").evidence["unseen_in_one_bin"].get<double>();
    EXPECT_GT(bin, 1e-3);
    EXPECT_LT(bin, 1e-2);
}

/// The last few of a block by other instructions, as NumPy has it.
TEST(SmallFaults, AnswersThatDifferInTheirLastBitsAreTheSame) {
    class Packed : public AsProgram {
    public:
        using AsProgram::AsProgram;
        void sample(int t, Vec3d wo, std::span<const Numbers> u, std::span<Draw> out) const override {
            AsProgram::sample(t, wo, u, out);
            for (std::size_t i = 0; i < out.size(); ++i)
                if (i % 8 < 3) out[i].wi.x *= 1 + 0x1p-52, out[i].pdf *= 1 - 0x1p-52;
        }
    };
    const Judgement j = judged(trial_of_subject(std::make_shared<Packed>(cosine()), 45, 130), 4096);
    EXPECT_EQ(named(j, "identity").state, State::right) << named(j, "identity").say;
}

/// A ball hides a part of the rectangle behind it: light by solid angle finds what the quadrature over both finds.
TEST(LightsOfATrial, ThatAreNoDisksAreAimedAtAndIntegrated) {
    for (const char* lighting : {"sphere", "disk + sphere + rectangle"}) {
        const TrialSetup on = trial_setup(LobeKind::none, true, lighting, 32);
        const Trial trial = trial_on(on, 45, 130, "light-solid-angle",
            std::make_shared<BuiltIn<LightSolidAngle>>(on.surface, tilt(45, 130), on.light));
        const Judgement j = judged(trial);
        for (const char* name : {"valid", "support", "density", "identity", "mean"})
            EXPECT_EQ(named(j, name).state, State::right) << lighting << ": " << named(j, name).say;
        EXPECT_GT(named(j, "mean").evidence["quadrature"].get<double>(), 0.1);
    }
    int hidden = 0;
    const TrialLight light = trial_setup(LobeKind::none, true, "sphere + rectangle", 32).light;
    for (double theta = 0; theta < 90; ++theta)
        for (double azimuth = 90; azimuth < 180; ++azimuth) {
            const Vec3d wi = tilt(theta, azimuth);
            const bool both = light.lamps[0].distance(wi) && light.lamps[1].distance(wi);
            hidden += both;
            if (both) EXPECT_EQ(light(wi), light.lamps[0].radiance);
        }
    EXPECT_GT(hidden, 50);
}

/// By area p has a pole along the ball's outline, one over the root of the distance to it.
TEST(LightsOfATrial, ABallByAreaIntegratesToOneAcrossThePoleAtItsOutline) {
    const TrialSetup on = trial_setup(LobeKind::none, true, "sphere", 32);
    for (double theta : {0.0, 45.0, 85.0}) {
        const Trial trial = trial_on(
            on, theta, 130, "light-area", std::make_shared<BuiltIn<LightArea>>(on.surface, tilt(theta, 130), on.light));
        const Judgement j = judged(trial);
        for (const char* name : {"valid", "support", "normalised", "density", "identity", "mean"})
            EXPECT_EQ(named(j, name).state, State::right) << theta << ": " << named(j, name).say;
    }
}

/// Weights of three values, of which the largest comes once in 200 draws: the steps between them are no tail.
TEST(Tails, OfFewValuesThatComeAgainAndAgainAreNone) {
    Recipe r{"three values", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d wi) { return wi.z > 0 ? 1 / (2 * pi) : 0.0; };
    r.f = [](Vec3d, Vec3d wi) {
        return wi.z > 0 ? 0.05 * (wi.z > 0.995 ? 60 : wi.z > 0.985 ? 5 : 1) / wi.z / pi : 0.0;
    };
    r.sample = [](Vec3d, Vec2d u) { return Draw{about({0, 0, 1}, 1 - u.x, u.y), 1 / (2 * pi), {}, {}}; };
    const Judgement j = judged(trial_of_subject(subject_of(r), 45, 130), 32768);
    const Verdict& tail = named(j, "tail");
    EXPECT_EQ(tail.state, State::right) << tail.say;
    EXPECT_FALSE(tail.evidence.contains("k")) << tail.say;
    EXPECT_GT(tail.evidence["times_largest"].get<int>(), 100);
    EXPECT_EQ(named(j, "mean").state, State::right) << named(j, "mean").say;
}

/// A lobe that one draw in a hundred is of, whose weights, uniform about 15 means, are far above the rest: a step up
/// into it is no tail. And weights u^-0.7, which have one, are told of by whatever is looked at.
TEST(Tails, OfALobeThatIsSeldomChosenAreThoseOfItsOwnWeights) {
    std::vector<double> stepped, heavy;
    for (int i = 0; i < 32768; ++i) {
        const double u = (i + 0.5) / 32768, v = math::exp(-0.7 * math::log(u));
        stepped.push_back(i % 100 == 0 ? 14 + 2 * u : 0.8 + 0.1 * u);
        heavy.push_back(v);
    }
    ASSERT_TRUE(tail_of(stepped));
    EXPECT_LT(tail_of(stepped)->k, 0.0);
    ASSERT_TRUE(tail_of(heavy));
    EXPECT_NEAR(tail_of(heavy)->k, 0.7, 0.1);
}

/// Weights of which a few are a hundredth larger are no tail, whatever their skewness: those of a sharp lobe.
TEST(Tails, AreNoneWhereTheLargestWeightIsHardlyMoreThanTheMean) {
    std::vector<double> x(32768, 0.72);
    x[7] *= 1.01;
    EXPECT_TRUE(mean_is_testable(spread(x), tail_of(x), {}));
    x[7] *= 2000;
    EXPECT_FALSE(mean_is_testable(spread(x), tail_of(x), {}));
}

}  // namespace
}  // namespace crescent
