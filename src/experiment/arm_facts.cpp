// Looked up in ArmInfo by the arm's sampler. One that is not in the list draws one direction, misses nothing and tells
// s. Arms that miss a light miss the fill: none does where the fill is black.
#include "experiment/arm_facts.h"

#include <algorithm>

#include "arms/info.h"

namespace crescent::inline experiment {

int techniques_of(const ArmPlan& arm) {
    const ArmInfo* info = find_arm_info(arm.sampler);
    return info ? info->techniques : 1;
}

std::string missed_light(const ArmPlan& arm, const Experiment& experiment) {
    const ArmInfo* info = find_arm_info(arm.sampler);
    const bool shines = experiment.fill[0] + experiment.fill[1] + experiment.fill[2] > 0;  // all that arms may miss
    return info && shines ? std::string(info->misses) : "";
}

bool tells_s(const std::string& arm, double s, const Experiment& experiment) {
    if (s != experiment.s()) return true;
    const ArmPlan* plan = experiment.find_arm(arm);
    const ArmInfo* info = plan ? find_arm_info(plan->sampler) : nullptr;
    return !info || info->needs_s;
}

bool any_tells_s(const Experiment& experiment) {
    return std::ranges::any_of(
        experiment.arms, [&](const ArmPlan& arm) { return tells_s(arm.name, experiment.s(), experiment); });
}

}  // namespace crescent::inline experiment
