// Samplers as people bring them: with a state, with a NaN that hides in a corner, with sharp lobes.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <gtest/gtest.h>
#include <mutex>

#include "laws/judged.h"
#include "laws/right/right.h"
#include "subjects/list.h"
#include "subjects/pipe.h"
#include "verdicts/efficiency.h"
#include "verdicts/error_rates.h"

namespace crescent {
namespace {

Judgement judged(std::shared_ptr<const JudgedSampler> subject, double theta = 45) {
    return judged_at(std::move(subject), theta, TestSettings::quick());
}

Recipe cosine() {
    Recipe r{"cosine", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d wi) { return std::max(wi.z, 0.0) / pi; };
    r.f = [](Vec3d wo, Vec3d wi) { return wo.z > 0 && wi.z > 0 ? 0.5 / pi : 0.0; };
    r.sample = [](Vec3d, Vec2d u) {
        const double r = std::sqrt(u.x), phi = 2 * pi * u.y, z = std::sqrt(1 - u.x);
        return Draw{{r * std::cos(phi), r * std::sin(phi), z}, z / pi, {}, {}};
    };
    return r;
}

class Logged : public JudgedSampler {
public:
    struct Call {
        const Logged* who;
        std::chrono::steady_clock::time_point start, end;
    };
    Logged(std::mutex& lock, std::vector<Call>& calls) : lock_(lock), calls_(calls) {}
    std::string name() const override { return "logged"; }
    void sample(int, Vec3d wo, std::span<const Numbers> u, std::span<Draw> out) const override {
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t i = 0; i < u.size(); ++i) out[i] = cosine_.sample(wo, u[i]);
        note(start);
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = cosine_.pdf(at[i].wo, at[i].wi);
        note(start);
    }
    bool has_f() const override { return true; }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = cosine_.f(at[i].wo, at[i].wi);
    }

private:
    void note(std::chrono::steady_clock::time_point start) const {
        const std::lock_guard guard(lock_);
        calls_.push_back({this, start, std::chrono::steady_clock::now()});
    }
    Recipe cosine_ = cosine();
    std::mutex& lock_;
    std::vector<Call>& calls_;
};

/// Half goes through; nobody said that w_o may lie under the surface, nor an index.
TEST(OwnSamplers, AskedFromBelowWithoutAnIndexAreNotHeldToOne) {
    Recipe r = cosine();
    r.pdf = [](Vec3d, Vec3d wi) { return 0.5 * std::fabs(wi.z) / pi; };
    r.f = [](Vec3d, Vec3d) { return 0.3 / pi; };
    r.sample = [](Vec3d, Vec2d u) {
        const double side = u.x < 0.5 ? 1 : -1, x = u.x < 0.5 ? 2 * u.x : 2 * u.x - 1;
        const double phi = 2 * pi * u.y, z = std::sqrt(1 - x), s = std::sqrt(x);
        return Draw{{s * std::cos(phi), s * std::sin(phi), side * z}, 0.5 * z / pi, {}, {}};
    };
    for (double theta : {30.0, 150.0}) {
        const Judgement j = judged(subject_of(r), theta);
        const Verdict& v = named(j, "physics");
        EXPECT_EQ(v.state, State::right) << v.say;
        EXPECT_EQ(v.say.find("with eta^2"), std::string::npos) << v.say;
    }
}

/// An even p under the surface, drawn otherwise, by a sampler whose warp cannot be looked at: what is known of the
/// upper side alone explains nothing there.
TEST(OwnSamplers, AreExplainedByNoFactorThatIsNoNumber) {
    Recipe r = cosine();
    r.traits.own_random = true;
    r.pdf = [](Vec3d, Vec3d wi) { return wi.z < 0 ? 0.5 / pi : 0; };
    r.f = [](Vec3d, Vec3d wi) { return wi.z < 0 ? 0.3 / pi : 0; };
    r.sample = [](Vec3d, Vec2d u) {
        const double phi = 2 * pi * u.y, z = std::pow(u.x, 0.3), s = std::sqrt(1 - z * z);
        return Draw{{s * std::cos(phi), s * std::sin(phi), -z}, 0.5 / pi, {}, {}};
    };
    const Judgement j = judged(subject_of(r), 150);
    const Verdict& v = named(j, "density");
    EXPECT_EQ(v.state, State::wrong);
    EXPECT_EQ(v.say.find("nan"), std::string::npos) << v.say;
}

/// Seven turns, each of every sampler once, and nothing beside them: their times can be compared.
TEST(OwnSamplers, AreTimedInTurnsWhileNothingElseIsAsked) {
    std::mutex lock;
    std::vector<Logged::Call> calls;
    std::vector<Trial> trials;
    for (int i = 0; i < 4; ++i) trials.push_back(trial_of_subject(std::make_shared<Logged>(lock, calls), 15.0 * i, 0));
    TestSettings settings;
    settings.draws = 4096;
    ProgressMonitor monitor;
    judge(trials, settings, monitor);
    std::sort(calls.begin(), calls.end(), [](const auto& a, const auto& b) { return a.start < b.start; });
    ASSERT_GT(calls.size(), 28u);
    for (std::size_t i = calls.size() - 28; i < calls.size(); ++i) {
        EXPECT_EQ(calls[i].who, trials[(i - (calls.size() - 28)) % 4].subject.get());
        EXPECT_GE(calls[i].start, calls[i - 1].end);
    }
}

