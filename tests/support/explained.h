// A check of a sampler at a few w_o with the cause that is named.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "check/explain/causes.h"
#include "check/explain/hypothesis.h"
#include "check/report/verdicts.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {

/// The outcome of a check, and what is said of it.
struct Explained {
    std::vector<CheckCase> check_cases;
    std::vector<CheckOutcome> outcomes;
    std::optional<Cause> cause;
    bool wrong() const { return outcomes.at(0).wrong(); }
    std::string text() const { return cause ? cause->factor + ": " + cause->text : "none"; }
    std::vector<Verdict> verdicts() const { return verdicts_of(check_cases, outcomes.at(0), cause); }
    /// Places where the density is wrong, with this number of draws.
    std::vector<Place> places(std::uint32_t draws = 4096) const {
        return places_of(check_cases, outcomes.at(0), 2, draws);
    }
};

/// Checks without an explanation. Directions: theta and azimuth of w_o in degrees.
inline Explained checked(FunctionSampler made, const std::vector<std::pair<double, double>>& directions = {{40, 30}}) {
    const auto adapter = std::make_shared<FunctionSampler>(std::move(made));
    Explained out;
    for (const auto& [theta, azimuth] : directions) {
        CheckCase& t = out.check_cases.emplace_back();
        t.arm = "made";
        t.wo = tilt(theta, azimuth);
        t.theta_deg = theta;
        t.azimuth_deg = azimuth;
        t.adapter = adapter;
    }
    CheckSettings settings;
    settings.budget = CheckBudget::limited();
    ProgressMonitor monitor;
    out.outcomes = check_samplers(out.check_cases, settings, monitor);
    return out;
}
inline Explained explained(
    FunctionSampler made, const std::vector<std::pair<double, double>>& directions = {{40, 30}}) {
    Explained out = checked(std::move(made), directions);
    if (out.wrong()) out.cause = cause_of(out.check_cases, out.outcomes[0]);
    return out;
}

inline FunctionSampler made(decltype(FunctionSampler::draw) draw, decltype(FunctionSampler::p) p, int numbers = 2,
    Traits::WoDomain wo = Traits::WoDomain::upper) {
    FunctionSampler out;
    out.draw = std::move(draw);
    out.p = std::move(p);
    out.of.numbers = numbers;
    out.of.wo = wo;
    return out;
}

inline void expect_cause(const Explained& r, const char* factor) {
    EXPECT_TRUE(r.wrong());
    EXPECT_TRUE(r.cause && r.cause->factor == factor) << "expected " << factor << ", got " << r.text();
}

}  // namespace crescent::check
