// Both sides of every test of a sampler at one w_o, from a small budget.
#pragma once

#include <algorithm>
#include <optional>

#include "check/verdicts/questions.h"
#include "check/verdicts/statistics.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {

class SampledEvidence {
public:
    explicit SampledEvidence(FunctionSampler of, Vec3d wo = {0, 0, 1}, std::uint32_t draws = 1u << 15)
        : sampler(std::move(of)),
          source(sampler, 0, wo, light),
          plan(make_plan(source, CheckBudget::limited(2e5), {})) {
        integrate(source, plan, 1u << 14, true, {1, 0, 0, 1, Purpose::points, 0}, integrals);
        observe(source, plan, {1u << 14, draws, draws}, 1u << 13, {1}, integrals, observations);
    }
    SampledEvidence(const SampledEvidence&) = delete;
    SampledEvidence& operator=(const SampledEvidence&) = delete;

    Evidence evidence() const { return {source, plan, integrals, observations}; }
    /// The member of a family with the least p; none if no member is tested.
    template <class Test> std::optional<LeastOf<Answer>> least(const Test& test, Family family) const {
        const auto all = least_by_family<Answer>([&](const auto& visit) { test(evidence(), visit); });
        const auto found = all.find(family);
        return found == all.end() ? std::nullopt : std::optional(found->second);
    }
    /// The least p over all families of a test, times the members.
    template <class Test> double least_p(const Test& test) const {
        double out = 1;
        for (const auto& [family, answer] : least_by_family<Answer>([&](const auto& v) { test(evidence(), v); }))
            out = std::min(out, answer.p());
        return out;
    }

    const FunctionSampler sampler;
    const CaseLighting light{};
    Source source;
    const Plan plan;
    Integrals integrals;
    Observations observations;
};

}  // namespace crescent::check
