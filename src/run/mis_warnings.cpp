// Weights are tested as `crescent check` does, at draws of each sampler at a few pixels.
#include "run/mis_warnings.h"

#include <fmt/format.h>

#include "check/decide/whole_sampler.h"
#include "run/arm_cases.h"

namespace crescent {

namespace {

constexpr int pixels = 4;

bool has_given_weights(const ArmPlan& arm) {
    const CombinationPlan& plan = arm.combination;
    return plan.kind == CombinationKind::mis && (!plan.weights.empty() || plan.weights_python);
}

}  // namespace

std::vector<std::string> mis_warnings(const Experiment& experiment, const ExternalSamplers& external_samplers) {
    std::vector<std::string> out;
    for (const ArmPlan& arm : experiment.arms) {
        if (!has_given_weights(arm)) continue;
        double directions = 0, lost_directions = 0, least_sum = 1;
        int sampler = 0;
        for (const CheckCase& c : arm_cases(experiment, arm.name, external_samplers, {.pixels = pixels})) {
            if (c.baseline) continue;
            const check::StreamKey key{1, 0, 0, 1, check::Purpose::light, 0};
            const std::optional<check::SmallFault> fault = check::mis_weights(*c.adapter, c.wo, key);
            if (!fault || !(fault->first.expected > 0)) continue;
            directions += fault->trials;
            lost_directions += fault->times;
            least_sum = std::min(least_sum, 1 + fault->size);
            sampler = static_cast<int>(fault->first.expected);
        }
        if (sampler == 0) continue;
        out.push_back(fmt::format(
            "{}: '{}' has MIS weight where its density is 0: at {:.3g} % of the directions the weights of the "
            "samplers that draw there sum to less than 1, down to {:.3g}. The image is too dark; a weight must be 0 "
            "where p is 0.",
            arm.name, arm.combination.of[static_cast<std::size_t>(sampler) - 1], 100 * lost_directions / directions,
            least_sum));
    }
    return out;
}

}  // namespace crescent
