// Two samplers on one plan: E_A[h] = E_B[h] for the test functions h of a tree that is grown from the pilot draws of
// both. The density is evaluated only to decide whether a draw below the surface is valid.
#pragma once

#include <optional>
#include <vector>

#include "check/decide/check_at.h"
#include "check/decide/two_stages.h"
#include "check/estimate/observations.h"

namespace crescent::check {

/// One of the two samplers at its w_o, with its own streams. `other` may have p where this sampler has none.
struct AgainstSide {
    const CheckCase& check_case;
    const SamplerAdapter& other;
    StreamKey key;
};

/// What both samplers share: the plan, in which h does not depend on p, and their delta parts.
struct CommonPlan {
    Plan plan;
    std::vector<Vec3d> delta_directions;      // of both samplers
    std::vector<DeltaPart> delta_a, delta_b;  // of the pilot draws
    std::vector<Vec3d> directions;            // some pilot directions of each sampler, in turn
};

/// Built from pilot draws of each sampler.
CommonPlan common_plan(const AgainstSide& a, const AgainstSide& b, const CheckBudget& budget);

/// The draws of one sampler at one stage.
struct SamplerDraws {
    std::vector<Observations> techniques;
    Observations total;               // of all techniques; its weights are f L cos / p of the first draws, luminance
    std::vector<double> delta_draws;  // number of draws towards each delta direction
};

/// Adds draws up to a look, and weights of the first `f_draws`.
void draw_on(
    const AgainstSide& side, const CommonPlan& common, const Look& target, std::uint32_t f_draws, SamplerDraws& d);

/// The right side if both have one distribution: the mean over the draws of both.
Integrals pooled_integrals(const Plan& plan, const Observations& a, const Observations& b);
/// The integral of the density in each leaf as the share of the draws there, with its variance.
Integrals shares_of_draws(const Observations& draws);

/// Both sides of the tests, A on the left.
class AgainstEvidence {
public:
    /// Refers to its arguments.
    AgainstEvidence(
        const AgainstSide& a, const CommonPlan& common, const SamplerDraws& draws_a, const SamplerDraws& draws_b);
    AgainstEvidence(const AgainstEvidence&) = delete;
    AgainstEvidence& operator=(const AgainstEvidence&) = delete;

    Evidence evidence() const {
        return {.source = source_,
            .plan = common_.plan,
            .integrals = integrals_,
            .observations = a_.total,
            .second = &b_.total};
    }
    /// Those of one sampler for the distribution, and the share of each delta direction.
    VisitAll tests() const;

private:
    const CommonPlan& common_;
    const SamplerDraws &a_, &b_;
    Source source_;
    Integrals integrals_;
    void test_delta_shares(const Visit& visit) const;
};

}  // namespace crescent::check
