// Checks of arms that combine samplers.
#pragma once

#include "experiment/parser.h"

namespace crescent::inline experiment {

/// Reports every mistake in an arm with a kind: after names and shapes were read.
void check_combinations(ParseContext& context);

}  // namespace crescent::inline experiment
