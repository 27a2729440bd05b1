// Cases of `crescent check` for an arm of an experiment: at pixels of its scene, and over the grid of w_o on each
// material in view. The sampler receives what it receives in a run: the material, the lights, w_o.
#pragma once

#include <string>
#include <vector>

#include "check/sources/check_case.h"
#include "experiment/experiment.h"
#include "samplers/sampler_adapter.h"

namespace crescent {

/// Where an arm is checked.
struct ArmCasesPlan {
    int pixels = 0;     // geometry pixels, evenly spread over those in view; 0: the grid of w_o on each material
    bool full = false;  // 16 w_o of the grid in place of 8
    Grid wo{};          // these w_o, in degrees from the normal and about it, on each material or at each pixel
    std::string flag = "--sampler";  // that named the sampler, for messages
    double seconds = 0;  // of a combination: from then on w_o are not examined, see limited_in_time; 0: no limit
};

/// Returns the experiment with these arms and the arms that they combine alone.
Experiment with_arms_of(Experiment experiment, std::vector<std::string> names);

/// `sampler`: an arm of the experiment, or a built-in sampler. `external_samplers`: what open_external() returned for
/// it; it must live as long as the cases. Throws InputError if there is no such arm, or nothing is in view.
std::vector<CheckCase> arm_cases(const Experiment& experiment, const std::string& sampler,
    const ExternalSamplers& external_samplers, const ArmCasesPlan& plan);

}  // namespace crescent
