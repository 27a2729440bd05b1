// Planted faults: each wraps a correct sampler in a few lines with one typical fault. The check must detect every one
// of them; `crescent check --planted` prints which verdict does.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "check/check.h"

namespace crescent {

struct PlantedFault {
    std::string name;    // a few words
    std::string breaks;  // the sampler it changes
    std::vector<CheckCase> check_cases;
    std::string cause{};    // a word of the factor that explains it; "" if the diagnosis knows none
    std::string verdict{};  // the verdict expected to fail first; "" if there are several
};

std::vector<PlantedFault> planted_faults(bool full);
/// Returns the faults of built-in samplers, which come first; their causes are not filled in.
std::vector<PlantedFault> arm_faults(bool full);
/// Returns the faults of samplers in the forms used by renderers, which are among the planted faults.
std::vector<PlantedFault> renderer_faults();
/// Returns the faults of surfaces under a smooth boundary, which are among the planted faults too.
std::vector<PlantedFault> boundary_faults();
/// Returns held-out faults of other families, which measure how often a cause is named correctly.
std::vector<PlantedFault> held_out_faults();
/// Returns held-out faults of several lobes, of lights and of shadowing; the diagnosis was extended for them
/// afterwards.
std::vector<PlantedFault> held_out_lobe_faults();
std::string cause_of(const std::string& fault);
std::string verdict_of(const std::string& fault);

}  // namespace crescent
