// The queries of a program: no more than quick mode states, correct samplers are conclusive within that number, and
// typical faults of renderers are found within it.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "check/against.h"
#include "check/check.h"
#include "check/report/result_json.h"
#include "check/report/summary.h"
#include "check/sources/cases.h"
#include "check/sources/decorators.h"
#include "check/sources/check_case.h"
#include "check/user.h"
#include "tests/known_samplers/correct/renderers.h"
#include "tests/known_samplers/faulty/planted.h"
#include "tests/support/checked.h"
#include "tests/support/sanitized.h"

namespace crescent {
namespace evaluation_counts_test {

/// A sampler with the restrictions of a program behind a pipe: a single thread queries it, and its queries are counted.
class Counted : public SamplerSource {
public:
    explicit Counted(std::shared_ptr<const SamplerAdapter> inner) : inner_(std::move(inner)) {}
    std::string name() const override { return inner_->name(); }
    Traits traits() const override { return inner_->traits(); }
    bool serial() const override { return true; }
    QueryUsage spending() const override { return {answers_, 0, 0}; }
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        answers_ += u.size();
        inner_->sample(t, wo, u, out);
    }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        answers_ += at.size();
        inner_->pdf(t, at, out);
    }
    bool has_f() const override { return inner_->has_f(); }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        answers_ += at.size();
        inner_->f(at, out);
    }
    void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override {
        answers_ += at.size();
        inner_->f_channels(at, out);
    }

private:
    std::shared_ptr<const SamplerAdapter> inner_;
    mutable std::uint64_t answers_ = 0;
};

struct Seen {
    CheckResult result;
    std::uint64_t most = 0;  // at one w_o
};

/// Every w_o is checked by a call of its own. going_on: evaluations by which a check that is not decided goes on.
Seen checked(const std::vector<CheckCase>& check_cases, std::size_t going_on = 0) {
    Seen out;
    for (const CheckCase& t : check_cases) {
        const auto program = std::make_shared<Counted>(t.adapter);
        CheckCase one = t;
        one.adapter = program;
        ProgressMonitor monitor;
        TestSettings settings = TestSettings::quick();
        settings.further_in_all = going_on;
        const CheckResult j = run_checks({&one, 1}, settings, monitor);
        for (const Verdict& v : j.verdicts) out.result.verdicts.push_back(v);
        out.most = std::max(out.most, program->spending().answers);
    }
    return out;
}

std::vector<CheckCase> at(const SyntheticSampler& recipe, std::initializer_list<std::pair<double, double>> grid) {
    std::vector<CheckCase> out;
    for (const auto& [theta, azimuth] : grid) out.push_back(make_user_case(make_adapter(recipe), theta, azimuth));
    return out;
}

constexpr std::uint64_t promised = 500000, in_process = 1500000;

/// From the denser side, beyond the angle of total reflection, a number selects at only a few points.
TEST(Programs, CorrectGlassIsConclusiveInQuickMode) {
    const RoughGlass sharp{0.05, 1.5}, broad{0.5, 1.5};
    for (const SyntheticSampler& r : {recipe_of(sharp), recipe_of(broad)}) {
        const Seen seen = checked(at(r, {{0, 0}, {85, 75}, {120, 250}, {95, 75}}));
        for (const Verdict& v : seen.result.verdicts)
            EXPECT_TRUE(v.state == State::right || v.state == State::skipped)
                << r.parameters << " " << v.check_case << " " << v.name << ": " << v.message();
        EXPECT_LE(seen.most, promised);
        EXPECT_GT(seen.most, 100000u);
    }
}

TEST(Programs, CorrectLayersAreConclusiveInQuickMode) {
    Layers layers;
    layers.alpha = 0.1;
    for (const SyntheticSampler& r : {recipe_of(SmoothCoat{}), recipe_of(layers), ggx_visible_at(0.05, 0.5)}) {
        const Seen seen = checked(at(r, {{45, 130}, {89, 180}}));
        for (const Verdict& v : seen.result.verdicts)
            EXPECT_TRUE(v.state == State::right || v.state == State::skipped)
                << r.family << " " << v.check_case << " " << v.name << ": " << v.message();
        EXPECT_LE(seen.most, promised) << r.family;
    }
}

/// p jumps along thousands of curves, and is not the density of the draws.
TEST(Programs, AreAskedNoMoreWhereNothingIsSettled) {
    SyntheticSampler wrinkled = ggx_visible_at(0.3, 0.3);
    wrinkled.pdf = [](Vec3d, Vec3d wi) {
        return wi.z > 0 ? (std::fmod(std::fabs(1e3 * wi.x * wi.y + 977 * wi.z), 1.0) < 0.5 ? 1.9 : 0.1) / (2 * pi)
                        : 0.0;
    };
    EXPECT_LE(checked(at(wrinkled, {{75, 310}})).most, promised);
}

