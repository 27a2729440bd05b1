// Planted faults: each wraps a right arm in a few lines that break it in one way that samplers are broken in. The bench
// must catch every one of them; `crescent check --planted` prints which verdict does.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "check/check.h"

namespace crescent {

struct PlantedFault {
    std::string name;    // a few words
    std::string breaks;  // the arm it breaks
    std::vector<CheckCase> check_cases;
    std::string cause{};  // a word of the factor that explains it; "" where it is none of those that a diagnosis knows
    std::string verdict{};  // the one that asks for it; "" where several do
};

std::vector<PlantedFault> planted_faults(bool full);
/// Those of the list's arms, which are the first of them; their causes are not filled in.
std::vector<PlantedFault> arm_faults(bool full);
/// Those of samplers as renderers have them, which are among the planted faults.
std::vector<PlantedFault> renderer_faults();
/// Those of surfaces under a smooth boundary, which are among the planted faults too.
std::vector<PlantedFault> boundary_faults();
/// Faults of other families, kept apart: by them it is measured how often a cause is named rightly.
std::vector<PlantedFault> held_out_faults();
/// Those of several lobes, of lights and of shadowing, apart: what they lacked a name for was mended.
std::vector<PlantedFault> held_out_lobe_faults();
std::string cause_of(const std::string& fault);
std::string verdict_of(const std::string& fault);

}  // namespace crescent
