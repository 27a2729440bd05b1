// The provenance of an output, as the JSON files of a run state it.
#pragma once

#include "output/format.h"
#include "report/report.h"

namespace crescent::inline report {

/// As in metrics.json.
Json provenance_json(const Provenance& provenance);

}  // namespace crescent::inline report
