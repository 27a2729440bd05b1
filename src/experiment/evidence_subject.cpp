// The note explains the Phong arm on a Phong lobe: both must be there, the lobe on the exponent control's shape where
// there is a control.
#include "experiment/evidence_subject.h"

#include <algorithm>

namespace crescent::inline experiment {

const Shape* evidence_shape(const Experiment& experiment) {
    const auto phong = [](const Shape& shape) {
        return shape.material.rho_s > 0 && shape.material.brdf == lobe_named("phong");
    };
    if (experiment.exponent) {
        const Shape* shape = experiment.find_shape(experiment.exponent->shape);
        return shape && phong(*shape) ? shape : nullptr;
    }
    const auto found = std::ranges::find_if(experiment.shapes, phong);
    return found == experiment.shapes.end() ? nullptr : &*found;
}

std::string why_no_evidence(const Experiment& experiment) {
    if (std::ranges::find(experiment.arms, "phong", &ArmPlan::sampler) == experiment.arms.end())
        return "no arm has the sampler 'phong'";
    if (evidence_shape(experiment)) return {};
    return experiment.exponent ? "exponent.shape has no Phong lobe" : "no shape has a Phong lobe";
}

}  // namespace crescent::inline experiment
