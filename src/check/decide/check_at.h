// One technique of a sampler at one w_o: estimates, questions, two stages, findings.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "check/constants.h"
#include "check/decide/sizes.h"
#include "check/decide/small_tests.h"
#include "check/estimate/budget.h"
#include "check/estimate/scatter.h"

namespace crescent::check {

/// What surrounds a sampler at one w_o.
struct CaseData {
    CaseLighting light{};
    std::uint16_t place = 0;  // number of the case in its call: names its random streams
    Levels levels{};
};

/// A question that failed at both stages, or at the only one for what needs no second (a NaN is a NaN).
struct Finding {
    Answer first, second;
    double members = 1;  // that shared alpha1
};

/// Everything about one w_o. Evidence is kept for the explanation.
struct CheckAt {
    Vec3d wo{};
    int technique = 0, numbers = 2, channels = 1;  // as traits have them
    std::vector<Finding> findings;
    std::vector<SmallFault> small;
    std::vector<Answer> suspected;  // failed at stage 1 and passed at stage 2
    std::vector<Answer> answers;    // by family, the least p times the number of members, at the last look
    Sizes sizes;
    bool inconclusive = false;
    EvaluationNoise scatter;  // of pdf(w) and f(w), where they are random estimates
    int looks = 0;
    std::uint64_t evaluations = 0;
    double seconds = 0;
    std::shared_ptr<const Plan> plan;
    Integrals integrals;
    Observations observations;
    /// Times its target, beyond which a size leaves a verdict open.
    double most_ratio() const;
    bool wrong() const { return !findings.empty() || !small.empty(); }
};

CheckAt check_sampler_at(const SamplerAdapter& adapter, int technique, Vec3d wo, const CaseData& data,
    const CheckBudget& budget, std::uint32_t seed);

}  // namespace crescent::check
