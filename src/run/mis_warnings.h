// Arms of multiple importance sampling whose weights lose light: a sampler has weight where its density is 0, so that
// the weights of the samplers that draw there sum to less than 1, and the image is too dark.
#pragma once

#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "samplers/sampler_adapter.h"

namespace crescent {

/// A line for each such arm. Only weights that the experiment gives are tested, at a few pixels; those of the balance
/// and the power heuristic are 0 where the density is.
std::vector<std::string> mis_warnings(const Experiment& experiment, const ExternalSamplers& external_samplers);

}  // namespace crescent
