// Parts of one experiment, each run on a machine of its own with a part of the seeds -> the run of all of them.
#pragma once

#include <string>
#include <vector>

#include "run/collect.h"

namespace crescent::inline runs {

/// Joins parts: each a metrics.json or the folder of one. The metrics are those of one run with all seeds, bit for bit;
/// there are no films, so that assertions on plates are skipped, and where seeds are missing so are those that need
/// them. Throws InputError where a part cannot be read, is of another experiment, build or back end, or where two
/// parts give two values for one thing.
Measured join(const std::vector<std::string>& parts, const std::string& command);

/// metrics.json, metrics.csv and junit.xml, as one. Throws OutputError.
void write_metrics(const Measured& measured, const std::string& folder, ProgressMonitor& monitor);

}  // namespace crescent::inline runs
