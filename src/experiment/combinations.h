// The combinations that an experiment declares, as samplers.
#pragma once

#include "experiment/experiment.h"
#include "samplers/external_sampler.h"

namespace crescent::inline experiment {

/// Adds the combinations of an experiment to its external samplers, which must be there already. Throws InputError.
void add_combinations(const Experiment& experiment, ExternalSamplers& samplers);

}  // namespace crescent::inline experiment
