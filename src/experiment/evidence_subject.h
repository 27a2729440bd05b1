// What the measurements of `note_evidence` are taken on, or why there is nothing to take them on.
#pragma once

#include <string>

#include "experiment/experiment.h"

namespace crescent::inline experiment {

/// The exponent control's shape, else the first with a Phong lobe; null where it has no Phong lobe or there is none.
const Shape* evidence_shape(const Experiment& experiment);
/// "no arm has the sampler 'phong'", ...; "" where note_evidence has an arm and a surface to measure.
std::string why_no_evidence(const Experiment& experiment);

}  // namespace crescent::inline experiment
