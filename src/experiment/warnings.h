// What an experiment may say and yet hardly means: told in the summary and in the report, never refused.
#pragma once

#include <string>
#include <vector>

#include "experiment/experiment.h"

namespace crescent::inline experiment {

/// A line each: surfaces whose rho_d + rho_s is above 1 in a channel, so that they reflect more than they receive; a
/// `note_evidence` that has nothing to measure.
std::vector<std::string> warnings_of(const Experiment& experiment);

}  // namespace crescent::inline experiment