/// A program that mixes up the rows of its blocks: of draws, of pdf(w) or of f(w).
class Mixed : public DecoratedSampler {
public:
    enum class Answers { draws, pdf, f };
    enum class How { last_repeated, first_two_exchanged, late_rows_of_long_blocks };
    Mixed(std::shared_ptr<const SamplerAdapter> sampler, Answers answers, How how)
        : DecoratedSampler(std::move(sampler), {}, [](SamplerDeclaration& d) { d.serial = true; }),
          answers_(answers),
          how_(how) {}
    void evaluate(const SamplerQuery& query, const SamplerAnswers& out) const override {
        using Kind = SamplerQuery::Kind;
        inner().evaluate(query, out);
        if (answers_ == Answers::draws) mix(out.draws);
        if (answers_ == Answers::pdf && (query.kind == Kind::pdf || query.kind == Kind::exact_pdf)) mix(out.values);
        if (answers_ == Answers::f && query.kind == Kind::f) mix(out.values);
    }

private:
    Answers answers_;
    How how_;
    template <class T> void mix(std::span<T> out) const {
        const std::size_t n = out.size();
        if (n < 2) return;
        if (how_ == How::last_repeated) out[n - 1] = out[n - 2];
        if (how_ == How::first_two_exchanged) std::swap(out[0], out[1]);
        if (how_ == How::late_rows_of_long_blocks && n > 1024) out[n - 1] = out[1023];
    }
};

TEST(Programs, ThatMixUpTheRowsOfABlockAreFound) {
    SyntheticSampler lobe{"lobe", "", {}, {}, {}};
    lobe.pdf = [](Vec3d, Vec3d i) { return i.z > 0 ? 3 * i.z * i.z / (2 * pi) : 0; };
    lobe.f = [](Vec3d, Vec3d i) { return i.z > 0 ? 0.5 * i.z / pi : 0; };
    lobe.sample = [](Vec3d, const PrimarySample& u) {
        const Vec3d i = about({0, 0, 1}, std::cbrt(1 - u[0]), u[1]);
        return Draw{i, 3 * i.z * i.z / (2 * pi), {}, {}};
    };
    for (auto answers : {Mixed::Answers::draws, Mixed::Answers::pdf, Mixed::Answers::f})
        for (auto how :
            {Mixed::How::last_repeated, Mixed::How::first_two_exchanged, Mixed::How::late_rows_of_long_blocks}) {
            const auto program = std::make_shared<Mixed>(make_adapter(lobe), answers, how);
            const CheckResult j = checked_at(program, 45, TestSettings::quick());
            EXPECT_EQ(named(j, "identity").state, State::wrong)
                << static_cast<int>(answers) << static_cast<int>(how) << what_is_wrong(j);
        }
}

/// All w_o of the grid in one call: 3.6 million evaluations, the greatest share of which none needs.
TEST(Programs, AreEvaluatedNoMoreThanInAll) {
    const auto program = std::make_shared<Counted>(make_adapter(recipe_of(RoughGlass{0.3, 1.5})));
    std::vector<CheckCase> check_cases = make_user_cases(program, false);
    ASSERT_EQ(
        std::count_if(check_cases.begin(), check_cases.end(), [](const CheckCase& t) { return !t.baseline; }), 12);
    ProgressMonitor monitor;
    const CheckResult j = run_checks(check_cases, TestSettings::quick(), monitor);
    EXPECT_NE(j.state, State::wrong) << what_is_wrong(j);  // a twelfth of all leaves two w_o open
    EXPECT_LE(j.questions, 3600000u);
    EXPECT_EQ(j.questions, program->spending().answers);
}

/// GGX by visible normals whose p jumps along thousands of curves, as a struct that counts its queries.
struct Aimed {
    Vec3d wi;
    double pdf;
};
template <class Count> struct Wrinkled {
    Count* asked;
    SyntheticSampler smooth = ggx_visible_at(0.3, 0.3);
    Aimed drawn(Vec3d wo, Vec2d u) const {
        ++*asked;
        const Draw d = smooth.sample(wo, PrimarySample{u.x, u.y});
        return {d.wi, d.pdf};
    }
    double wrinkled(Vec3d wi) const {
        ++*asked;
        return wi.z > 0 && std::fmod(std::fabs(1e3 * wi.x * wi.y + 977 * wi.z), 1.0) < 0.5 ? 0.3 : 0;
    }
};
struct WrinkledForOneThread : Wrinkled<std::uint64_t> {
    Aimed sample(Vec3d wo, Vec2d u) { return drawn(wo, u); }
    double pdf(Vec3d, Vec3d wi) { return wrinkled(wi); }
};
struct WrinkledForMany : Wrinkled<std::atomic<std::uint64_t>> {
    Aimed sample(Vec3d wo, Vec2d u) const { return drawn(wo, u); }
    double pdf(Vec3d, Vec3d wi) const { return wrinkled(wi); }
};

