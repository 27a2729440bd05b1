// The samplers from outside that an experiment's arms name: opened before any work, so that what is missing is told
// first.
#pragma once

#include "experiment/experiment.h"
#include "samplers/external_sampler.h"

namespace crescent::inline runs {

/// Starts the programs and opens the libraries of all arms that name one. Throws OutputError, with the arm's name,
/// where one does not start, is no sampler, or cannot be estimated with (no pdf, delta parts). `timeout_s`: what an
/// answer may take; 0: the defaults of PipeLimits.
ExternalSamplers open_external(const Experiment& experiment, double timeout_s = 0);

/// What the libraries are, apart from their names; "" where there are none. Films of other libraries are other films.
std::string marks_of(const Experiment& experiment);
/// A program may change between two runs, and nothing shows it.
bool may_change(const Experiment& experiment);

}  // namespace crescent::inline runs
