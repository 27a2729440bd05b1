// The whole table of an experiment file.
#pragma once

#include "experiment/schema.h"

namespace crescent {

/// The whole file of an experiment.
const Section& schema();

}  // namespace crescent