/// A struct in this process receives as many queries as a built-in sampler, for one thread or many, and their number is
/// reported.
TEST(Structs, AreCountedAndSparedAsArmsAre) {
    TestSettings settings = TestSettings::quick();
    settings.wo = {{30, 0}, {85, 75}};
    std::uint64_t by_one = 0;
    EXPECT_EQ(check_sampler("wrinkled", WrinkledForOneThread{{&by_one}}, settings).questions, by_one);
    EXPECT_LE(by_one, 2 * in_process);
    std::atomic<std::uint64_t> by_many = 0;
    EXPECT_EQ(check_sampler("wrinkled", WrinkledForMany{{&by_many}}, settings).questions, by_many);
    EXPECT_LE(by_many, 2 * in_process);
    by_many = 0;
    check_sampler("wrinkled", WrinkledForMany{{&by_many}});
    EXPECT_LE(by_many, 12 * in_process);
}

/// The queries of a struct do not depend on the number of threads.
TEST(Structs, AreAskedTheSameByAnyNumberOfThreads) {
    TestSettings settings = TestSettings::quick();
    settings.wo = {{30, 0}, {60, 40}, {85, 75}};
    std::atomic<std::uint64_t> asked = 0;
    const auto describe = [&] {
        const CheckResult j = check_sampler("wrinkled", WrinkledForMany{{&asked}}, settings);
        std::string out = fmt::format("{} questions\n", j.questions);
        for (const Verdict& v : j.verdicts)
            if (v.name != "efficiency") out += v.check_case + " " + v.message() + "\n";  // efficiency reports times
        return out;
    };
    EXPECT_EQ(describe(), on_threads(1, describe));
}

class FaultsOfPrograms : public testing::TestWithParam<std::size_t> {};

/// A fourth of the faults of renderers, each at one w_o after the other until it is found.
TEST_P(FaultsOfPrograms, AreCaughtWithinWhatTheyAreAsked) {
    const std::vector<PlantedFault> faults = renderer_faults();
    for (std::size_t i = GetParam(); i < faults.size(); i += 4 * test::every) {
        bool caught = false;
        for (const CheckCase& check_case : faults[i].check_cases) {
            const Seen seen = checked({check_case});
            EXPECT_LE(seen.most, promised) << faults[i].name;
            for (const Verdict& v : seen.result.verdicts) caught = caught || v.state == State::wrong;
            if (caught) break;
        }
        EXPECT_TRUE(caught) << faults[i].name;
    }
}
INSTANTIATE_TEST_SUITE_P(Quarter, FaultsOfPrograms, testing::Values(0u, 1u, 2u, 3u));

TEST(CachingAdapter, QueriesOnlyWhatIsNotCached) {
    const auto program = std::make_shared<Counted>(make_adapter(ggx_visible_at(0.3, 0.3)));
    const auto kept = cached(program);
    const Vec3d wo = tilt(30), a = tilt(20, 10), b = tilt(50, 200), c = tilt(70, 300);
    const std::vector<Pair> first = {{wo, a}, {wo, b}, {wo, a}}, second = {{wo, c}, {wo, b}, {a, b}};
    std::vector<double> out(3), direct(3);
    kept->f(first, out);
    EXPECT_EQ(program->spending().answers, 2u) << "one of three stood there twice";
    kept->f(second, out);
    EXPECT_EQ(program->spending().answers, 4u);
    program->f(second, direct);
    EXPECT_EQ(out, direct);
    kept->exact_pdf(0, second, out);
    program->pdf(0, second, direct);
    EXPECT_EQ(out, direct);
}

/// A built-in sampler has a case for every surface and light; a program compared with it gives the same results in all
/// of them.
TEST(Against, AsksAProgramOnceAtEachDirection) {
    const std::vector<CheckCase> a = make_cases("cosine", {}, false, {{45, 0}});
    ASSERT_GE(a.size(), 4u);
    const auto answers = [&](std::span<const CheckCase> check_cases) {
        const auto program = std::make_shared<Counted>(a[0].adapter);
        TestSettings settings;
        settings.budget = check::CheckBudget::limited();
        ProgressMonitor monitor;
        compare_samplers(check_cases, sampler_against(program, check_cases), settings, false, monitor);
        return program->spending().answers;
    };
    EXPECT_LT(answers(a), 2 * answers(std::span(a).first(1)));
}

/// Files have equal bytes for equal calls, including the number of queries, for any other outputs.
TEST(WoDomain, PicturesTakeNoQuestionsOfTheirOwn) {
    const auto answers = [](bool pictures) {
        CheckCase check_case = make_cases("cosine", {}, false, {{45, 0}})[0];
        check_case.adapter = std::make_shared<Counted>(check_case.adapter);
        TestSettings settings;
        settings.budget = check::CheckBudget::limited();
        settings.pictures = pictures;
        ProgressMonitor monitor;
        CheckResult result = run_checks({&check_case, 1}, settings, monitor);
        EXPECT_EQ(result.maps.empty(), !pictures);
        result.maps.clear();
        result.weights.clear();
        return verdict_json(result, {});
    };
    EXPECT_EQ(answers(true), answers(false));
}

}  // namespace evaluation_counts_test
}  // namespace crescent
