// run_checks(): order of the verdicts, partial results of a sampler that fails or is too slow, budgets and levels.
#include "check/check.h"

#include <cmath>
#include <gtest/gtest.h>

#include "check/constants.h"
#include "check/decide/check_at.h"
#include "check/sources/cases.h"
#include "check/verdict.h"

namespace crescent {
namespace check_test {

/// Lambert by the cosine, p times `factor`; a program that gives `rate` answers per second and has `allowed` seconds.
class Program : public SamplerSource {
public:
    double factor = 1, rate = 1e5, allowed = 0;
    std::uint64_t fails_at = ~std::uint64_t{0};  // number of answers before it fails

    std::string name() const override { return "program"; }
    bool serial() const override { return true; }
    QueryUsage spending() const override { return {answers_, static_cast<double>(answers_) / rate, allowed}; }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        answer(u.size());
        for (std::size_t i = 0; i < u.size(); ++i) {
            const double r = std::sqrt(u[i].x), phi = 2 * pi * u[i].y, z = std::sqrt(1 - u[i].x);
            out[i] = {{r * std::cos(phi), r * std::sin(phi), z}, factor * z / pi, {}, {}};
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        answer(at.size());
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = factor * std::max(at[i].wi.z, 0.0) / pi;
    }
    bool has_f() const override { return true; }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        answer(at.size());
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = at[i].wi.z > 0 ? 0.5 / pi : 0;
    }

private:
    mutable std::uint64_t answers_ = 0;
    mutable bool failed_ = false;
    void answer(std::size_t n) const {
        if (failed_) throw SamplerExited("given up");
        answers_ += n;
        if (answers_ > fails_at) {
            failed_ = true;
            throw SamplerError("no answer");
        }
        if (allowed > 0 && spending().seconds > allowed) throw SamplerTimeout("too slow");
    }
};

std::vector<CheckCase> cases_of_program(const std::shared_ptr<const Program>& program) {
    return make_user_cases(program, false, {{0, 0}, {45, 90}, {85, 0}, {20, 10}});
}

CheckResult checked(const std::shared_ptr<const Program>& program, bool accept_few = false) {
    TestSettings settings;
    settings.accept_few = accept_few;
    ProgressMonitor monitor;
    return run_checks(cases_of_program(program), settings, monitor);
}

const Verdict& verdict_at(const CheckResult& j, std::size_t check_case, std::string_view name) {
    for (std::size_t k = 0; k < verdict_names.size(); ++k)
        if (verdict_names[k] == name) return j.verdicts[check_case * verdict_names.size() + k];
    throw std::out_of_range("no such verdict");
}

TEST(RunChecks, OrdersVerdictsByCaseAndList) {
    const auto program = std::make_shared<Program>();
    std::vector<CheckCase> check_cases = cases_of_program(program);
    ProgressMonitor monitor;
    const CheckResult j = run_checks(check_cases, TestSettings::quick(), monitor);
    std::erase_if(check_cases, [](const CheckCase& t) { return t.baseline; });
    ASSERT_EQ(j.verdicts.size(), 4 * verdict_names.size());
    for (std::size_t i = 0; i < j.verdicts.size(); ++i) {
        EXPECT_EQ(j.verdicts[i].name, verdict_names[i % verdict_names.size()]);
        EXPECT_EQ(j.verdicts[i].check_case, check_cases[i / verdict_names.size()].text());
    }
    EXPECT_EQ(j.state, State::right);
    EXPECT_EQ(j.questions, program->spending().answers);
    EXPECT_LE(j.questions, 4u * 500000);
    EXPECT_LE(j.evaluations, j.questions);
}

/// The middle and the most grazing w_o come first. w_o for which no time is left are inconclusive, except for `valid`.
TEST(RunChecks, SkipsCasesWithoutRemainingTime) {
    const auto program = std::make_shared<Program>();
    program->allowed = 10.5;  // 1,050,000 answers, two w_o
    const CheckResult j = checked(program);
    for (std::size_t examined : {std::size_t{1}, std::size_t{2}})
        EXPECT_EQ(verdict_at(j, examined, "density").state, State::right);
    for (std::size_t left : {std::size_t{0}, std::size_t{3}}) {
        EXPECT_EQ(verdict_at(j, left, "valid").state, State::right);
        EXPECT_EQ(verdict_at(j, left, "density").state, State::inconclusive);
        EXPECT_EQ(verdict_at(j, left, "density").next.kind, NextStep::Kind::more_time);
    }
    ASSERT_EQ(j.left_out.size(), 2u);
    EXPECT_EQ(j.left_out[0].verdicts.size(), verdict_names.size() - 1);
    EXPECT_EQ(j.state, State::inconclusive);
}

TEST(RunChecks, AcceptsFewCasesButNotNone) {
    const auto some = std::make_shared<Program>(), none = std::make_shared<Program>();
    some->allowed = 10.5;
    none->allowed = 0.5;
    const CheckResult j = checked(some, true);
    EXPECT_EQ(j.state, State::right);
    EXPECT_EQ(j.left_out.size(), 2u);
    EXPECT_EQ(verdict_at(j, 0, "density").state, State::skipped);
    EXPECT_EQ(checked(none, true).state, State::inconclusive);
}

/// Results of earlier w_o are kept, and the first error is reported.
TEST(RunChecks, KeepsResultsFromBeforeAFailure) {
    const auto program = std::make_shared<Program>();
    program->fails_at = 500000;
    const CheckResult j = checked(program);
    EXPECT_EQ(j.state, State::error);
    EXPECT_EQ(verdict_at(j, 1, "density").state, State::right);
    EXPECT_EQ(verdict_at(j, 2, "valid").state, State::right);  // from its first draws
    EXPECT_EQ(verdict_at(j, 2, "support").message(), "The sampler failed: no answer.");
    EXPECT_EQ(verdict_at(j, 2, "support").evidence["first_fault"], "no answer");
    EXPECT_EQ(verdict_at(j, 0, "density").message(), "Not evaluated: the sampler failed before.");
    EXPECT_TRUE(j.left_out.empty());
}

TEST(RunChecks, QueriesAProgramWithinItsBudget) {
    for (std::uint64_t most : {200000u, 300000u, 500000u})
        for (double factor : {1.0, 1.002, 1.005, 1.1}) {
            Program program;
            program.factor = factor;
            const check::CheckAt c =
                check::check_sampler_at(program, 0, {0, 0.6, 0.8}, {}, check::CheckBudget::limited(most), 1);
            EXPECT_LE(program.spending().answers, (factor == 1.0 ? 1 : 2) * most) << factor;
            if (factor != 1.002) EXPECT_EQ(c.wrong(), factor != 1.0) << most << " " << factor;
        }
}

TEST(RunChecks, SharesAlphaBetweenTheStages) {
    for (double alpha : {1e-9, 1e-6, 1e-3, 0.05, 0.5})
        for (double questions : {1.0, 1e5, 1e7}) {
            const check::Levels l = check::levels_of(alpha, questions);
            EXPECT_NEAR(l.first * l.second * std::max(questions, 1e5) / alpha, 1, 1e-9);
            EXPECT_LE(l.second, 0.1 + 1e-12);
            EXPECT_GE(l.second, 1e-5 - 1e-18);
        }
    EXPECT_NEAR(check::levels_of(1e-3, 1).first, check::alpha1, 1e-12);
    EXPECT_NEAR(check::levels_of(1e-3, 1).second, check::alpha2, 1e-12);
}

}  // namespace check_test
}  // namespace crescent
