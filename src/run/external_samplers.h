// The external samplers of an experiment's arms, opened before any work, so that missing ones are reported first.
#pragma once

#include "experiment/experiment.h"
#include "samplers/sampler_adapter.h"

namespace crescent {

/// Starts the programs and opens the libraries of all arms that name one. Throws OutputError, with the arm's name,
/// where one does not start, is no sampler, or cannot be estimated with (no pdf, delta parts). `timeout_s`: what an
/// answer may take; 0: the defaults of PipeLimits. Arms that `samplers` has are returned, not opened.
ExternalSamplers open_external(const Experiment& experiment, double timeout_s = 0, ExternalSamplers samplers = {});

/// A program, or what a Python file imports, may change between two runs without a trace in the experiment's hash.
bool may_change(const Experiment& experiment);

}  // namespace crescent
