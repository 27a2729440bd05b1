// The external samplers of an experiment's arms, opened before any work, so that missing ones are reported first.
#pragma once

#include "experiment/experiment.h"
#include "samplers/external_sampler.h"

namespace crescent::inline runs {

/// Starts the programs and opens the libraries of all arms that name one. Throws OutputError, with the arm's name, if
/// one does not start, is not a sampler, or cannot be used for an estimate (no pdf, delta parts). `timeout_s`: the
/// limit of one response; 0: the defaults of PipeLimits.
ExternalSamplers open_external(const Experiment& experiment, double timeout_s = 0);

/// Identifies the libraries by more than their names; "" if there are none. Films of other libraries are other films.
std::string marks_of(const Experiment& experiment);
/// A program may change between two runs without notice.
bool may_change(const Experiment& experiment);

}  // namespace crescent::inline runs
