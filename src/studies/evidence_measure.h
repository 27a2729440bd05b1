// Measures what evidence.h holds.
#pragma once

#include <string>

#include "base/progress_monitor.h"
#include "studies/evidence.h"

namespace crescent::inline studies {

/// Nothing (empty vectors) where the experiment does not ask for it, and where it has no Phong arm or no shape with a
/// Phong lobe.
Evidence measure_evidence(const Experiment& experiment, const std::string& isa, ProgressMonitor& monitor);

}  // namespace crescent::inline studies