class Delayed : public JudgedSampler {
public:
    std::string name() const override { return "answers with its previous draw"; }
    void sample(int, Vec3d wo, std::span<const Numbers> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            out[i] = last_;
            last_ = cosine_.sample(wo, u[i]);
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = cosine_.pdf(at[i].wo, at[i].wi);
    }
    bool serial() const override { return true; }

private:
    Recipe cosine_ = cosine();
    mutable Draw last_ = cosine_.sample({0, 0, 1}, {0.5, 0.5});
};

TEST(OwnSamplers, ThatKeepAStateAreToldSo) {
    const Judgement j = judged(std::make_shared<Delayed>());
    EXPECT_EQ(named(j, "identity").state, State::wrong);
    EXPECT_NE(named(j, "identity").say.find("another answer when it is asked again"), std::string::npos)
        << named(j, "identity").say;
}

TEST(OwnSamplers, WithANaNInOneCornerAreStillJudgedWhole) {
    Recipe r = cosine();
    r.sample = [right = r.sample](Vec3d wo, Vec2d u) {
        Draw d = right(wo, u);
        if (u.x == 0 && u.y == 0) d.pdf = std::nan("");
        return d;
    };
    const Judgement j = judged(subject_of(r));
    EXPECT_EQ(named(j, "valid").state, State::wrong);
    EXPECT_NE(named(j, "valid").say.find("u = (0, 0)"), std::string::npos) << named(j, "valid").say;
    EXPECT_DOUBLE_EQ(named(j, "valid").evidence["chance_of_a_sample"].get<double>(), 0x1p-48);
    for (const char* name : {"support", "normalised", "density", "identity", "physics", "tail", "mean"})
        EXPECT_EQ(named(j, name).state, State::right) << name << ": " << named(j, name).say;
}

TEST(OwnSamplers, WithANaNInAFewDrawsAreJudgedByTheRest) {
    Recipe r = cosine();
    r.sample = [right = r.sample](Vec3d wo, Vec2d u) {
        Draw d = right(wo, u);
        if (u.x > 0.5 && u.x < 0.5 + 4e-5) d.wi.x = std::nan("");
        return d;
    };
    const Judgement j = judged(subject_of(r));
    EXPECT_EQ(named(j, "valid").state, State::wrong);
    EXPECT_NE(named(j, "valid").say.find("draws cannot be used"), std::string::npos) << named(j, "valid").say;
    EXPECT_EQ(named(j, "density").state, State::right) << named(j, "density").say;
    EXPECT_EQ(named(j, "mean").state, State::right) << named(j, "mean").say;
}

TEST(OwnSamplers, WithSharpLobesAndBoundedWeightsHaveNoHeavyTail) {
    for (double alpha : {0.02, 0.005})
        for (double theta : {0.0, 30.0, 75.0}) {
            const Judgement j = judged(subject_of(ggx_visible_at(alpha, alpha * 3)), theta);
            EXPECT_EQ(j.state, State::right) << what_is_wrong(j);
        }
}

/// A library leaves the signals of the process that it is in alone, and does not let a program's end kill it.
TEST(OwnSamplers, BehindAPipeThatBreaksTouchNoSignal) {
    const auto before = std::signal(SIGPIPE, SIG_DFL);
    try {
        const auto pipe = start_pipe("read hello; echo hello 1 x; read f; echo -; exec <&-; sleep 0.2");
        std::vector<Numbers> u(100000, {0.5, 0.5});
        std::vector<Draw> out(u.size());
        pipe->sample(0, {0, 0, 1}, u, out);
        ADD_FAILURE() << "it answered";
    } catch (const SubjectFault& fault) {
        EXPECT_NE(std::string(fault.what()).find("closed its input"), std::string::npos) << fault.what();
    }
    sigset_t pending;
    sigpending(&pending);
    EXPECT_FALSE(sigismember(&pending, SIGPIPE));
    EXPECT_EQ(std::signal(SIGPIPE, before), SIG_DFL);
}

TEST(ErrorRates, HaveTheIntervalOfClopperAndPearson) {
    EXPECT_NEAR(rate_interval(0, 100).second, 0.03622, 1e-5);
    EXPECT_NEAR(rate_interval(5, 100).first, 0.01643, 1e-5);
    EXPECT_NEAR(rate_interval(5, 100).second, 0.11283, 1e-5);
    EXPECT_EQ(rate_interval(7, 7).second, 1);
}

TEST(Efficiencies, AreRankedOnlyWhereIntervalsAreApart) {
    std::vector<Trial> trials;
    for (const char* name : {"good", "poor", "alike"}) {
        trials.push_back(trial_of_subject(subject_of(cosine()), 45, 0));
        trials.back().arm = name;
    }
    std::vector<Efficiency> all(3);
    const double variance[] = {1, 10, 1.01};
    for (std::size_t i = 0; i < 3; ++i)
        all[i].trial = i, all[i].variance = variance[i], all[i].relative_se = 0.02, all[i].nanoseconds = 10,
        all[i].cost_se = 0.02;
    const std::vector<Verdict> v = judge_efficiency(trials, all);
    EXPECT_EQ(v[0].state, State::right);
    all[1].heavy = true;
    EXPECT_EQ(judge_efficiency(trials, all)[1].state, State::inconclusive);
    EXPECT_GT(all[1].low(), all[0].high());
    EXPECT_GT(all[2].high(), all[0].low());
}

}  // namespace
}  // namespace crescent
