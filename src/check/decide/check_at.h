// One technique of a sampler at one w_o: estimates, tests, two stages and findings.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "check/constants.h"
#include "check/decide/sizes.h"
#include "check/decide/small_tests.h"
#include "check/estimate/budget.h"
#include "check/estimate/evaluation_noise.h"
#include "check/estimate/source.h"
#include "check/verdict.h"
#include "check/verdicts/questions.h"

namespace crescent::check {

/// The inputs of a check at one w_o besides the sampler.
struct CaseData {
    CaseLighting light{};
    std::uint16_t place = 0;  // index of the case in its call: selects its random streams
    Levels levels{};
    double reserved = 0;  // evaluations of a program with a time limit that other w_o need
};

/// A test that failed at both stages, or at one if it needs no second stage (a NaN is not a matter of chance).
struct Finding {
    Answer first, second;
    double members = 1;  // number of members that share alpha1
};

/// The result at one w_o. Evidence is kept for the explanation.
struct CheckAt {
    Vec3d wo{};
    int technique = 0;
    Traits traits{};
    std::vector<Finding> findings;
    std::vector<SmallFault> small;
    std::vector<Answer> suspected;  // failed at stage 1 and passed at stage 2
    std::vector<Answer> answers;    // by family, at the last look: the least p times the number of members
    Sizes sizes;
    bool inconclusive = false;
    InvalidAnswers invalid;          // of pdf(w) and f(w)
    double moved_by_resolution = 0;  // share of the draws, if their numbers are too coarse for a test of the density
    bool nothing_drawn = false;      // no draw is a direction or a delta part, and p is 0 at every point
    bool draws_elsewhere = false;    // whether a sampler that returns no sample here draws at another w_o
    EvaluationNoise scatter;         // of pdf(w) and f(w), if they are random estimates
    int looks = 0;
    std::uint64_t evaluations = 0;
    double seconds = 0;
    std::shared_ptr<const Plan> plan;
    Integrals integrals;
    Observations observations;
    /// The ratio of a size to its target above which a verdict is inconclusive.
    double most_ratio() const;
    /// Whether points do not determine the integral of p.
    bool is_integral_open() const;
    bool wrong() const { return !findings.empty() || !small.empty(); }
    /// Whether the verdict is built on answers of which too many are not numbers, so that it is not given.
    bool is_withheld(std::string_view verdict) const;
};

CheckAt check_sampler_at(const SamplerAdapter& adapter, int technique, Vec3d wo, const CaseData& data,
    const CheckBudget& budget, std::uint32_t seed);

}  // namespace crescent::check
