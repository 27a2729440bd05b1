// Where an output came from, as the JSON files of a run state it.
#pragma once

#include "output/format.h"
#include "report/report.h"

namespace crescent::inline report {

/// As metrics.json has it.
Json provenance_json(const Provenance& provenance);

}  // namespace crescent::inline report
